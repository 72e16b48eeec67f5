#include "scene/start_places.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "body/hanging_places.h"
#include "body/mass_properties.h"
#include "scene/harnesses.h"
#include "scene/scene_errors.h"
#include "scene/scene_materials.h"
#include "verlet_cable/core/rotation.h"

namespace verlet_cable {

namespace {

/// A start may strain what cannot stretch, and what can, by this much.
constexpr double rigid_strain = 1e-3, elastic_strain = 0.02;

/// What holds a cable at a node: a frame, a body or a junction.
struct Hold {
  int node = 0;
  double arc_length = 0;
  std::string name;
  const std::string* frame = nullptr;
  int body = -1, junction = -1;
  Pose pose;  ///< in the frame or body
  bool clamps = false;
};

bool has_wheel(const SceneDesc& scene, const CableDesc& cable) {
  return std::any_of(scene.guides.begin(), scene.guides.end(), [&](const GuideDesc& guide) {
    return guide.cable == cable.name && guide.place && guide.type == GuideDesc::Type::sheave;
  });
}

int index_of_body(const SceneDesc& scene, const std::string& name) {
  const auto found =
      std::find_if(scene.bodies.begin(), scene.bodies.end(), [&](const BodyDesc& body) { return body.name == name; });
  return found == scene.bodies.end() ? -1 : static_cast<int>(found - scene.bodies.begin());
}

/// Along the cable.
std::vector<Hold> holds_of(const SceneDesc& scene, const CableDesc& cable) {
  std::vector<Hold> holds;
  const double length = cable.length / cable.segments;
  const auto add = [&](const auto& desc, int node, double arc_length) -> Hold& {
    Hold& hold = holds.emplace_back();
    hold.node = node;
    hold.arc_length = arc_length;
    hold.name = desc.name;
    hold.frame = &desc.frame;
    hold.body = desc.body.empty() ? -1 : index_of_body(scene, desc.body);
    hold.pose = {desc.offset, quaternion_from_rpy(desc.rotation)};
    return hold;
  };
  for (const AttachmentDesc& a : cable.attachments) {
    const int node = node_at(cable, a.place);
    add(a, node, node * length).clamps = a.type == AttachmentType::clamp;
  }
  for (const GuideDesc& guide : scene.guides)
    if (guide.cable == cable.name && guide.place) {
      const int node = node_at(cable, *guide.place);
      add(guide, node, guide.place->at == PlaceDesc::At::arc_length ? guide.place->arc_length : node * length);
    }
  for (const JunctionPlace& place : junction_places(scene, cable)) {
    Hold& hold = holds.emplace_back();
    hold.node = place.node;
    hold.arc_length = place.node * length;
    hold.junction = place.junction;
  }
  std::stable_sort(holds.begin(), holds.end(), [](const Hold& a, const Hold& b) { return a.arc_length < b.arc_length; });
  return holds;
}

/// A harness, and what of it is looked for.
class Harness {
 public:
  Harness(const SceneDesc& scene, std::vector<int> cables, const KnownPoses& known)
      : scene_(scene),
        known_(known),
        unknown_of_body_(scene.bodies.size(), -1),
        unknown_of_junction_(scene.junctions.size(), -1) {
    for (const int cable : cables) {
      std::vector<Hold> holds = holds_of(scene, scene.cables[cable]);
      const bool is_fixed = scene.cables[cable].initial.is_given() || has_wheel(scene, scene.cables[cable]);
      for (const Hold& hold : holds) {
        if (hold.body >= 0) ++(is_fixed ? fixed_ : holds_)[hold.body];
        if (hold.junction >= 0) ++(is_fixed ? fixed_junctions_ : junctions_)[hold.junction];
      }
      if (!is_fixed) cables_.push_back({cable, std::move(holds)});
    }
  }

  void find(bool junctions_only, StartPlaces& found) {
    if (!name_unknowns(junctions_only) || !hang_cables()) return;
    const Vector3 gravity = scene_.gravity.at(fixed_points_.front());
    Vector3 middle = Vector3::Zero();
    for (const Vector3& point : fixed_points_) middle += point / static_cast<double>(fixed_points_.size());
    double length = 0;
    for (const HangingSpan& span : spans_)
      for (const double l : span.lengths) length += l / static_cast<double>(spans_.size());
    Vector3 down = gravity.norm() > 0 ? Vector3(gravity.normalized()) : Vector3(-Vector3::UnitZ());
    double pull = gravity.norm() > 0 ? gravity.norm() : 1;
    if (middle.z() < scene_.fluid.surface) float_bodies();
    if (whole_weight() < 0) {
      down = -down;
      pull = -pull;
    }
    for (HangingBody& body : hanging_) {
      body.weight *= pull;
      body.pose.position = middle + length * down;
    }
    for (HangingSpan& span : spans_)
      for (double& weight : span.weights) weight *= pull;
    find_hanging_places(spans_, down, hanging_);
    for (std::size_t b = 0; b < unknown_of_body_.size(); ++b)
      if (unknown_of_body_[b] >= 0) found.bodies[static_cast<int>(b)] = hanging_[unknown_of_body_[b]].pose;
    for (std::size_t j = 0; j < unknown_of_junction_.size(); ++j)
      if (unknown_of_junction_[j] >= 0) found.junctions[static_cast<int>(j)] = hanging_[unknown_of_junction_[j]].pose.position;
    check(found.errors);
  }

