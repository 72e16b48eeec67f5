#include "node/diagnostics.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "frames/missing_frames.h"
#include "threads/guarded_queue.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

using diagnostic_msgs::DiagnosticStatus;

/// More would only make the message long.
constexpr std::size_t most_listed = 100;

std::string text(FrameStatus status) {
  switch (status) {
    case FrameStatus::never_seen:
      return "never seen";
    case FrameStatus::late:
      return "late";
    case FrameStatus::lost:
      return "lost";
    case FrameStatus::computed:
      return "a body's";
    default:
      return "ok";
  }
}

/// `at the start, to 1.5 m with at most 20 N: 19.6 N, -0.5 m/s, slips`
std::string text(const WinchView& winch) {
  std::string kind = "free spool";
  if (winch.kind == WinchView::Kind::tension) kind = "keeps " + number_text(winch.goal) + " N";
  if (winch.kind == WinchView::Kind::length) kind = "to " + rounded_text(winch.goal) + " m";
  if (winch.max_tension < infinity) kind += " with at most " + number_text(winch.max_tension) + " N";
  return std::string("at the ") + (winch.at_end ? "end" : "start") + ", " + kind + ": " + rounded_text(winch.tension) + " N, " +
         rounded_text(winch.speed) + " m/s" + (winch.slips ? ", slips" : "");
}

void summarize(SimulationReport::Phase phase, diagnostic_updater::DiagnosticStatusWrapper& status) {
  using Phase = SimulationReport::Phase;
  switch (phase) {
    case Phase::faulted:
      return status.summary(DiagnosticStatus::ERROR, "fault: the simulation has stopped; call reset or restore_state to go on");
    case Phase::building:
      return status.summary(DiagnosticStatus::WARN, "the scene is being built");
    case Phase::no_time:
      return status.summary(DiagnosticStatus::WARN, "no ROS time yet: use_sim_time is true, and nothing publishes /clock");
    case Phase::awaits_first_frames:
      return status.summary(DiagnosticStatus::WARN, "waits for its tf frames to start");
    case Phase::paused:
      return status.summary(DiagnosticStatus::OK, "paused");
    case Phase::awaits_lost_frame:
      return status.summary(DiagnosticStatus::WARN, "waits for a lost frame to come back");
    case Phase::running:
      return status.summary(DiagnosticStatus::OK, "running");
  }
}

}  // namespace

Diagnostics::Diagnostics(ros::NodeHandle& private_node, Simulation& simulation, const ObstacleListener& obstacles)
    : simulation_(simulation), obstacles_(obstacles), updater_(private_node, private_node, private_node.getNamespace()) {
  updater_.setHardwareID("none");
  updater_.add("simulation", [this](Status& status) { report_simulation(status); });
  updater_.add("frames", [this](Status& status) { report_frames(status); });
  updater_.add("obstacles", [this](Status& status) { report_obstacles(status); });
  // Not the updater's own pace, which is in ROS time and stands with it.
  timer_ = private_node.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) {
    run_guarded("a report", [this] { updater_.force_update(); });
  });
}

void Diagnostics::report_simulation(Status& status) {
  const SimulationReport report = simulation_.take_report();
  const Statistics& s = report.statistics;
  const double time_step = simulation_.world().time_step();
  const double step_time = s.steps > 0 ? s.wall_time / static_cast<double>(s.steps) : 0;
  status.add("real_time_factor", step_time > 0 ? time_step / step_time : 0);  // time_step over step_time_mean_s
  status.add("step_time_mean_s", step_time);                                  // computing time of a step since the last report
  status.add("step_time_max_s", s.longest_step);                              // the same, of the longest step
  status.add("steps", s.steps);                            // since the last report, like all numbers of steps here
  status.add("behind_s", seconds(report.behind));          // of the time to simulate, ROS time - tf_latency; at most tf_timeout
  status.add("dropped_time_s", seconds(report.dropped));   // simulated time skipped since the start when overloaded
  status.add("max_strain", s.max_strain);                  // largest |l / l0 - 1|
  status.add("overstretched_steps", s.overstretched);      // held points were further apart than a cable or net is long
  status.add("jumped_steps", s.jumped);                    // a frame jumped, and what it holds was carried along
  status.add("inside_obstacle_steps", s.inside_obstacle);  // a cable or body was inside an obstacle, and was pushed out
  status.add("degraded_steps", s.degraded);                // no solution was found, and velocities were set to zero
  status.add("exhausted_steps", s.exhausted);              // a step exceeded its budget of work and was cut short
  status.add("unaccounted_steps", s.unaccounted);          // energy came from nowhere, or went: the ledger did not close
  status.add("faults", report.faults);                     // number since the start
  status.add("waiting_cables", NameList(simulation_.world().findings().waiting).text(""));  // that wait for a frame
  report_waiting(status);
  status.add("unsettled_cables", NameList(simulation_.world().findings().unsettled).text(""));  // without a static equilibrium
  NameList loads;
  for (const Load& load : simulation_.world().loads()) loads.add(load.name);
  status.add("loads", loads.text(""));  // from outside, that act now
  report_winches(status);
  status.add("found_inside_obstacles", NameList(report.intrusions).text(""));  // since the scene started

  summarize(report.phase, status);
  const Nanoseconds dropped = report.dropped - std::exchange(dropped_, report.dropped);
  status.add("dropped_since_last_s", seconds(dropped));  // dropped_time_s since the last report
  if (dropped > 0 && s.steps > 0) {
    const double simulated = static_cast<double>(s.steps) * time_step;
    char share[32];
    std::snprintf(share, sizeof share, "%.2f", simulated / (simulated + seconds(dropped)));
    status.mergeSummary(DiagnosticStatus::WARN,
                        std::string("overloaded, or time jumped: the cables moved at ") + share + " of real time");
  }
  if (step_time > time_step) status.mergeSummary(DiagnosticStatus::WARN, "slower than real time");
  if (s.overstretched > 0)
    status.mergeSummary(DiagnosticStatus::WARN, "overstretched: what holds a cable or net is further apart than it is long");
  if (s.degraded > 0)
    status.mergeSummary(DiagnosticStatus::WARN,
                        "steps without a solution: the motion of cables, or of bodies and what hangs on them, was taken away");
  if (s.exhausted > 0)
    status.mergeSummary(DiagnosticStatus::WARN, "steps took too much work, and were cut short: the time_step is too long");
  if (!simulation_.world().findings().unsettled.empty())
    status.mergeSummary(DiagnosticStatus::WARN, "no static equilibrium was found to start from");
  if (!report.intrusions.empty()) status.mergeSummary(DiagnosticStatus::WARN, "cables or bodies were found inside obstacles");
  if (simulation_.started() && !simulation_.world().findings().waiting.empty())
    status.mergeSummary(DiagnosticStatus::WARN, "cables, nets or bodies wait for their tf frames and are not there yet");
}

