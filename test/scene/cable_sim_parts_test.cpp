#include <gtest/gtest.h>

#include <algorithm>

#include "cable_sim/event_log.h"
#include "cable_sim/job.h"
#include "cable_sim/options.h"
#include "common/duration_text.h"
#include "scene/frame_source.h"
#include "scene_text.h"

namespace verlet_cable::cable_sim {
namespace {

using test::has_line;
using test::joined;

Options parse(const std::vector<std::string>& arguments, std::vector<std::string>* errors) {
  errors->clear();
  return parse_options(arguments, *errors);
}

TEST(Options, areRead) {
  std::vector<std::string> errors;
  const Options options = parse({"--duration", "2.5", "a.yaml", "--rate=5e1", "--motion", "m.csv", "--output=o.csv", "--summary",
                                 "s.json", "--settle", "__name:=x"},
                                &errors);
  EXPECT_EQ(joined(errors), "");
  EXPECT_EQ(options.scene, "a.yaml");
  EXPECT_EQ(options.duration, 2.5);
  EXPECT_EQ(options.rate, 50);
  EXPECT_EQ(options.motion, "m.csv");
  EXPECT_EQ(options.output, "o.csv");
  EXPECT_EQ(options.summary, "s.json");
  EXPECT_TRUE(options.settle);
}

TEST(Options, haveDefaults) {
  std::vector<std::string> errors;
  const Options options = parse({"a.yaml"}, &errors);
  EXPECT_EQ(joined(errors), "");
  EXPECT_EQ(options.duration, 10);
  EXPECT_EQ(options.rate, 100);
  EXPECT_FALSE(options.settle);
  EXPECT_TRUE(options.motion.empty() && options.output.empty() && options.summary.empty());
}

TEST(Options, everyMistakeIsNamedAtOnce) {
  std::vector<std::string> errors;
  parse({"--duration", "-1", "--rate=nan", "--durashun", "3", "b.yaml", "c.yaml", "--motion", "--output=", "--rate", "5"},
        &errors);
  for (const char* start : {"--duration: \"-1\"; allowed: 0 or more [s]", "--rate: \"nan\"; allowed: any number above 0",
                            "--durashun: no such option (did you mean --duration?)",
                            "\"c.yaml\": a second scene; allowed: one, and \"b.yaml\" is given already", "--motion: no value",
                            "--output: \"\"; allowed: the name of a file", "--rate: given twice"})
    EXPECT_TRUE(has_line(errors, start)) << start << "\n" << joined(errors);
  parse({}, &errors);
  EXPECT_TRUE(has_line(errors, "no scene"));
  // A value that is empty, or missing, takes nothing of what follows.
  EXPECT_EQ(parse({"--output=", "a.yaml", "--settle=x", "--settle", "---", "-5", "--", "--summary"}, &errors).scene, "a.yaml");
  for (const char* start : {"--output: \"\"", "--settle: \"x\"; allowed: no value", "--settle: given twice",
                            "---: no such option", "-5: no such option", "--: no such option"})
    EXPECT_TRUE(has_line(errors, start)) << start << "\n" << joined(errors);
}

TEST(Options, ofAnOptionThatThereIsNotTheValueIsNoSecondMistake) {
  const std::string allowed =
      "; allowed: --help, --duration, --motion, --loads, --output, --bodies, --rate, --summary, --plot, --gif, --movie, --usd, "
      "--vtk, --settle\n";
  std::vector<std::string> errors;
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"a.yaml", "--unknown", "3"}, {"--unknown", "-3", "a.yaml"}, {"--unknown", "3"}, {"a.yaml", "--unknown"}}) {
    parse(arguments, &errors);
    EXPECT_EQ(joined(errors), "--unknown: no such option" + allowed);
  }
  parse({"--durashun", "3", "a.yaml"}, &errors);
  EXPECT_EQ(joined(errors), "--durashun: no such option (did you mean --duration?)" + allowed);
  // Where a flag is meant, the scene follows.
  EXPECT_EQ(parse({"--setle", "a.yaml"}, &errors).scene, "a.yaml");
  EXPECT_EQ(joined(errors), "--setle: no such option (did you mean --settle?)" + allowed);
}

