#include "threads/background_tasks.h"

#include <algorithm>
#include <chrono>

namespace verlet_cable {
namespace {

bool has_ended(const std::future<void>& task) {
  return task.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

void BackgroundTasks::run(std::function<void()> task) {
  tasks_.remove_if(has_ended);
  tasks_.push_back(std::async(std::launch::async, [task = std::move(task)]() mutable {
    task();
    task = nullptr;
  }));
}

bool BackgroundTasks::busy() const {
  return !std::all_of(tasks_.begin(), tasks_.end(), has_ended);
}

}  // namespace verlet_cable
