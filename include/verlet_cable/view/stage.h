#pragma once

#include <memory>

#include "verlet_cable/view/drawing.h"

namespace verlet_cable::view {

/// A drawing that rays can be cast into: what cameras look at. It does not change, so that any number of cameras may look at it,
/// from any threads.
class Stage {
 public:
  /// Throws std::invalid_argument with all that `validate` says. `before`: the stage of a moment earlier, if there is one; what
  /// has been prepared of its meshes is taken over, which takes most of the time of the first stage with large ones.
  explicit Stage(Drawing drawing, const Stage* before = nullptr);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  const Drawing& drawing() const;

  struct Implementation;
  const Implementation& implementation() const { return *implementation_; }

 private:
  std::unique_ptr<const Implementation> implementation_;
};

}  // namespace verlet_cable::view