TEST(Options, helpTellsOfAllOptions) {
  std::vector<std::string> errors;
  for (const char* flag : {"--help", "-h"}) {
    const std::string help = parse({flag}, &errors).help;
    EXPECT_EQ(joined(errors), "");
    for (const char* text : {"usage: cable_sim SCENE.yaml [options]\nRuns a scene offline.\n", "  --duration S   ",
                             "  --settle   ", "put the cables into static equilibrium before t = 0\n", "exit status: 0 done"})
      EXPECT_NE(help.find(text), std::string::npos) << text << "\n" << help;
  }
  EXPECT_EQ(parse({"a.yaml"}, &errors).help, "");
}

TEST(RowSchedule, rowsAreTheFirstStepsAtOrAfterTheirTimes) {
  const RowSchedule even(100, 0.001);
  EXPECT_EQ(even.step_of(0), 0);
  EXPECT_EQ(even.step_of(1), 10);
  EXPECT_EQ(even.step_of(123456789), 1234567890);
  const RowSchedule uneven(100, 0.003);  // 0.01 s is 3.33 steps
  EXPECT_EQ(uneven.step_of(1), 4);
  EXPECT_EQ(uneven.step_of(2), 7);
  EXPECT_EQ(uneven.step_of(3), 10);
  const RowSchedule every(1000, 0.001);
  for (const std::int64_t row : {1, 3, 7, 1000003}) EXPECT_EQ(every.step_of(row), row);
}

TEST(Steps, reachTheDurationAndNoFurther) {
  EXPECT_EQ(steps_for(1, 0.001), 1000);
  EXPECT_EQ(steps_for(0.3, 0.1), 3);
  EXPECT_EQ(steps_for(1, 0.003), 334);
  EXPECT_EQ(steps_for(0, 0.001), 0);
}

TEST(FrameSource, framesMoveRestAtTheirPoseOrTheOrigin) {
  SceneDesc scene = read_scene_text(test::sound_scene);
  scene.cables[0].attachments[0].frame = "other";
  scene.cables[0].attachments.push_back(scene.cables[0].attachments[0]);
  scene.cables[0].attachments[2].frame = "moved";
  Motion motion;
  motion["moved"].add(0, {{0, 0, 0}, Quaternion::Identity()});
  motion["moved"].add(1, {{2, 0, 0}, Quaternion::Identity()});
  motion["unused"].add(0, {});
  const BoundaryInputs frames = FrameSource(scene, motion).at(0.5);
  ASSERT_EQ(frames.size(), 4u);
  for (const FrameInput& frame : frames) EXPECT_TRUE(frame.known);
  EXPECT_EQ(frames[1].pose.position, Vector3(0, 0, 0));
  EXPECT_EQ(frames[2].pose.position, Vector3(0.7, 0, 0));
  EXPECT_EQ(frames[3].pose.position, Vector3(1, 0, 0));
  ASSERT_TRUE(frames[2].velocity && frames[3].velocity);
  EXPECT_EQ(frames[2].velocity->linear, Vector3(0, 0, 0));
  EXPECT_NEAR((frames[3].velocity->linear - Vector3(2, 0, 0)).norm(), 0, 1e-14);
  EXPECT_EQ(unused_frames(scene, motion), std::vector<std::string>{"unused"});
  EXPECT_EQ(unplaced_frames(scene, motion), std::vector<std::string>{"other"});
}

TEST(FrameSource, aJumpAtTheStartIsNoVelocityToBeginWith) {
  SceneDesc scene = read_scene_text(test::sound_scene);
  scene.cables[0].attachments[0].frame = "moved";
  const auto start = [&](double duration) {
    Motion motion;
    motion["moved"].add(0, {});
    motion["moved"].add(duration, {{1, 0, 0}, Quaternion::Identity()});
    motion["moved"].add(1, {{1, 0, 0}, Quaternion::Identity()});
    const BoundaryInputs inputs = FrameSource(scene, motion).at(0);
    for (const FrameInput& input : inputs)
      if (input.velocity->linear.norm() > 0) return input.velocity->linear.x();
    return 0.0;
  };
  EXPECT_EQ(start(0.001), 0);
  EXPECT_EQ(start(0.005), 0);
  EXPECT_NEAR(start(0.5), 2, 1e-12);
}

TEST(Durations, areInUnitsThatSuitThem) {
  EXPECT_EQ(tools::progress_text(359.1, 1e5), "6 of 1667 min");
  EXPECT_EQ(tools::progress_text(0.26, 2), "0.3 of 2 s");
  EXPECT_EQ(tools::progress_text(59.6, 100), "60 of 100 s");
  EXPECT_EQ(tools::progress_text(4e5, 4e6), "111 of 1111 h");
  EXPECT_EQ(tools::duration_text(2.11e3), "35 min");
  EXPECT_EQ(tools::duration_text(119), "119 s");
  EXPECT_EQ(tools::duration_text(120), "2.0 min");
  EXPECT_EQ(tools::duration_text(0.34), "0.3 s");
  EXPECT_EQ(tools::duration_text(3e4), "8.3 h");
}