 private:
  struct HeldCable {
    int cable = 0;
    std::vector<Hold> holds;
  };
  struct Reach {
    int cable = 0;
    Hold first, last;
    double length = 0, allowed = 0;
  };

  bool name_unknowns(bool junctions_only) {
    for (const auto& [body, count] : holds_) {
      const BodyDesc& desc = scene_.bodies[body];
      if (has_pose(desc) || fixed_.count(body) > 0) continue;
      if (count < 2) continue;
      const MassProperties properties = *mass_properties(desc);
      unknown_of_body_[body] = static_cast<int>(hanging_.size());
      hanging_.push_back({{}, properties.center_of_mass, properties.mass, true});
    }
    if (hanging_.empty() && !junctions_only) return false;
    for (const auto& [junction, count] : junctions_) {
      if (fixed_junctions_.count(junction) > 0) return false;
      unknown_of_junction_[junction] = static_cast<int>(hanging_.size());
      hanging_.push_back({{}, Vector3::Zero(), scene_.junctions[junction].mass, false});
    }
    return !hanging_.empty();
  }

  /// They weigh less by what they displace.
  void float_bodies() {
    for (std::size_t b = 0; b < unknown_of_body_.size(); ++b)
      if (unknown_of_body_[b] >= 0) hanging_[unknown_of_body_[b]].weight -= scene_.fluid.density * scene_.bodies[b].fluid.volume;
  }

  double whole_weight() const {
    double sum = 0;
    for (const HangingBody& body : hanging_) sum += body.weight;
    for (const HangingSpan& span : spans_) sum = std::accumulate(span.weights.begin(), span.weights.end(), sum);
    return sum;
  }

  /// A body that hangs on one cable, where that ends.
  bool hangs_freely(const Hold& hold) const {
    return hold.body >= 0 && unknown_of_body_[hold.body] < 0 && !has_pose(scene_.bodies[hold.body]) &&
           fixed_.count(hold.body) == 0;
  }

  /// False if a holder is not known.
  bool hang_cables() {
    for (const HeldCable& of : cables_) {
      const CableDesc& cable = scene_.cables[of.cable];
      const double length = cable.length / cable.segments;
      std::vector<double> masses(cable.segments + 1, 0.0);
      for (int i = 0; i < cable.segments; ++i)
        for (const int node : {i, i + 1}) masses[node] += 0.5 * length * material_at(scene_, cable, i).linear_density;
      for (const PointMassDesc& point : cable.point_masses) masses[node_at(cable, point.place)] += point.mass;
      std::vector<Hold> holds;
      for (const Hold& hold : of.holds) {
        if (hangs_freely(hold))
          masses[hold.node] += mass_properties(scene_.bodies[hold.body])->mass;
        else
          holds.push_back(hold);
      }
      if (holds.empty()) continue;
      std::vector<HangingEnd> ends;
      for (const Hold& hold : holds) {
        const std::optional<HangingEnd> end = end_of(hold);
        if (!end) return false;
        ends.push_back(*end);
      }
      for (std::size_t k = 0; k < holds.size(); ++k) {
        double load = masses[holds[k].node];
        if (k == 0)
          for (int i = 0; i < holds[k].node; ++i) load += masses[i];
        if (k + 1 == holds.size())
          for (int i = holds[k].node + 1; i <= cable.segments; ++i) load += masses[i];
        weigh(load, ends[k]);
        if (k > 0 && holds[k].node > holds[k - 1].node) hang(of.cable, holds[k - 1], holds[k], ends[k - 1], ends[k], masses);
      }
    }
    return !fixed_points_.empty();
  }

  std::optional<HangingEnd> end_of(const Hold& hold) {
    HangingEnd end;
    if (hold.junction >= 0) {
      end.body = unknown_of_junction_[hold.junction];
    } else if (hold.body >= 0 && unknown_of_body_[hold.body] >= 0) {
      end.body = unknown_of_body_[hold.body];
      end.point = hold.pose.position;
      end.axis = hold.pose.orientation * Vector3::UnitX();
    } else {
      const auto& poses = hold.body >= 0 ? known_.bodies : known_.frames;
      const auto pose = poses.find(hold.body >= 0 ? scene_.bodies[hold.body].name : *hold.frame);
      if (pose == poses.end()) return std::nullopt;
      end.point = (pose->second * hold.pose).position;
      end.axis = (pose->second * hold.pose).orientation * Vector3::UnitX();
      fixed_points_.push_back(end.point);
    }
    return end;
  }

