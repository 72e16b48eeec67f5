#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "scene/polyline_length.h"
#include "scene/scene_errors.h"
#include "scene/scene_materials.h"
#include "scene/scene_size.h"
#include "scene/start_places.h"
#include "scene/validate_bodies.h"
#include "scene/validate_guides.h"
#include "scene/validate_holders.h"
#include "scene/validate_junctions.h"
#include "scene/validate_materials.h"
#include "scene/validate_nets.h"
#include "scene/validate_obstacles.h"
#include "scene/validate_place.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

/// Rounding in offsets, rotations and lengths that were written with a few digits.
constexpr double distance_tolerance = 1e-9;
/// Of the length of a segment between two nodes that are held.
constexpr double held_tolerance = 1e-4;
/// [rad] from one segment to the next, at rest
constexpr double largest_rest_turn = 0.5 * M_PI;

/// `joints`: how many places of the cable are in junctions or guides.
void check_initial(const std::string& key, const CableDesc& cable, int joints, Errors& errors) {
  const InitialShapeDesc& initial = cable.initial;
  check_vector(key + ".from", initial.from, "m", errors);
  check_vector(key + ".to", initial.to, "m", errors);
  if (initial.type == InitialShapeDesc::Type::straight && initial.from == initial.to)
    errors.add(key + ".to", list_text(initial.to), "a point other than `from`, it gives the direction");
  if (initial.type == InitialShapeDesc::Type::settled && cable.attachments.empty() && joints == 0)
    errors.add(key + ".type", "settled without attachments", "settled for a cable with at least one attachment");
  if (initial.type == InitialShapeDesc::Type::catenary && cable.attachments.size() + joints < 2)
    errors.add(key + ".type", "catenary with " + std::to_string(cable.attachments.size()) + " attachments",
               "catenary for a cable with at least two attachments");
  if (initial.type != InitialShapeDesc::Type::points) return;

  for (std::size_t i = 0; i < initial.points.size(); ++i)
    check_vector(indexed(key + ".points", i), initial.points[i], "m", errors);
  for (std::size_t i = 0; i < initial.velocities.size(); ++i)
    check_vector(indexed(key + ".velocities", i), initial.velocities[i], "m/s", errors);
  if (!initial.velocities.empty() && initial.velocities.size() != initial.points.size())
    errors.add(key + ".velocities", std::to_string(initial.velocities.size()) + " entries",
               "none, or one for each point: " + std::to_string(initial.points.size()));
  if (initial.points.size() < 2)
    return errors.add(key + ".points", std::to_string(initial.points.size()) + " points", "at least two points");
  if (has_sound_size(cable)) check_polyline_length(key + ".points", initial.points, cable.length, cable.length, errors);
}

void check_attachments(const std::string& prefix, const CableDesc& cable, const SceneNames& scene_names, UniqueNames& names,
                       Errors& errors) {
  std::map<int, std::string> targets;
  for (std::size_t i = 0; i < cable.attachments.size(); ++i) {
    const AttachmentDesc& attachment = cable.attachments[i];
    const std::string key = indexed(prefix + "attachments", i);
    names.check(key + ".name", attachment.name, errors);
    check_holder(key, scene_names, attachment, errors);
    if (attachment.type == AttachmentType::axle) errors.add(key + ".type", "axle", "hinge | clamp; axles are for bodies");
    if (!check_place(key + ".at", cable, attachment.place, errors) || !has_sound_size(cable)) continue;
    const int node = node_at(cable, attachment.place);
    const auto [target, is_new] = targets.emplace(node, key);
    if (!is_new)
      errors.add(key + ".at", "node " + std::to_string(node),
                 "a node that no other attachment holds; " + target->second + " does");
  }
}

/// Segments that turn further from one to the next could as well turn the other way round.
void check_turn(const std::string& key, const std::array<double, 2>& curvature, const CableDesc& cable, Errors& errors) {
  const double length = cable.length / cable.segments;
  if (cable.segments == 1 || !(std::hypot(curvature[0], curvature[1]) * length > largest_rest_turn)) return;
  errors.add(key, list_text(curvature),
             "at most " + rounded_bound_text(largest_rest_turn / length, -1) + " 1/m in all with segments of " +
                 rounded_text(length) + " m, a quarter turn from one to the next; more segments allow more");
}

