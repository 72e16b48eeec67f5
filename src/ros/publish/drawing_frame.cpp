#include "publish/drawing_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "publish/conversions.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

/// Of a cable's radius, by which what is drawn may be off.
constexpr double coarsest = 0.1;

/// [m] Between the numbers of single precision.
double step_at(double coordinate) {
  return std::numeric_limits<float>::epsilon() * std::exp2(std::floor(std::log2(coordinate)));
}

/// An origin that is near enough to `place`, in whole metres and with few digits.
std::string origin_near(const Vector3& place, double radius) {
  const double reach = coarsest * radius / std::numeric_limits<float>::epsilon();
  const double unit = std::max(1.0, std::pow(10, std::floor(std::log10(reach / 2))));
  std::string text;
  for (const double coordinate : place) {
    const double near = std::abs(coordinate) < unit ? 0 : unit * std::round(coordinate / unit);
    text += (text.empty() ? "" : ", ") + std::to_string(std::llround(near));
  }
  return "[" + text + "]";
}

}  // namespace

std::string origin_frame_of(const std::string& node) {
  return node.substr(node.find('/') == 0 ? 1 : 0) + "_origin";
}

DrawingFrame::DrawingFrame(const SceneDesc& scene, const std::string& node)
    : name(scene.origin.isZero(0) ? scene.frame_id : origin_frame_of(node)), origin(scene.origin) {}

geometry_msgs::Point DrawingFrame::point(const Vector3& position) const {
  return to_point(position - origin);
}

geometry_msgs::Pose DrawingFrame::pose(const Pose& pose) const {
  return to_pose({pose.position - origin, pose.orientation});
}

void DrawingFrame::enter(geometry_msgs::Point& position) const {
  position.x -= origin.x();
  position.y -= origin.y();
  position.z -= origin.z();
}

std::optional<std::string> coarse_drawing(const World& world, const DrawingFrame& frame) {
  for (const SimulatedCable& cable : world.cables()) {
    const Vector3& place = cable.state.positions.front();
    const double radius = CableMaterials(cable).smallest([](const MaterialDesc& material) { return material.radius; });
    const double farthest = (place - frame.origin).cwiseAbs().maxCoeff();
    if (!std::isfinite(farthest) || !(farthest > 0) || step_at(farthest) <= coarsest * radius) continue;
    return "cable " + in_quotes(cable.model->name) + " is " + rounded_text(farthest) + " m from the origin of " +
           in_quotes(frame.name) + ", where clouds and rviz, which have single precision, know places to " +
           rounded_text(step_at(farthest), 2) + " m only; `origin: " + origin_near(place, radius) +
           "` in the scene gives markers and clouds in a frame of their own there";
  }
  return std::nullopt;
}

}  // namespace verlet_cable
