#include "scene/validate_guides.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "scene/start_places.h"
#include "scene/validate_place.h"
#include "verlet_cable/core/pin_rules.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

/// Of a cable's length: places that are closer are one.
constexpr double same_place = 1e-9;
/// Linear densities of sections that slide through a guide. What is next to it counts as one material, so that for a fraction of
/// a segment mass is missing or left over there.
constexpr double most_uneven = 10;

double arc_length_of(const CableDesc& cable, const PlaceDesc& place) {
  switch (place.at) {
    case PlaceDesc::At::start:
      return 0;
    case PlaceDesc::At::end:
      return cable.length;
    case PlaceDesc::At::arc_length:
      break;
  }
  return place.arc_length;
}

/// A shape that is given in numbers, as a polyline; empty where it is not.
std::vector<Vector3> shape_in_numbers(const CableDesc& cable) {
  const InitialShapeDesc& initial = cable.initial;
  if (initial.type == InitialShapeDesc::Type::points) return initial.points;
  if (initial.type != InitialShapeDesc::Type::straight) return {};
  return {initial.from, initial.from + cable.length * (initial.to - initial.from).normalized()};
}

/// Of a point in a guide's axes: from the point, or the circle, on which the cable's center line is.
double distance_from_guide(const GuideDesc& guide, const Vector3& point) {
  if (guide.type != GuideDesc::Type::sheave) return point.norm();
  return std::hypot(std::hypot(point.x(), point.y()) - guide.radius, point.z());
}

/// The least over a segment from `a` to `b`, in the guide's axes. Of a circle, whose distance may have two minima, it is sought
/// between places that are closer than what the radius turns by.
double distance_from_guide(const GuideDesc& guide, const Vector3& a, const Vector3& b) {
  if (guide.type != GuideDesc::Type::sheave) {
    const double square = (b - a).squaredNorm();
    const double way = square > 0 ? std::clamp(-a.dot(b - a) / square, 0.0, 1.0) : 0;
    return (a + way * (b - a)).norm();
  }
  constexpr int places = 1000;
  double least = infinity;
  for (int i = 0; i <= places; ++i) least = std::min(least, distance_from_guide(guide, a + (b - a) * i / places));
  return least;
}

class GuideChecker {
 public:
  GuideChecker(const SceneDesc& scene, const SceneNames& names, Errors& errors) : scene_(scene), names_(names), errors_(errors) {}

  void check(UniqueNames& names) {
    for (std::size_t i = 0; i < scene_.guides.size(); ++i) {
      const GuideDesc& guide = scene_.guides[i];
      const std::string key = indexed("guides", i);
      names.check(key + ".name", guide.name, errors_);
      check_holder(key, names_, guide, errors_);
      check_numbers(key, guide);
      if (!guide.place && guide.type != GuideDesc::Type::clip)
        errors_.add(key + ".at", "missing",
                    "start, end, or an arc length [m]; only a clip may be without, which is open at first");
      const auto cable = names_.cables.find(guide.cable);
      if (cable == names_.cables.end()) {
        errors_.add(key + ".cable", in_quotes(guide.cable), one_of("cable", names_.cables));
      } else if (guide.place) {
        check_on_cable(key, guide, scene_.cables[cable->second]);
      }
    }
  }

 private:
  void check_numbers(const std::string& key, const GuideDesc& guide) {
    if (guide.friction && !not_negative_or_infinite.contains(*guide.friction))
      errors_.add(key + ".friction", number_text(*guide.friction), not_negative_or_infinite.text());
    if (guide.type == GuideDesc::Type::sheave) check_fields(key + ".", sheave_fields, guide, errors_);
    if (guide.type == GuideDesc::Type::clip) check_fields(key + ".", clip_fields, guide, errors_);
  }

  void check_on_cable(const std::string& key, const GuideDesc& guide, const CableDesc& cable) {
    if (!check_place(key + ".at", cable, *guide.place, errors_) || !has_sound_size(cable)) return;
    const double arc_length = arc_length_of(cable, *guide.place);
    check_order(key, guide, cable, arc_length);
    check_holders(key, cable, arc_length);
    check_shape(key, guide, cable);
  }

  void check_order(const std::string& key, const GuideDesc& guide, const CableDesc& cable, double arc_length) {
    const auto [last, is_first] = last_places_.emplace(cable.name, LastPlace{guide.name, arc_length});
    if (is_first) return;
    if (arc_length <= last->second.arc_length)
      errors_.add(key + ".at", number_text(arc_length),
                  "more than the " + number_text(last->second.arc_length) + " m of " + in_quotes(last->second.name) +
                      ": the guides of a cable are listed in the order of `at`");
    last->second = {guide.name, arc_length};
  }