void check_rest_curvature(const std::string& key, const CableDesc& cable, Errors& errors) {
  const RestCurvatureDesc& desc = cable.rest_curvature;
  const auto check = [&](const std::string& place, const std::array<double, 2>& curvature) {
    const std::size_t found = errors.size();
    check_numbers(place, curvature, coordinate, "1/m", errors);
    if (errors.size() == found && has_sound_size(cable)) check_turn(place, curvature, cable, errors);
  };
  if (desc.type != RestCurvatureDesc::Type::profile) return check(key, desc.curvature);
  if (desc.profile.size() < 2) errors.add(key, std::to_string(desc.profile.size()) + " places", "2 or more, from start to end");
  for (std::size_t i = 0; i < desc.profile.size(); ++i) check(indexed(key, i), desc.profile[i]);
}

void check_stiff_ends(const std::string& key, const CableDesc& cable, Errors& errors) {
  check_numbers(key, cable.stiff_ends, not_negative, "m", errors);
  if (has_sound_size(cable) && cable.stiff_ends[0] + cable.stiff_ends[1] >= cable.length)
    errors.add(key, list_text(cable.stiff_ends), "together less than the cable's length, " + number_text(cable.length) + " m");
}

/// Sections that are sound by themselves: where they are, and that none is in another.
void check_section(const std::string& key, const std::string& list, const CableDesc& cable, std::size_t index, Errors& errors) {
  const SectionDesc& section = cable.sections[index];
  const std::string place = number_text(section.from) + " to " + number_text(section.to) + " m";
  if (section.to > cable.length) {
    errors.add(key + ".to", number_text(section.to), "at most the cable's length, " + number_text(cable.length) + " m");
    return;
  }
  if (!(section.from < section.to)) {
    errors.add(key + ".to", number_text(section.to), "more than " + key + ".from, " + number_text(section.from) + " m");
    return;
  }
  for (std::size_t other = 0; other < index; ++other) {
    const SectionDesc& before = cable.sections[other];
    if (!(section.from < before.to && before.from < section.to)) continue;
    errors.add(key, place,
               "sections that do not overlap; " + indexed(list, other) + " is from " + number_text(before.from) + " to " +
                   number_text(before.to) + " m");
    return;
  }
  const double length = cable.length / cable.segments;
  const int near = static_cast<int>(std::min(section.from / length, cable.segments - 1.0));
  for (int i = std::max(near - 1, 0); i <= std::min(near + 1, cable.segments - 1); ++i)
    if (section_at(cable, i) == static_cast<int>(index)) return;
  errors.add(key, place,
             "with the middle of a segment in it; segments are " + rounded_text(length) + " m long, more segments are shorter");
}

void check_sections(const std::string& list, const SceneDesc& scene, const CableDesc& cable, Errors& errors) {
  // Each has a segment of its own; to find which, and whether they overlap, takes the square of their number.
  if (has_sound_size(cable) && cable.sections.size() > static_cast<std::size_t>(cable.segments)) {
    errors.add(list, std::to_string(cable.sections.size()) + " sections",
               "at most one for each segment, " + std::to_string(cable.segments));
    return;
  }
  for (std::size_t i = 0; i < cable.sections.size(); ++i) {
    const SectionDesc& section = cable.sections[i];
    const std::string key = indexed(list, i);
    const std::size_t found = errors.size();
    check_fields(key + ".", section_fields, section, errors);
    if (!scene.find_material(section.material))
      errors.add(key + ".material", in_quotes(section.material),
                 "a material of the scene (" + material_names(scene.materials) + ")");
    if (errors.size() == found && has_sound_size(cable)) check_section(key, list, cable, i, errors);
  }
}

