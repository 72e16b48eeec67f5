#pragma once

#include <map>
#include <string>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Attachments on their way to other poses in their frames. They go there smoothly, however the targets jump.
class AttachmentMoves {
 public:
  /// Sends an attachment that is at `from` to `target`, both in its frame; one that is on its way goes on from where it is.
  void send(const std::string& attachment, const Pose& from, const Pose& target);
  void forget(const std::string& attachment) { moves_.erase(attachment); }
  void clear() { moves_.clear(); }

  /// Where an attachment is going; nothing if it is not on its way.
  const Pose* target(const std::string& attachment) const;

  /// Moves the attachments of a world that is about to step by `time_step` [s].
  void advance(double time_step, World& world);

 private:
  struct Move {
    Pose target;
    Pose guide;  ///< follows the target; the attachment follows it
  };
  std::map<std::string, Move> moves_;  ///< by attachment
};

}  // namespace verlet_cable
