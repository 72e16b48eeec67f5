#include "verlet_cable/ros/cable_services.h"

#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <verlet_cable/Cut.h>
#include <verlet_cable/Join.h>
#include <verlet_cable/LoadScene.h>
#include <verlet_cable/Pin.h>
#include <verlet_cable/RestoreState.h>
#include <verlet_cable/SaveState.h>
#include <verlet_cable/SetLength.h>
#include <verlet_cable/Step.h>
#include <verlet_cable/Unpin.h>

#include <functional>
#include <string>

#include "verlet_cable/ros/checked_pin.h"
#include "verlet_cable/ros/location.h"
#include "verlet_cable/ros/scene_files.h"

namespace verlet_cable {
namespace {

template <typename Response>
bool answer(const EditResult& result, Response& response) {
  response.success = result.ok;
  response.message = result.message;
  // Not a failure of the call: the caller gets the message.
  return true;
}

EditResult refused(std::vector<std::string> errors) {
  constexpr std::size_t most = 20;
  if (errors.size() > most) {
    const std::string more = "and " + std::to_string(errors.size() - most) + " more";
    errors.resize(most);
    errors.push_back(more);
  }
  return {false, join(errors), {}};
}

FindFrame find_frame_in(const Simulation& simulation) {
  return [&simulation](const std::string& frame) { return simulation.find_frame(frame); };
}

bool pin(Simulation& simulation, const Pin::Request& request, Pin::Response& response) {
  const CheckedPin pin = check_pin(request, simulation.world(), find_frame_in(simulation));
  if (!pin.errors.empty()) return answer(refused(pin.errors), response);
  const AttachmentType type = request.clamp ? AttachmentType::clamp : AttachmentType::hinge;
  const EditResult result =
      pin.net >= 0 ? simulation.pin_net(request.name, pin.net, pin.node, pin.frame, pin.frame_pose, pin.offset.position)
                   : simulation.pin(request.name, pin.cable, pin.node, pin.frame, pin.frame_pose, pin.offset, type);
  response.name = result.name;
  response.node = static_cast<std::uint32_t>(pin.node);
  return answer(result, response);
}

bool cut(Simulation& simulation, const Cut::Request& request, Cut::Response& response) {
  const Location location = locate_cut(request.location, simulation.world(), find_frame_in(simulation));
  if (!location.errors.empty()) return answer(refused(location.errors), response);
  if (location.net >= 0) {
    response.first = simulation.world().nets()[location.net].model.name;
    return answer(simulation.cut_links(location.net, location.links), response);
  }
  const EditResult result = simulation.cut(location.cable, location.index);
  if (result.ok) response.first = simulation.world().cables()[location.cable].model.name;
  response.second = result.name;
  return answer(result, response);
}

bool load_scene(Simulation& simulation, const LoadScene::Request& request, LoadScene::Response& response) {
  try {
    return answer(simulation.load_scene(read_requested_scene(request, simulation.scene())), response);
  } catch (const SceneError& error) {
    return answer(refused(error.errors()), response);
  }
}

bool step(Simulation& simulation, const Step::Request& request, Step::Response& response) {
  const EditResult result = simulation.step(request.steps);
  response.time = seconds(simulation.stamp());
  return answer(result, response);
}

/// A service whose handler is a function of the simulation and the message types of `Service`.
template <typename Service>
ros::ServiceServer serve(ros::NodeHandle& node, const std::string& name,
                         std::function<bool(const typename Service::Request&, typename Service::Response&)> handler) {
  return node.advertiseService<typename Service::Request, typename Service::Response>(
      name,
      [handler](typename Service::Request& request, typename Service::Response& response) { return handler(request, response); });
}

}  // namespace

CableServices::CableServices(ros::NodeHandle& node, Simulation& simulation) {
  using std_srvs::SetBool;
  using std_srvs::Trigger;
  Simulation* const s = &simulation;
  servers_ = {
      serve<Trigger>(node, "reset", [s](const auto&, auto& response) { return answer(s->reset(), response); }),
      serve<SetBool>(node, "pause",
                     [s](const auto& request, auto& response) { return answer(s->set_paused(request.data), response); }),
      serve<Unpin>(node, "unpin", [s](const auto& request, auto& response) { return answer(s->unpin(request.name), response); }),
      serve<Pin>(node, "pin", [s](const auto& request, auto& response) { return pin(*s, request, response); }),
      serve<Cut>(node, "cut", [s](const auto& request, auto& response) { return cut(*s, request, response); }),
      serve<SetLength>(
          node, "set_length",
          [s](const auto& r, auto& response) { return answer(s->set_length(r.cable, r.at_end, r.length, r.speed), response); }),
      serve<Join>(node, "join",
                  [s](const auto& r, auto& response) {
                    const EditResult result = s->join(r.first, r.first_at_end, r.second, r.second_at_end);
                    response.cable = result.name;
                    return answer(result, response);
                  }),
      serve<SaveState>(node, "save_state",
                       [s](const auto& request, auto& response) { return answer(s->save_state(request.name), response); }),
      serve<RestoreState>(node, "restore_state",
                          [s](const auto& request, auto& response) { return answer(s->restore_state(request.name), response); }),
      serve<LoadScene>(node, "load_scene",
                       [s](const auto& request, auto& response) { return load_scene(*s, request, response); }),
      serve<Step>(node, "step", [s](const auto& request, auto& response) { return step(*s, request, response); }),
  };
}

}  // namespace verlet_cable