void check_cable(const std::string& key, const SceneDesc& scene, const CableDesc& cable, const SceneNames& scene_names,
                 UniqueNames& attachments, Errors& errors) {
  const std::string prefix = key + ".";
  check_fields(prefix, cable_fields, cable, errors);
  check_fields(prefix, cable_integer_fields, cable, errors);
  if (!scene.find_material(cable.material))
    errors.add(prefix + "material", in_quotes(cable.material),
               "a material of the scene (" + material_names(scene.materials) + ")");
  check_sections(prefix + "sections", scene, cable, errors);
  for (const NamedMaterial& named : materials_of(scene, cable)) check_damping(key, scene, cable, named, errors);
  check_torsional_stiffness(key, scene, cable, errors);
  check_numbers(prefix + "color", cable.color, unit_interval, "", errors);
  check_initial(prefix + "initial", cable, scene_names.joints[&cable - scene.cables.data()], errors);
  check_rest_curvature(prefix + "rest_curvature", cable, errors);
  check_stiff_ends(prefix + "stiff_ends", cable, errors);
  check_attachments(prefix, cable, scene_names, attachments, errors);
  for (std::size_t i = 0; i < cable.point_masses.size(); ++i) {
    const std::string point_mass = indexed(prefix + "point_masses", i) + ".";
    check_place(point_mass + "at", cable, cable.point_masses[i].place, errors);
    check_fields(point_mass, point_mass_fields, cable.point_masses[i], errors);
  }
}

void check_initial_poses(const SceneDesc& scene, Errors& errors) {
  struct FirstUse {
    InitialPose pose;
    std::string key;
  };
  std::map<std::string, FirstUse> first_use{{scene.frame_id, {InitialPose{}, "the fixed frame"}}};
  visit_frame_users(scene, [&](const std::string& user, const auto& desc) {
    if (!desc.initial_pose) return;
    const std::string key = user + ".initial_pose";
    const std::string& frame = desc.frame.empty() ? scene.frame_id : desc.frame;
    const auto [first, is_new] = first_use.emplace(frame, FirstUse{*desc.initial_pose, key});
    if (!is_new && first->second.pose != *desc.initial_pose)
      errors.add(key, list_text(*desc.initial_pose),
                 "the same initial_pose wherever a frame is named; " + in_quotes(frame) + " has " +
                     list_text(first->second.pose) + " by " + first->second.key);
  });
}

/// Where an attachment's point is held with its frame at `frame`.
Vector3 held_point(const AttachmentDesc& attachment, const Pose& frame) {
  return frame.position + frame.orientation * attachment.offset;
}

/// Whether none of the cable between two nodes can stretch.
bool is_rigid(const SceneDesc& scene, const CableDesc& cable, int first, int last) {
  const int uniform_last = cable.sections.empty() ? std::min(first + 1, last) : last;
  for (int i = first; i < uniform_last; ++i)
    if (material_at(scene, cable, i).axial_stiffness < infinity) return false;
  return true;
}

/// Where the frame or body is that a cable's attachment names, as far as that is known.
std::optional<Pose> holder_of(const SceneDesc& scene, const AttachmentDesc& attachment,
                              const std::map<std::string, Pose>& frames) {
  if (attachment.body.empty()) {
    const auto frame = frames.find(attachment.frame);
    return frame == frames.end() ? std::nullopt : std::optional(frame->second);
  }
  const auto body = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                 [&](const BodyDesc& other) { return other.name == attachment.body; });
  // One that something holds begins there.
  if (body == scene.bodies.end() || !body->pose || !body->attachments.empty() || !is_sound(pose_of(*body->pose)))
    return std::nullopt;
  return pose_of(*body->pose);
}

/// Where two attachments leave no node between them free, the one segment that is not held along its clamp has the length that it
/// has at rest only if they are in the right places. Clamps of a cable without bending stiffness hold the nodes beside theirs.
void check_held_segment(const std::string& key, const SceneDesc& scene, const CableDesc& cable, const AttachmentDesc& first,
                        const AttachmentDesc& second, const std::map<std::string, Pose>& frames, Errors& errors) {
  const double length = cable.length / cable.segments;
  int free = node_at(cable, second.place) - node_at(cable, first.place) - 1;
  const auto end_of = [&](const AttachmentDesc& attachment, double way) -> Vector3 {
    const Pose frame = *holder_of(scene, attachment, frames);
    const Vector3 point = held_point(attachment, frame);
    if (attachment.type != AttachmentType::clamp || free == 0 || bends_at(scene, cable, node_at(cable, attachment.place)))
      return point;
    --free;
    return point + frame.orientation * quaternion_from_rpy(attachment.rotation) * Vector3(way, 0, 0);
  };
  if (free < 0) return;
  const int segments = free + 1;
  const Vector3 start = end_of(first, length), end = end_of(second, -length);
  const double distance = (end - start).norm(), held = length * (segments - 1 - free);
  const bool on_bodies = !first.body.empty() || !second.body.empty();
  if (on_bodies && free > 0 && distance > length * (free + 1) * (1 + distance_tolerance))
    return errors.add(
        key + ".length",
        rounded_text(length * segments) + " m of cable between " + in_quotes(first.name) + " and " + in_quotes(second.name),
        "at least " + rounded_bound_text(distance + held, 1) +
            " m, as clamps hold the segments next to them of a cable without bending_stiffness, and it is "
            "inextensible (axial_stiffness .inf)");
  if (free > 0 || std::abs(distance - length) <= held_tolerance * length) return;
  errors.add(key + ".segments",
             std::to_string(cable.segments) + ", no node between " + in_quotes(first.name) + " and " + in_quotes(second.name) +
                 " is free, and a segment of " + rounded_text(length) + " m would be " + rounded_text(distance) + " m long",
             "so many that a node between them is free, as the cable is inextensible (axial_stiffness .inf)");
}

