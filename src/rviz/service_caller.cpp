#include "service_caller.h"

#include <utility>

namespace verlet_cable {
namespace {

constexpr std::size_t most_calls = 20;

}  // namespace

ServiceCaller::ServiceCaller() : thread_([this] { run(); }) {}

ServiceCaller::~ServiceCaller() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stops_ = true;
    client_.shutdown();
  }
  changed_.notify_all();
  thread_.join();
}

void ServiceCaller::add(std::function<ServiceAnswer()> run, Done done) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (calls_.size() < most_calls) {
      calls_.push_back({std::move(run), std::move(done)});
      changed_.notify_all();
      return;
    }
  }
  done({false, "the node has not answered the last request yet; try again in a moment"});
}

void ServiceCaller::run() {
  for (;;) {
    Call call;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return stops_ || !calls_.empty(); });
      if (stops_) return;
      call = std::move(calls_.front());
      calls_.pop_front();
    }
    const ServiceAnswer answer = call.run();
    QMetaObject::invokeMethod(
        &context_, [done = std::move(call.done), answer] { done(answer); }, Qt::QueuedConnection);
  }
}

}  // namespace verlet_cable
