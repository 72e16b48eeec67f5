#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_sim {

/// The values of an attribute over time, as USD has them: one value where it never changes.
class UsdSamples {
 public:
  /// Times ascend.
  void add(const std::string& time_code, std::string value);
  /// The statement `declaration = value`, or that of its samples over time; `metadata` in brackets after it, may be empty.
  std::string statement(const std::string& indent, const std::string& declaration, const std::string& metadata = "") const;

 private:
  struct Sample {
    std::string time_code;
    std::string value;
  };
  std::vector<Sample> samples_;  ///< where it changes, and the last before it does
  std::string last_time_;        ///< until which the last value is there
};

/// A run as a scene of USD (openusd.org), in its text format: curves of cables and nets, solids of bodies and obstacles.
class UsdRecord {
 public:
  /// `rate` [Hz]: of time codes. `title`: in the file.
  UsdRecord(const World& world, const std::string& title, double rate);

  /// Adds what there is now.
  void add(const World& world);
  /// The whole file.
  std::string text() const;

 private:
  /// Something with a name in one of the folders.
  struct Prim {
    std::string type;  ///< of USD
    std::string name;  ///< in the scene
    std::string constants;
    std::string children;
    std::map<std::string, UsdSamples> attributes;  ///< by declaration
    /// Of curves: as thick as that everywhere, as long as they were so at all times; and at each point.
    UsdSamples width, widths;
    bool has_one_width = true;
    UsdSamples visibility;
  };
  struct Folder {
    std::map<std::string, std::size_t> index_of;  ///< by what identifies a prim
    std::vector<Prim> prims;                      ///< in the order in which they appeared
    std::set<std::string> used;                   ///< identifiers
    std::vector<std::string> identifiers;         ///< of prims
    std::set<std::size_t> present;                ///< at the time that is added
  };

  Prim& prim_at(Folder& folder, const std::string& key, const std::string& type, const std::string& name);
  /// `widths` [m]: one a point, or one for all that never change.
  void add_curves(const std::string& key, const std::string& name, const std::array<double, 4>& color, const std::string& counts,
                  const std::vector<Vector3>& points, const std::vector<double>& widths);
  void add_solid(Folder& folder, const std::string& key, const std::string& name, const Pose& pose, const std::string& children);
  void end_time(Folder& folder);
  static std::string text_of(const std::string& folder_name, const Folder& folder);

  std::string title_;
  double rate_;
  double plane_reach_;
  std::string time_code_;
  std::string first_code_;
  Folder cables_, particles_, bodies_, obstacles_;
};

/// A name as USD allows it: letters, digits and underscores, not a digit first; not one of `used`, to which it is added.
std::string usd_identifier(const std::string& name, std::set<std::string>& used);

}  // namespace verlet_cable::cable_sim
