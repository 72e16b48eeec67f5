#include "requests/cable_services.h"

#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <verlet_cable/ApplyWrench.h>
#include <verlet_cable/Cut.h>
#include <verlet_cable/Join.h>
#include <verlet_cable/LoadScene.h>
#include <verlet_cable/Pin.h>
#include <verlet_cable/RestoreState.h>
#include <verlet_cable/SaveState.h>
#include <verlet_cable/SetLength.h>
#include <verlet_cable/SetTension.h>
#include <verlet_cable/Step.h>
#include <verlet_cable/Unpin.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "edit_requests/checked_pin.h"
#include "edit_requests/error_text.h"
#include "edit_requests/location.h"
#include "requests/requested.h"
#include "scene_sources/scene_files.h"
#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable {
namespace {

/// So many of a service that takes long are dealt with at once; more wait.
constexpr std::uint32_t most_at_once = 4;

template <typename Response>
bool answer(const EditResult& result, Response& response) {
  response.success = result.ok;
  response.message = result.message;
  // Not a failure of the call: the caller gets the message.
  return true;
}

FindFrame find_frame_in(const Simulation& simulation) {
  return [&simulation](const std::string& frame) { return simulation.find_frame(frame); };
}

/// Refused or not: says what of the location is not used.
EditResult with_unused(EditResult result, const CableLocation& location) {
  result.message += unused_words(location);
  return result;
}

/// Says how far the place that was found is from the point that was given.
EditResult with_distance(EditResult result, const CableLocation& location, double distance) {
  if (result.ok && location.mode == CableLocation::NEAREST)
    result.message += "; the nearest point of the cable is " + rounded_text(distance, 3) + " m from the point that was given";
  return result;
}

bool pin(Simulation& simulation, const Pin::Request& request, Pin::Response& response) {
  if (!simulation.started()) return answer(simulation.refused_before_start(), response);
  const CheckedPin pin = check_pin(requested_pin(request), simulation.world(), find_frame_in(simulation));
  if (!pin.errors.empty()) return answer(with_unused(refused(pin.errors), request.location), response);
  const AttachmentType type = request.clamp ? AttachmentType::clamp : AttachmentType::hinge;
  const EditResult result = with_unused(simulation.pin(request.name, pin, type), request.location);
  response.name = result.name;
  response.node = static_cast<std::uint32_t>(pin.node);
  return answer(result, response);
}

bool apply_wrench(Simulation& simulation, const ApplyWrench::Request& request, ApplyWrench::Response& response) {
  if (!simulation.started()) return answer(simulation.refused_before_start(), response);
  const bool on_body = find(simulation.world().bodies(), request.location.cable) >= 0;
  const CheckedLoad load = simulation.check_load(
      requested_load(request.name, request.frame_id, request.point, request.wrench, request.duration, on_body),
      requested_place(request.location));
  if (!load.errors.empty()) return answer(with_unused(refused(load.errors), request.location), response);
  const EditResult result = with_unused(simulation.apply_load(load.load), request.location);
  response.name = result.name;
  return answer(result, response);
}

bool cut(Simulation& simulation, const Cut::Request& request, Cut::Response& response) {
  if (!simulation.started()) return answer(simulation.refused_before_start(), response);
  const Location location = locate_cut(requested_place(request.location), simulation.world(), find_frame_in(simulation));
  if (!location.errors.empty()) return answer(with_unused(refused(location.errors), request.location), response);
  const EditResult result = with_unused(simulation.cut(location), request.location);
  if (result.ok) response.first = name_of(simulation.world(), location.body);
  response.second = result.name;
  return answer(with_distance(result, request.location, location.distance), response);
}

/// What a thread of the service does: reads and checks, which may take long, and waits for the scene. `reads`: one reads at a
/// time, so that scenes are asked for in the order they came.
EditResult load_scene(Simulation& simulation, OwnerCalls& owner, std::mutex& reads, const SceneDesc& current,
                      const std::string& name, const LoadScene::Request& request) {
  std::future<EditResult> asked;
  try {
    const std::lock_guard<std::mutex> lock(reads);
    const SceneDesc scene = read_requested_scene(request, current, name);
    asked = owner.begin([&simulation, scene](const Answer& answer) { simulation.load_scene(scene, answer); });
  } catch (const SceneError& error) {
    return refused(error.errors());
  }
  return owner.wait(std::move(asked));
}

bool step(Simulation& simulation, OwnerCalls& owner, const Step::Request& request, Step::Response& response) {
  // Atomic, as the answer may come when nobody waits any longer, because the node ends.
  const auto time = std::make_shared<std::atomic<double>>(0);
  const EditResult result = owner.ask([&simulation, time, steps = request.steps](const Answer& answer) {
    simulation.step(steps, [&simulation, time, answer](const EditResult& done) {
      *time = seconds(simulation.stamp());
      answer(done);
    });
  });
  response.time = *time;
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

CableServices::CableServices(ros::NodeHandle& node, Simulation& simulation) : owner_(*node.getCallbackQueue()) {
  using std_srvs::SetBool;
  using std_srvs::Trigger;
  Simulation* const s = &simulation;
  servers_ = {
      // Stops time, or lets it go on.
      serve<SetBool>(node, "pause",
                     [s](const auto& request, auto& response) { return answer(s->set_paused(request.data), response); }),
      serve<Unpin>(node, "unpin", [s](const auto& request, auto& response) { return answer(s->unpin(request.name), response); }),
      serve<Pin>(node, "pin", [s](const auto& request, auto& response) { return pin(*s, request, response); }),
      serve<ApplyWrench>(node, "apply_wrench",
                         [s](const auto& request, auto& response) { return apply_wrench(*s, request, response); }),
      serve<Cut>(node, "cut", [s](const auto& request, auto& response) { return cut(*s, request, response); }),
      serve<SetLength>(node, "set_length",
                       [s](const auto& r, auto& response) {
                         return answer(s->set_length(r.cable, r.at_end, r.length, r.speed, r.max_tension), response);
                       }),
      serve<SetTension>(node, "set_tension",
                        [s](const auto& r, auto& response) {
                          const edit::SetTension change{0, bool(r.at_end), r.tension, r.max_speed, r.min_length, r.max_length};
                          return answer(s->set_tension(r.cable, change), response);
                        }),
      serve<Join>(node, "join",
                  [s](const auto& r, auto& response) {
                    const EditResult result = s->join(r.first, r.first_at_end, r.second, r.second_at_end);
                    response.cable = result.name;
                    return answer(result, response);
                  }),
      serve<SaveState>(
          node, "save_state",
          [s](const auto& request, auto& response) { return answer(s->save_state(request.name, request.file), response); }),
      serve<RestoreState>(
          node, "restore_state",
          [s](const auto& request, auto& response) { return answer(s->restore_state(request.name, request.file), response); }),
  };
  SceneDesc lasting;  // what no request changes
  lasting.scene_directory = s->scene().scene_directory;
  lasting.limits = s->scene().limits;
  // Back to the scene's initial state.
  serve_aside<Trigger>(node, "reset", [this, s](const auto&, auto& response) {
    return answer(owner_.ask([s](const Answer& done) { s->reset(done); }), response);
  });
  serve_aside<Step>(node, "step", [this, s](const auto& request, auto& response) { return step(*s, owner_, request, response); });
  serve_aside<LoadScene>(node, "load_scene", [this, s, lasting, name = node.getNamespace()](const auto& request, auto& response) {
    return answer(load_scene(*s, owner_, reads_scene_, lasting, name, request), response);
  });
}

CableServices::~CableServices() {
  // First, as a service that is shut down waits for its callbacks.
  owner_.end();
}

template <typename Service, typename Handler>
void CableServices::serve_aside(const ros::NodeHandle& node, const std::string& name, Handler handler) {
  Aside& aside = *asides_.emplace_back(std::make_unique<Aside>(most_at_once));
  ros::NodeHandle own(node);
  own.setCallbackQueue(&aside.guard);
  aside.server = serve<Service>(own, name, handler);
  aside.spinner.start();
}

}  // namespace verlet_cable
