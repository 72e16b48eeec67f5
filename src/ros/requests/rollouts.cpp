#include "requests/rollouts.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "edit_requests/error_text.h"
#include "threads/guarded_queue.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

/// Of the threads: the live simulation goes first.
constexpr int niceness = 10;
const ros::WallDuration feedback_period(0.1);
/// Rollouts that a thread runs at once. More would let the first ones wait for the last ones.
constexpr std::size_t most_rollouts_at_once = 8;

RolloutResult failure(const std::string& message) {
  RolloutResult result;
  result.message = message;
  return result;
}

}  // namespace

Rollouts::Rollouts(ros::NodeHandle& node, const Simulation& simulation)
    : simulation_(simulation),
      server_(
          node, "rollout", [this](Server::GoalHandle goal) { accept(std::move(goal)); },
          [this](Server::GoalHandle goal) { cancel(std::move(goal)); }) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  for (unsigned i = 0; i < cores; ++i) threads_.emplace_back([this] { work(); });
  server_.start();
}

Rollouts::~Rollouts() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  new_job_.notify_all();
  for (std::thread& thread : threads_) thread.join();
  // Goals must not outlive the server, and may still come: who unloads a nodelet is not the thread that serves it.
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_.clear();
  jobs_.clear();
}

void Rollouts::accept(Server::GoalHandle goal) {
  const RolloutGoal& request = *goal.getGoal();
  const auto reject = [&](const std::string& message) { goal.setRejected(failure(message), message); };
  if (!simulation_.started()) return reject("the simulation has not started");
  // Before anything is read or copied: whoever sends too many does not keep the node busy.
  const auto most = static_cast<std::size_t>(simulation_.scene().limits.rollouts);
  if (count_jobs() >= most)
    return reject("limits.rollouts: " + std::to_string(most) + " run or wait already; allowed: no more than these");
  const std::optional<Snapshot> snapshot = simulation_.snapshot(request.snapshot);
  if (!snapshot)
    return reject("snapshot: " + verlet_cable::in_quotes(request.snapshot) +
                  "; allowed: a saved one, or empty for the present state");
  RolloutStart start{snapshot->world, {}, snapshot->scene.jump_speed};
  for (const SavedFrame& frame : snapshot->frames) start.frames.push_back(frame.input);
  try {
    auto job = std::make_shared<Job>(goal, Rollout(request, std::move(start)));
    const std::lock_guard<std::mutex> lock(mutex_);
    if (ending_) return reject("the node ends");
    goal.setAccepted();
    jobs_.push_back(job);
    waiting_.push_back(std::move(job));
  } catch (const SceneError& error) {
    return reject(join(error.errors()));
  }
  new_job_.notify_one();
}

std::size_t Rollouts::count_jobs() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return jobs_.size();
}

void Rollouts::cancel(Server::GoalHandle goal) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& job : jobs_)
    if (job->goal == goal) job->cancelled = true;
}

void Rollouts::work() {
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), niceness);
  while (true) {
    const Jobs jobs = take_waiting();
    if (jobs.empty()) return;
    run_guarded("a rollout", [&] { run(jobs); });
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& job : jobs) jobs_.remove(job);
  }
}

/// This thread's share of those that wait; none when the node ends.
Rollouts::Jobs Rollouts::take_waiting() {
  std::unique_lock<std::mutex> lock(mutex_);
  new_job_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
  Jobs jobs;
  if (ending_) return jobs;
  const std::size_t share = (waiting_.size() + threads_.size() - 1) / std::max<std::size_t>(1, threads_.size());
  for (std::size_t i = 0; i < std::min(std::max<std::size_t>(1, share), most_rollouts_at_once); ++i) {
    jobs.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }
  return jobs;
}

void Rollouts::run(Jobs jobs) const {
  WorldStepper stepper;  // of these only: it keeps as much memory as the largest of all its worlds took
  for (const auto& job : jobs) job->rollout.begin();
  std::vector<WorldStep> steps;
  while (!jobs.empty()) {
    steps.clear();
    for (const auto& job : jobs)
      if (!job->rollout.has_ended()) steps.push_back(job->rollout.next_step());
    stepper.step(steps, false);
    auto done = steps.cbegin();
    for (const auto& job : jobs) {
      if (!job->rollout.has_ended()) job->rollout.take((done++)->result);
      report(*job);
      if ((job->cancelled || ending_) && !job->rollout.has_ended()) job->rollout.cancel();
      if (job->rollout.has_ended()) end(*job);
    }
    jobs.erase(std::remove_if(jobs.begin(), jobs.end(), [](const auto& job) { return job->rollout.has_ended(); }), jobs.end());
  }
}

void Rollouts::report(Job& job) const {
  const double progress = job.rollout.progress();
  if (ros::WallTime::now() - job.reported < feedback_period && progress < 1) return;
  job.reported = ros::WallTime::now();
  RolloutFeedback feedback;
  feedback.progress = progress;
  job.goal.publishFeedback(feedback);
}

void Rollouts::end(Job& job) {
  const RolloutResult& result = job.rollout.result();
  if (result.success) {
    job.goal.setSucceeded(result, result.message);
  } else if (job.cancelled) {
    job.goal.setCanceled(result, result.message);
  } else {
    job.goal.setAborted(result, result.message);
  }
}

}  // namespace verlet_cable
