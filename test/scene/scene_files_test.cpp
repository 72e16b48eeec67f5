#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "scene_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/core/world.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable {
namespace {

std::string config(const std::string& file) {
  return std::string(CONFIG_DIRECTORY) + "/" + file;
}

TEST(SceneFiles, templateHoldsTheDefaults) {
  const SceneDesc scene = read_scene_file(config("scene_template.yaml"));
  const SceneDesc defaults;
  EXPECT_EQ(scene.frame_id, defaults.frame_id);
  for (const auto& field : scene_fields) EXPECT_EQ(scene.*field.member, defaults.*field.member) << field.key;
  for (const auto& field : scene_integer_fields) EXPECT_EQ(scene.*field.member, defaults.*field.member) << field.key;
  for (const auto& field : limits_fields) EXPECT_EQ(scene.limits.*field.member, defaults.limits.*field.member) << field.key;
  EXPECT_EQ(scene.gravity.acceleration, defaults.gravity.acceleration);
  for (const auto& field : fluid_fields) EXPECT_EQ(scene.fluid.*field.member, defaults.fluid.*field.member) << field.key;
  EXPECT_EQ(scene.fluid.velocity, defaults.fluid.velocity);
  EXPECT_TRUE(scene.fluid.waves.empty());
  EXPECT_EQ(scene.on_lost_frame, defaults.on_lost_frame);
  EXPECT_EQ(scene.on_time_jump, defaults.on_time_jump);
  EXPECT_EQ(scene.marker_style, defaults.marker_style);
  EXPECT_EQ(scene.color_by, defaults.color_by);
  EXPECT_EQ(scene.scene_directory, defaults.scene_directory);
  EXPECT_EQ(scene.origin, defaults.origin);
  ASSERT_TRUE(scene.contact);
  EXPECT_EQ(scene.contact->self, ContactDesc{}.self);
  EXPECT_EQ(scene.contact->between_cables, ContactDesc{}.between_cables);
  for (const auto& field : contact_fields) EXPECT_EQ((*scene.contact).*field.member, ContactDesc{}.*field.member) << field.key;
  ASSERT_EQ(scene.materials.size(), 1u);
  for (const auto& field : material_fields) {
    if (field.required) continue;
    EXPECT_EQ(scene.materials[0].material.*field.member, MaterialDesc{}.*field.member) << field.key;
  }
  EXPECT_EQ(scene.materials[0].material.bending_stiffness, MaterialDesc{}.bending_stiffness);
  EXPECT_EQ(scene.numerical_damping, defaults.numerical_damping);
  ASSERT_EQ(scene.cables.size(), 2u);
  EXPECT_EQ(scene.cables[0].rest_twist, CableDesc{}.rest_twist);
  EXPECT_EQ(scene.cables[0].color, CableDesc{}.color);
  EXPECT_EQ(scene.cables[0].rest_curvature.type, CableDesc{}.rest_curvature.type);
  ASSERT_FALSE(scene.cables[0].attachments.empty());
  EXPECT_EQ(scene.cables[0].attachments[0].type, AttachmentDesc{}.type);
  EXPECT_EQ(scene.cables[0].attachments[0].offset, AttachmentDesc{}.offset);
  EXPECT_EQ(scene.cables[0].attachments[0].rotation, AttachmentDesc{}.rotation);
}

template <class Owner, class Fields>
void expect_defaults(const Owner& owner, const Fields& fields) {
  for (const auto& field : fields) {
    if (field.required) continue;
    EXPECT_EQ(owner.*field.member, Owner{}.*field.member) << field.key;
  }
}

TEST(SceneFiles, templateHoldsTheDefaultsOfNetsAndParticles) {
  const SceneDesc scene = read_scene_file(config("scene_template.yaml"));
  EXPECT_EQ(scene.integrator.type, SceneDesc{}.integrator.type);
  ASSERT_EQ(scene.particles.size(), 1u);
  expect_defaults(scene.particles[0], particle_fields);
  EXPECT_EQ(scene.particles[0].position, ParticleDesc{}.position);
  EXPECT_EQ(scene.particles[0].velocity, ParticleDesc{}.velocity);
  EXPECT_EQ(scene.particles[0].color, ParticleDesc{}.color);
  ASSERT_EQ(scene.nets.size(), 1u);
  const NetDesc& net = scene.nets[0];
  expect_defaults(net, net_fields);
  EXPECT_EQ(net.link_type, NetDesc{}.link_type);
  EXPECT_EQ(net.velocity, NetDesc{}.velocity);
  EXPECT_EQ(net.color, NetDesc{}.color);
  ASSERT_TRUE(net.grid);
  EXPECT_EQ(net.grid->origin, GridDesc{}.origin);
  EXPECT_EQ(net.grid->x_axis, GridDesc{}.x_axis);
  EXPECT_EQ(net.grid->y_axis, GridDesc{}.y_axis);
  ASSERT_EQ(net.attachments.size(), 1u);
  EXPECT_EQ(net.attachments[0].offset, NetAttachmentDesc{}.offset);
}

TEST(SceneFiles, templateHoldsTheDefaultsOfBodies) {
  const SceneDesc scene = read_scene_file(config("scene_template.yaml"));
  EXPECT_EQ(scene.broadcast_tf, SceneDesc{}.broadcast_tf);
  ASSERT_EQ(scene.bodies.size(), 1u);
  const BodyDesc& body = scene.bodies[0];
  expect_defaults(body, body_fields);
  expect_defaults(body.fluid, body_fluid_fields);
  expect_defaults(body.fluid, body_fluid_axis_fields);
  EXPECT_EQ(body.fluid.center, BodyFluidDesc{}.center);
  EXPECT_EQ(body.velocity, BodyDesc{}.velocity);
  EXPECT_EQ(body.angular_velocity, BodyDesc{}.angular_velocity);
  ASSERT_EQ(body.attachments.size(), 1u);
  const BodyAttachmentDesc& attachment = body.attachments[0];
  EXPECT_EQ(attachment.type, BodyAttachmentDesc{}.type);
  EXPECT_EQ(attachment.at, BodyAttachmentDesc{}.at);
  EXPECT_EQ(attachment.offset, BodyAttachmentDesc{}.offset);
  EXPECT_EQ(attachment.rotation, BodyAttachmentDesc{}.rotation);
}

TEST(SceneFiles, templateHoldsTheDefaultsOfJunctions) {
  const SceneDesc scene = read_scene_file(config("scene_template.yaml"));
  ASSERT_EQ(scene.junctions.size(), 1u);
  expect_defaults(scene.junctions[0], junction_fields);
  EXPECT_EQ(scene.junctions[0].type, JunctionDesc{}.type);
  ASSERT_EQ(scene.junctions[0].branches.size(), 1u);
  EXPECT_EQ(scene.junctions[0].branches[0].end, BranchDesc{}.end);
  EXPECT_EQ(scene.junctions[0].branches[0].rotation, BranchDesc{}.rotation);
}

TEST(SceneFiles, templateHoldsTheDefaultsOfGuides) {
  const SceneDesc scene = read_scene_file(config("scene_template.yaml"));
  ASSERT_EQ(scene.guides.size(), 3u);
  const GuideDesc &eyelet = scene.guides[0], &sheave = scene.guides[1], &clip = scene.guides[2];
  EXPECT_EQ(eyelet.type, GuideDesc{}.type);
  EXPECT_EQ(eyelet.rotation, GuideDesc{}.rotation);
  EXPECT_EQ(eyelet.friction, GuideDesc{}.friction_coefficient());
  EXPECT_EQ(sheave.friction_coefficient(), infinity);
  EXPECT_EQ(sheave.inertia, GuideDesc{}.inertia);
  EXPECT_EQ(sheave.bearing_friction, GuideDesc{}.bearing_friction);
  EXPECT_FALSE(clip.place);
  expect_defaults(clip, clip_fields);
}

/// Whether the template has the key somewhere with a comment above it that has the unit.
bool is_documented(const std::vector<std::string>& lines, const std::string& key, const std::string& unit) {
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::size_t at = lines[i].find_first_not_of(" -{#");
    if (at == std::string::npos || lines[i].compare(at, key.size() + 1, key + ":") != 0) continue;
    const std::string& comment = lines[i - 1];
    if (comment.find('#') != std::string::npos && (unit.empty() || comment.find("[" + unit + "]") != std::string::npos))
      return true;
  }
  return false;
}