void check_distances(const std::string& key, const SceneDesc& scene, const CableDesc& cable,
                     const std::map<std::string, Pose>& frames, Errors& errors) {
  std::vector<std::size_t> order(cable.attachments.size());
  std::iota(order.begin(), order.end(), 0);
  const auto node = [&](std::size_t i) { return node_at(cable, cable.attachments[i].place); };
  const auto is_unknown = [&](std::size_t i) {
    return !holder_of(scene, cable.attachments[i], frames) || !is_sound(cable, cable.attachments[i].place);
  };
  order.erase(std::remove_if(order.begin(), order.end(), is_unknown), order.end());
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return node(a) < node(b); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const AttachmentDesc& first = cable.attachments[order[i - 1]];
    const AttachmentDesc& second = cable.attachments[order[i]];
    if (!is_rigid(scene, cable, node(order[i - 1]), node(order[i]))) continue;
    const double length = cable.length * (node(order[i]) - node(order[i - 1])) / cable.segments;
    const double distance =
        (held_point(second, *holder_of(scene, second, frames)) - held_point(first, *holder_of(scene, first, frames))).norm();
    if (length > 0 && distance > length * (1 + distance_tolerance)) {
      errors.add(key + ".length",
                 rounded_text(length) + " m of cable between " + in_quotes(first.name) + " and " + in_quotes(second.name),
                 "at least the distance of these attachments, " + rounded_bound_text(distance, 1) +
                     " m, as the cable is inextensible (axial_stiffness .inf)");
      continue;
    }
    check_held_segment(key, scene, cable, first, second, frames, errors);
  }
}

/// Waves are those of gravity on a surface of water.
void check_fluid(const SceneDesc& scene, Errors& errors) {
  const FluidDesc& fluid = scene.fluid;
  check_vector("fluid.velocity", fluid.velocity, "m/s", errors);
  check_fields("fluid.", fluid_fields, fluid, errors);
  for (std::size_t i = 0; i < fluid.waves.size(); ++i)
    check_fields(indexed("fluid.waves", i) + ".", wave_fields, fluid.waves[i], errors);
  if (fluid.waves.empty()) return;
  if (fluid.density == 0) errors.add("fluid.density", "0", "any number above 0 [kg/m^3], with fluid.waves");
  if (fluid.surface == infinity) errors.add("fluid.surface", ".inf", "any number [m], with fluid.waves");
  const Vector3& g = scene.gravity.acceleration;
  const char* down = "[0, 0, -g] with any g above 0 [m/s^2], with fluid.waves";
  if (scene.gravity.type != GravityDesc::Type::uniform)
    errors.add("gravity", "central", down);
  else if (g.allFinite() && !(g.x() == 0 && g.y() == 0 && positive.contains(-g.z())))
    errors.add("gravity", list_text(g), down);
}