  void check_holders(const std::string& key, const CableDesc& cable, double arc_length) {
    const auto check = [&](const PlaceDesc& place, const std::string& holder) {
      if (!is_sound(cable, place)) return;
      const double held = cable.length * node_at(cable, place) / cable.segments;
      if (std::abs(arc_length - held) <= same_place * cable.length)
        errors_.add(key + ".at", number_text(arc_length), "a place where nothing holds the cable; " + holder + " does");
    };
    for (const AttachmentDesc& attachment : cable.attachments)
      check(attachment.place, "attachment " + in_quotes(attachment.name));
    for (const JunctionDesc& junction : scene_.junctions) {
      if (junction.cable == cable.name) check(junction.place, "junction " + in_quotes(junction.name));
      for (const BranchDesc& branch : junction.branches) {
        const auto at = branch.end == BranchDesc::End::start ? PlaceDesc::At::start : PlaceDesc::At::end;
        if (branch.cable == cable.name) check({at, 0}, "junction " + in_quotes(junction.name));
      }
    }
  }

  /// Where the guide is at first, as far as the scene says so.
  std::optional<Pose> pose_at_first(const GuideDesc& guide) {
    const Pose own{guide.offset, quaternion_from_rpy(guide.rotation)};
    if (!guide.body.empty() && !guide.frame.empty()) return std::nullopt;
    if (!guide.body.empty()) {
      const auto body = names_.bodies.find(guide.body);
      if (body == names_.bodies.end() || !scene_.bodies[body->second].pose) return std::nullopt;
      return pose_of(*scene_.bodies[body->second].pose) * own;
    }
    if (guide.frame.empty() || guide.frame == scene_.frame_id) return own;
    if (frames_.empty()) {
      const std::vector<std::string> names = frame_names(scene_);
      const BoundaryInputs inputs = initial_frames(scene_);
      for (std::size_t i = 0; i < names.size(); ++i)
        if (inputs[i].known) frames_.emplace(names[i], inputs[i].pose);
    }
    const auto frame = frames_.find(guide.frame);
    return frame == frames_.end() ? std::nullopt : std::optional<Pose>(frame->second * own);
  }

  void check_shape(const std::string& key, const GuideDesc& guide, const CableDesc& cable) {
    const std::vector<Vector3> shape = shape_in_numbers(cable);
    const bool is_sheave = guide.type == GuideDesc::Type::sheave;
    if (shape.size() < 2 || (is_sheave && !sheave_fields[0].range.contains(guide.radius))) return;
    const std::optional<Pose> pose = pose_at_first(guide);
    if (!pose || !is_sound(*pose)) return;
    double distance = infinity;
    const Pose inverse = pose->inverse();
    const auto seen = [&](const Vector3& point) -> Vector3 { return inverse.position + inverse.orientation * point; };
    for (std::size_t i = 1; i < shape.size(); ++i)
      distance = std::min(distance, distance_from_guide(guide, seen(shape[i - 1]), seen(shape[i])));
    if (is_sheave) check_winding(key, guide, cable, shape, *pose);
    const double segment = cable.length / cable.segments;
    if (distance <= segment || !std::isfinite(distance)) return;
    errors_.add(key, "the initial shape of " + in_quotes(cable.name) + " misses it by " + rounded_text(distance) + " m",
                "a shape in numbers that passes within a segment's length, " + rounded_bound_text(segment, -1) + " m");
  }

  /// By how much the shape turns about the wheel while it is close to it.
  void check_winding(const std::string& key, const GuideDesc& guide, const CableDesc& cable, const std::vector<Vector3>& shape,
                     const Pose& wheel) {
    constexpr double close = 1.5;  // radii
    const Pose inverse = wheel.inverse();
    double turned = 0;
    for (std::size_t i = 1; i < shape.size(); ++i) {
      const Vector3 from = inverse.position + inverse.orientation * shape[i - 1];
      const Vector3 to = inverse.position + inverse.orientation * shape[i];
      if (std::max(from.head<2>().norm(), to.head<2>().norm()) > close * guide.radius) continue;
      turned += std::atan2(from.x() * to.y() - from.y() * to.x(), from.head<2>().dot(to.head<2>()));
    }
    if (std::abs(turned) < 2 * M_PI) return;
    errors_.add(key,
                "the initial shape of " + in_quotes(cable.name) + " winds around it " +
                    rounded_text(std::abs(turned) / (2 * M_PI)) + " times",
                "less than one turn, for now");
  }

  struct LastPlace {
    std::string name;
    double arc_length;
  };

  const SceneDesc& scene_;
  const SceneNames& names_;
  Errors& errors_;
  std::map<std::string, LastPlace> last_places_;  ///< by cable
  std::map<std::string, Pose> frames_;            ///< at first, where they are known
};

/// What can be described, but is not simulated yet.
class SimulationChecker {
 public:
  explicit SimulationChecker(const SceneDesc& scene) : scene_(scene) {}