void Diagnostics::report_waiting(Status& status) const {
  const std::vector<WaitingAttachment> waiting =
      waiting_attachments(simulation_.scene(), simulation_.world(), simulation_.frames().inputs());
  for (std::size_t i = 0; i < std::min(waiting.size(), most_listed); ++i)
    status.add("waiting_attachment " + waiting[i].holds + "/" + waiting[i].name, waiting[i].frame);  // the missing frame
}

void Diagnostics::report_winches(Status& status) const {
  const World& world = simulation_.world();
  std::size_t count = 0;
  for (std::size_t i = 0; i < world.cables().size() && count < most_listed; ++i) {
    const std::optional<WinchView> winch = world.view_winch(static_cast<int>(i));
    if (!winch) continue;
    status.add("winch " + world.cables()[i].model->name, text(*winch));  // that runs, or goes by its tension: what it does
    ++count;
  }
}

void Diagnostics::report_frames(Status& status) const {
  std::vector<FrameReport> frames = simulation_.frames().report();
  frames.erase(frames.begin());  // the fixed frame
  NameList late;
  for (const FrameReport& frame : frames)
    if (frame.status == FrameStatus::late) late.add(frame.name);
  status.summary(DiagnosticStatus::OK, late.text("").empty() ? "all frames are there" : "late: " + late.text(""));
  for (const FrameReport& frame : frames) {
    std::string value = text(frame.status);
    if (frame.is_static) {
      value += ", static";
    } else if (frame.newest > 0) {
      value += ", age " + rounded_text(seconds(simulation_.now() - frame.newest), 3) + " s";
    }
    if (frame.too_fast) value += ", faster than max_frame_speed";
    status.add("frame " + frame.name, value);  // ok, late, lost, never seen, or of a body; its age [s]
    if (frame.status == FrameStatus::never_seen)
      status.mergeSummary(DiagnosticStatus::WARN, "frame " + in_quotes(frame.name) + " never seen");
    if (frame.status == FrameStatus::lost)
      status.mergeSummary(DiagnosticStatus::WARN, "frame " + in_quotes(frame.name) + " lost");
    if (frame.too_fast) status.mergeSummary(DiagnosticStatus::WARN, "frame " + in_quotes(frame.name) + " too fast");
  }
  status.add("refused_transforms", simulation_.frames().buffer().refused_count());  // number since the start
  for (const auto& [frame, sources] : simulation_.frames().buffer().disputed()) {
    status.add("sources of " + frame, NameList(sources).text(""));  // the nodes that send a frame, if several do
    status.mergeSummary(DiagnosticStatus::WARN,
                        "frame " + in_quotes(frame) + " comes from " + std::to_string(sources.size()) + " nodes");
  }
  for (const std::string& frame : simulation_.frames().buffer().mixed())
    status.mergeSummary(DiagnosticStatus::WARN,
                        "frame " + in_quotes(frame) + " came on /tf and on /tf_static: start the node again");
  for (const auto& [frame, problem] : simulation_.frames().buffer().refused()) {
    status.add("refused " + escaped(frame), problem);  // why the last transform was refused
    status.mergeSummary(DiagnosticStatus::WARN, "tf of frame " + in_quotes(frame) + " refused");
  }
}

void Diagnostics::report_obstacles(Status& status) const {
  status.summary(DiagnosticStatus::OK, "all obstacles are there");
  const World& world = simulation_.world();
  const std::vector<FrameReport> frames = simulation_.frames().report();
  for (const Obstacle& obstacle : world.obstacles()) {
    const bool lost = frames[obstacle.frame].status == FrameStatus::lost;
    if (obstacle.present && !lost) continue;
    const std::string& frame = world.frames()[obstacle.frame];
    status.add("obstacle " + obstacle.name,  // what is wrong with it
               (lost ? "stays where it was, as its frame is lost: " : "is not there yet, as its frame is not on tf: ") + frame);
    status.mergeSummary(DiagnosticStatus::WARN,
                        "obstacle " + in_quotes(obstacle.name) + (lost ? " has lost its frame" : " waits for its frame"));
  }
  status.add("added", simulation_.added_obstacles().size());  // number of obstacles that markers added
  status.add("refused_markers", obstacles_.refused_count());  // number since the start
  if (obstacles_.refused_count() == 0) return;
  status.add("last_refused", obstacles_.last_problem());  // why the last marker was refused
  status.mergeSummary(DiagnosticStatus::WARN, "markers were refused");
}

}  // namespace verlet_cable