template <class Fields>
void expect_documented(const std::vector<std::string>& lines, const Fields& fields) {
  for (const auto& field : fields)
    EXPECT_TRUE(is_documented(lines, field.key, field.unit)) << field.key << " [" << field.unit << "]";
}

TEST(SceneFiles, templateDocumentsEveryKey) {
  std::ifstream file(config("scene_template.yaml"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  expect_documented(lines, scene_fields);
  expect_documented(lines, scene_integer_fields);
  expect_documented(lines, material_fields);
  expect_documented(lines, std::array{bending_stiffness_field});
  expect_documented(lines, fluid_fields);
  expect_documented(lines, cable_fields);
  expect_documented(lines, cable_integer_fields);
  expect_documented(lines, shape_fields);
  expect_documented(lines, contact_fields);
  expect_documented(lines, particle_fields);
  expect_documented(lines, net_fields);
  expect_documented(lines, grid_fields);
  expect_documented(lines, grid_integer_fields);
  expect_documented(lines, body_fields);
  expect_documented(lines, body_fluid_fields);
  expect_documented(lines, body_fluid_axis_fields);
  expect_documented(lines, junction_fields);
  expect_documented(lines, sheave_fields);
  expect_documented(lines, clip_fields);
  for (const char* key : {"frame_id",
                          "numerical_damping",
                          "gravity",
                          "on_lost_frame",
                          "on_time_jump",
                          "marker_style",
                          "color_by",
                          "scene_directory",
                          "origin",
                          "limits",
                          "materials",
                          "cables",
                          "name",
                          "material",
                          "color",
                          "rest_curvature",
                          "stiff_ends",
                          "attachments",
                          "at",
                          "frame",
                          "offset",
                          "rotation",
                          "type",
                          "initial_pose",
                          "point_masses",
                          "initial",
                          "fluid",
                          "velocity",
                          "waves",
                          "center",
                          "obstacles",
                          "pose",
                          "friction",
                          "size",
                          "contact",
                          "self",
                          "between_cables",
                          "particles",
                          "nets",
                          "grid",
                          "mass",
                          "links",
                          "position",
                          "origin",
                          "x_axis",
                          "y_axis",
                          "node",
                          "minimum_distances",
                          "bodies",
                          "inertia",
                          "center_of_mass",
                          "angular_velocity",
                          "shapes",
                          "broadcast_tf",
                          "cable",
                          "junctions",
                          "branches",
                          "end",
                          "guides",
                          "integrator"})
    EXPECT_TRUE(is_documented(lines, key, "")) << key;
}

TEST(SceneFiles, examplesRun) {
  for (const char* file : {"scene_template.yaml", "hanging_cable.yaml", "swinging_payload.yaml"}) {
    const SceneDesc scene = read_scene_file(config(file));
    BoundaryInputs frames = initial_frames(scene);
    for (FrameInput& frame : frames) frame.known = true;
    World world(scene, frames);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(world.step(frames).status, StepResult::Status::ok) << file;
  }
  EXPECT_NO_THROW(read_scene_file(config("demo.yaml")));
  EXPECT_EQ(read_motion_file(config("swinging_payload.csv")).count("trolley"), 1u);
}

TEST(SceneFiles, thatCannotBeReadAreNamed) {
  for (const char* path : {"/nonexistent/scene.yaml", "/", "/dev/zero"}) EXPECT_THROW(read_scene_file(path), SceneError) << path;
  try {
    read_scene_file("/nonexistent/scene.yaml");
  } catch (const SceneError& error) {
    EXPECT_STREQ(error.what(), "scene: cannot read \"/nonexistent/scene.yaml\": No such file or directory");
  }
}

}  // namespace
}  // namespace verlet_cable