void check_size(const SceneDesc& scene, Errors& errors) {
  double segments = size_beside_cables(scene);
  for (const CableDesc& cable : scene.cables) segments += std::max(0, cable.segments);
  const bool cables_only = scene.nets.empty() && scene.particles.empty() && scene.bodies.empty();
  const bool has_bodies = !scene.bodies.empty();
  if (!limits_fields[0].range.contains(scene.limits.segments) || segments <= scene.limits.segments) return;
  errors.add(cables_only  ? "cables"
             : has_bodies ? "cables, nets, particles, bodies"
                          : "cables, nets, particles",
             number_text(segments) + (cables_only  ? " segments in all"
                                      : has_bodies ? " segments, links, particles and bodies in all"
                                                   : " segments, links and particles in all"),
             "at most limits.segments = " + std::to_string(scene.limits.segments));
}

std::map<std::string, Pose> poses_of(const SceneDesc& scene, const BoundaryInputs& frames) {
  const std::vector<std::string> names = frame_names(scene);
  std::map<std::string, Pose> poses{{"", Pose{}}};
  for (std::size_t i = 0; i < names.size() && i < frames.size(); ++i) {
    if (frames[i].known) poses.emplace(names[i], frames[i].pose);
  }
  return poses;
}

/// Errors of what has no pose and hangs on several cables.
std::vector<std::string> unreached(const SceneDesc& scene, const BoundaryInputs& frames) {
  if (scene.bodies.empty() && scene.junctions.empty()) return {};
  KnownPoses known{poses_of(scene, frames), {}};
  for (const BodyDesc& body : scene.bodies)
    if (body.pose && body.attachments.empty()) known.bodies.emplace(body.name, pose_of(*body.pose));
  return find_start_places(scene, std::vector<char>(scene.cables.size(), 1), true, known).errors;
}

std::vector<std::string> too_short(const SceneDesc& scene, const BoundaryInputs& frames) {
  Errors errors;
  const std::map<std::string, Pose> poses = poses_of(scene, frames);
  for (std::size_t i = 0; i < scene.cables.size(); ++i) {
    const CableDesc& cable = scene.cables[i];
    const auto is_known = [&](const SectionDesc& section) { return scene.find_material(section.material) != nullptr; };
    const bool known = scene.find_material(cable.material) && std::all_of(cable.sections.begin(), cable.sections.end(), is_known);
    if (known && has_sound_size(cable)) check_distances(indexed("cables", i), scene, cable, poses, errors);
  }
  return errors.take();
}

}  // namespace

std::vector<std::string> validate_distances(const SceneDesc& scene, const BoundaryInputs& frames) {
  std::vector<std::string> lines = too_short(scene, frames);
  return lines.empty() ? unreached(scene, frames) : lines;
}

std::vector<std::string> validate(const SceneDesc& scene) {
  Errors errors;
  if (!is_frame_name(scene.frame_id)) errors.add("frame_id", in_quotes(scene.frame_id), frame_words);
  check_fields("", scene_fields, scene, errors);
  check_fields("", scene_integer_fields, scene, errors);
  check_fields("limits.", limits_fields, scene.limits, errors);
  if (scene.gravity.type == GravityDesc::Type::uniform) {
    check_vector("gravity", scene.gravity.acceleration, "m/s^2", errors);
  } else {
    check_fields("gravity.", gravity_fields, scene.gravity, errors);
    check_vector("gravity.center", scene.gravity.center, "m", errors);
  }
  check_vector("origin", scene.origin, "m", errors);
  check_fluid(scene, errors);

  check_materials(scene, errors);

  UniqueNames names, attachments;
  const SceneNames scene_names(scene);
  for (std::size_t i = 0; i < scene.cables.size(); ++i) {
    names.check(indexed("cables", i) + ".name", scene.cables[i].name, errors);
    check_cable(indexed("cables", i), scene, scene.cables[i], scene_names, attachments, errors);
  }
  check_particles(scene, names, errors);
  check_nets(scene, names, attachments, errors);
  check_bodies(scene, scene_names, names, attachments, errors);
  const UniqueNames names_of_touching = names;
  check_junctions(scene, scene_names, errors);
  check_guides(scene, scene_names, names, errors);
  check_integrator(scene, errors);
  check_size(scene, errors);

  check_obstacles(scene, names_of_touching, errors);
  check_initial_poses(scene, errors);
  check_broadcast(scene, scene_names, errors);
  std::vector<std::string> lines = errors.take();
  for (std::string& line : too_short(scene, initial_frames(scene))) lines.push_back(std::move(line));
  return lines.empty() ? unreached(scene, initial_frames(scene)) : lines;
}

}  // namespace verlet_cable