  /// Adds what hangs at a point of a body to its weight.
  void weigh(double mass, const HangingEnd& end) {
    if (end.body < 0) return;
    HangingBody& body = hanging_[end.body];
    const double sum = body.weight + mass;
    if (sum > 0) body.center += mass / sum * (end.point - body.center);
    body.weight = sum;
  }

  void hang(int index, const Hold& first, const Hold& last, HangingEnd from, HangingEnd to, const std::vector<double>& masses) {
    const CableDesc& cable = scene_.cables[index];
    int begin = first.node, end = last.node;
    const double length = (last.arc_length - first.arc_length) / (end - begin);
    to.axis = -to.axis;
    // What does not bend is held along its clamp for a segment; what bends, by a moment: that of a beam whose other end may turn.
    const auto clamp = [&](const Hold& hold, HangingEnd& at, int segment, int& node, int way) {
      if (!hold.clamps || hold.junction >= 0) return;
      if (bends_at(scene_, cable, hold.node)) {
        at.stiffness = 3 * material_at(scene_, cable, segment).bending_stiffness.largest() / (last.arc_length - first.arc_length);
      } else if (end - begin > 1) {
        at.point += length * at.axis;
        node += way;
      }
    };
    clamp(first, from, first.node, begin, 1);
    clamp(last, to, last.node - 1, end, -1);
    HangingSpan& span = spans_.emplace_back();
    Reach& reach = reaches_.emplace_back();
    reach.cable = index;
    reach.first = first;
    reach.last = last;
    span.ends[0] = from;
    span.ends[1] = to;
    for (int i = begin; i < end; ++i) {
      const double compliance = 1 / material_at(scene_, cable, i).axial_stiffness;
      span.lengths.push_back(length);
      span.compliances.push_back(compliance);
      if (i > begin) span.weights.push_back(masses[i]);
      reach.length += length;
      reach.allowed += length * (1 + (compliance > 0 ? elastic_strain : rigid_strain));
    }
  }

  std::string words(const Hold& hold) const {
    if (hold.junction >= 0) return "junction " + in_quotes(scene_.junctions[hold.junction].name);
    return in_quotes(hold.name) + (hold.body >= 0 ? " on body " + in_quotes(scene_.bodies[hold.body].name) : "");
  }

  void check(std::vector<std::string>& errors) const {
    Errors lines;
    for (std::size_t s = 0; s < spans_.size(); ++s) {
      const Reach& reach = reaches_[s];
      const bool is_looked_for = spans_[s].ends[0].body >= 0 || spans_[s].ends[1].body >= 0;
      const double distance = chord(spans_[s], hanging_).norm();
      if (!is_looked_for || distance <= reach.allowed) continue;
      const CableDesc& cable = scene_.cables[reach.cable];
      lines.add(indexed("cables", reach.cable) + ".length",
                rounded_text(reach.length) + " m of cable " + in_quotes(cable.name) + " between " + words(reach.first) + " and " +
                    words(reach.last),
                "at least the distance of these where what has no pose hangs so that the least is missing, " +
                    rounded_text(distance) + " m: there is no place that all cables reach");
    }
    for (std::string& line : lines.take()) errors.push_back(std::move(line));
  }

  const SceneDesc& scene_;
  const KnownPoses& known_;
  std::vector<HeldCable> cables_;                                   ///< that hang by default
  std::map<int, int> holds_, fixed_, junctions_, fixed_junctions_;  ///< how often cables hold it that hang by default, and others
  std::vector<int> unknown_of_body_, unknown_of_junction_;          ///< indices into hanging_, -1: it is not looked for
  std::vector<HangingBody> hanging_;
  std::vector<HangingSpan> spans_;
  std::vector<Reach> reaches_;  ///< one a span
  std::vector<Vector3> fixed_points_;
};

}  // namespace

bool has_pose(const BodyDesc& body) {
  return body.pose || !body.attachments.empty();
}

bool places_bodies(const SceneDesc& scene, const CableDesc& cable) {
  return cable.initial.is_given() &&
         std::any_of(cable.attachments.begin(), cable.attachments.end(), [&](const AttachmentDesc& a) {
           if (a.body.empty() || has_pose(scene.bodies[index_of_body(scene, a.body)])) return false;
           return std::any_of(scene.cables.begin(), scene.cables.end(), [&](const CableDesc& other) {
             return !other.initial.is_given() && hangs_on(scene, scene.bodies[index_of_body(scene, a.body)], other);
           });
         });
}

StartPlaces find_start_places(const SceneDesc& scene, const std::vector<char>& start, bool junctions_only,
                              const KnownPoses& known) {
  StartPlaces found;
  const std::vector<int> labels = harnesses_of(scene);
  for (int label = 0; label < static_cast<int>(labels.size()); ++label) {
    std::vector<int> cables;
    bool all = true;
    for (int i = label; i < static_cast<int>(labels.size()); ++i) {
      if (labels[i] != label) continue;
      cables.push_back(i);
      all = all && start[i];
    }
    if (all && !cables.empty()) Harness(scene, std::move(cables), known).find(junctions_only, found);
  }
  return found;
}

}  // namespace verlet_cable
