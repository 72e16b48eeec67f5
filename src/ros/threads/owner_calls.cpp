#include "threads/owner_calls.h"

#include <ros/init.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <future>
#include <memory>
#include <utility>

namespace verlet_cable {
namespace {

/// How often who waits looks whether the node ends.
constexpr std::chrono::milliseconds look_period(50);

class Call : public ros::CallbackInterface {
 public:
  Call(std::function<void(const Answer&)> request, Answer answer) : request_(std::move(request)), answer_(std::move(answer)) {}

  CallResult call() override {
    try {
      request_(answer_);
    } catch (const std::exception& error) {
      answer_({false, std::string("the request failed: ") + error.what(), {}});
      throw;  // the queue's guard reports it
    }
    return Success;
  }

 private:
  const std::function<void(const Answer&)> request_;
  const Answer answer_;
};

}  // namespace

OwnerCalls::~OwnerCalls() {
  end();
  queue_.removeByID(reinterpret_cast<std::uint64_t>(this));
}

std::future<EditResult> OwnerCalls::begin(std::function<void(const Answer&)> request) {
  // Shared, as the answer may come when nobody waits any longer.
  const auto promise = std::make_shared<std::promise<EditResult>>();
  std::future<EditResult> future = promise->get_future();
  const auto answered = std::make_shared<std::atomic_flag>();
  const Answer answer = [promise, answered](const EditResult& result) {
    if (!answered->test_and_set()) promise->set_value(result);
  };
  queue_.addCallback(boost::make_shared<Call>(std::move(request), answer), reinterpret_cast<std::uint64_t>(this));
  return future;
}

EditResult OwnerCalls::wait(std::future<EditResult> answer) const {
  // Not ros::ok(), which is true until all callbacks have ended.
  while (!ending_ && !ros::isShuttingDown()) {
    if (answer.wait_for(look_period) == std::future_status::ready) return answer.get();
  }
  return {false, "the node shuts down", {}};
}

}  // namespace verlet_cable