TEST(EventLog, anEpisodeIsTwoEventsHoweverManySteps) {
  const SceneDesc scene = read_scene_text(test::sound_scene);
  const BoundaryInputs frames = FrameSource(scene, {}).at(0);
  World world(scene, frames);
  tools::ProgressBar progress(1);
  EventLog log(progress);
  StepResult bad;
  bad.ignored_frame = 1;
  testing::internal::CaptureStderr();
  for (int i = 0; i < 400; ++i) {
    world.step(frames);
    // Comes and goes from 0.1 s to 0.3 s.
    log.observe(world, i >= 49 && i < 150 && i % 2 == 1 ? bad : StepResult{}, {});
  }
  const std::string printed = testing::internal::GetCapturedStderr();
  const std::vector<Event> events = log.events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].type, "frame_out_of_range");
  EXPECT_EQ(events[0].frame, world.frames()[1]);
  EXPECT_DOUBLE_EQ(events[0].time, 0.1);
  EXPECT_EQ(events[1].type, "frame_out_of_range_end");
  EXPECT_DOUBLE_EQ(events[1].time, 0.3);
  EXPECT_EQ(events[1].message, "ended, after 0.2 s");
  EXPECT_NE(printed.find("frame_out_of_range: " + world.frames()[1]), std::string::npos) << printed;
}

TEST(EventLog, aDegradedStepHasOneCause) {
  SceneDesc scene = read_scene_text(R"(
time_step: 0.005
nets: [{name: flag, grid: {rows: 6, columns: 8, spacing: 0.05}, mass: 1.0e-4, stiffness: 1.0e+6, damping: 10,
        attachments: [{name: pole, node: 0}]}])");
  World world(scene, FrameSource(scene, {}).at(0));
  tools::ProgressBar progress(1);
  EventLog log(progress);
  testing::internal::CaptureStderr();
  log.observe(world, world.step(FrameSource(scene, {}).at(0)), {});
  testing::internal::GetCapturedStderr();
  ASSERT_EQ(log.events().size(), 1u);
  EXPECT_EQ(log.events()[0].type, "degraded");
  EXPECT_EQ(log.events()[0].message, "its springs are too stiff for the time_step, and were softened; use a shorter time_step");
}

/// A rope that hangs into a table, and is carried out of it.
TEST(EventLog, aStatusSaysOfWhatItIsAndHowLongItLasted) {
  SceneDesc scene = read_scene_text(R"(
time_step: 0.005
materials: {m: {linear_density: 0.05, radius: 0.004}}
cables: [{name: rope, length: 1.0, segments: 20, material: m, initial: {type: straight, from: [0, 0, 0.6], to: [0, 0, -0.4]},
          attachments: [{name: hand, at: start, frame: hand, initial_pose: [0, 0, 0.6, 0, 0, 0]}]}]
obstacles: [{name: table, type: plane}])");
  BoundaryInputs frames = FrameSource(scene, {}).at(0);
  World world(scene, frames);
  tools::ProgressBar progress(1);
  EventLog log(progress);
  testing::internal::CaptureStderr();
  for (int i = 0; i < 600; ++i) {
    frames[1].pose.position.z() = 0.6 + std::min(1e-3 * i, 0.5);
    log.observe(world, world.step(frames), {});
  }
  const std::string printed = testing::internal::GetCapturedStderr();
  std::vector<Event> events = log.events();
  // What pushes it out is energy that comes from nowhere.
  events.erase(std::remove_if(events.begin(), events.end(), [](const Event& event) { return event.type == "ENERGY"; }),
               events.end());
  ASSERT_EQ(events.size(), 2u) << printed;
  EXPECT_EQ(events[0].type, "inside_obstacle");
  EXPECT_EQ(events[0].cable, "rope");
  EXPECT_EQ(events[0].other, "table");
  EXPECT_DOUBLE_EQ(events[0].time, 0.005);
  EXPECT_EQ(events[1].type, "inside_obstacle_end");
  EXPECT_GT(events[1].time, 0.1);
  EXPECT_NE(events[1].message.find("; deepest 0.4"), std::string::npos) << events[1].message;
}

}  // namespace
}  // namespace verlet_cable::cable_sim