  std::vector<std::string> check() {
    for (std::size_t i = 0; i < scene_.guides.size(); ++i) {
      const GuideDesc& guide = scene_.guides[i];
      const std::string key = indexed("guides", i);
      if (!guide.body.empty()) check_body(key, guide);
      const bool is_sheave = guide.type == GuideDesc::Type::sheave;
      if (is_sheave && guide.friction_coefficient() < infinity && guide.inertia > 0)
        errors_.add(key + ".friction", number_text(guide.friction_coefficient()),
                    "infinity (.inf) if the wheel has inertia; slip on such wheels is not supported yet");
      const auto cable =
          std::find_if(scene_.cables.begin(), scene_.cables.end(), [&](const CableDesc& c) { return c.name == guide.cable; });
      if (!cable->sections.empty()) check_sections(key, is_sheave, *cable);
      if (is_sheave) check_other_sheaves(key, guide, *cable);
      if (guide.place) check_room(key, guide, *cable);
    }
    return errors_.take();
  }

 private:
  void check_body(const std::string& key, const GuideDesc& guide) {
    const auto body =
        std::find_if(scene_.bodies.begin(), scene_.bodies.end(), [&](const BodyDesc& b) { return b.name == guide.body; });
    if (guide.place && !has_pose(*body))
      errors_.add(key + ".body", in_quotes(guide.body), "a body with a `pose` or attachments, for now");
    if (guide.inertia > 0)
      errors_.add(key + ".inertia", number_text(guide.inertia), "0 on a body; wheels with inertia need a frame, for now");
  }

  void check_sections(const std::string& key, bool is_sheave, const CableDesc& cable) {
    if (is_sheave) errors_.add(key + ".cable", in_quotes(cable.name), "a cable without sections, for now");
    double lightest = infinity, heaviest = 0;
    const auto weigh = [&](const std::string& name) {
      const double density = scene_.find_material(name)->linear_density;
      lightest = std::min(lightest, density);
      heaviest = std::max(heaviest, density);
    };
    weigh(cable.material);
    for (const SectionDesc& section : cable.sections) weigh(section.material);
    if (heaviest > most_uneven * lightest)
      errors_.add(
          key + ".cable", in_quotes(cable.name),
          "a cable whose sections' linear densities differ by a factor of at most " + number_text(most_uneven) + ", for now");
  }

  /// Whether the cable is a rod of material frames; see is_whole_rod().
  bool is_whole_rod(const CableDesc& cable) const {
    const MaterialDesc& material = *scene_.find_material(cable.material);
    const bool bends = material.bending_stiffness.largest() > 0;
    const bool is_bent = cable.rest_curvature.type != RestCurvatureDesc::Type::straight;
    const bool turns_body = std::any_of(cable.attachments.begin(), cable.attachments.end(), [](const AttachmentDesc& a) {
      return !a.body.empty() && a.type == AttachmentType::clamp;
    });
    return !material.bending_stiffness.is_isotropic() || material.remembers_bending() || (bends && (is_bent || turns_body)) ||
           (material.torsional_stiffness > 0 && cable.rest_twist != 0);
  }

  void check_other_sheaves(const std::string& key, const GuideDesc& guide, const CableDesc& cable) {
    if (!is_whole_rod(cable)) return;
    for (const GuideDesc& other : scene_.guides)
      if (&other < &guide && other.cable == guide.cable && other.type == GuideDesc::Type::sheave)
        errors_.add(
            key + ".cable", in_quotes(cable.name),
            "a cable that no other sheave holds, as " + in_quotes(other.name) +
                " does; for now, several are only for cables with one bending_stiffness that are straight at rest, do not yield "
                "and are not clamped to bodies");
  }

  /// Beside a guide there is cable on both sides, up to what else holds it.
  void check_room(const std::string& key, const GuideDesc& guide, const CableDesc& cable) {
    const double segment = cable.length / cable.segments, place = arc_length_of(cable, *guide.place);
    const auto refuse = [&](double least, const std::string& what) {
      errors_.add(key + ".at", number_text(place),
                  "a place at least " + rounded_bound_text(least * segment, 1) + " m from " + what + ", for now");
    };
    const auto check_end = [&](double end, const std::string& what) {
      if (std::abs(place - end) < segment * (1 - same_place)) refuse(1, what);
    };
    const auto check_holder = [&](double other, const std::string& what) {
      if (!has_guide_room(std::abs(place - other), segment)) refuse(guide_room, what);
    };
    check_end(0, "the cable's start");
    check_end(cable.length, "the cable's end");
    for (const AttachmentDesc& attachment : cable.attachments)
      check_holder(cable.length * node_at(cable, attachment.place) / cable.segments, "attachment " + in_quotes(attachment.name));
    for (const GuideDesc& other : scene_.guides)
      if (&other < &guide && other.cable == guide.cable && other.place)
        check_holder(arc_length_of(cable, *other.place), "guide " + in_quotes(other.name));
  }

  const SceneDesc& scene_;
  Errors errors_;
};

}  // namespace

std::vector<std::string> not_simulated_guides(const SceneDesc& scene) {
  return SimulationChecker(scene).check();
}

void check_guides(const SceneDesc& scene, const SceneNames& scene_names, UniqueNames& names, Errors& errors) {
  GuideChecker(scene, scene_names, errors).check(names);
}

}  // namespace verlet_cable
