#pragma once

#include <ros/ros.h>

#include <QObject>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace verlet_cable {

struct ServiceAnswer {
  bool success = false;
  std::string message;  ///< also where there was no answer
};

/// Calls services in a thread of its own, one after the other, so that no window waits for a node.
class ServiceCaller {
 public:
  using Done = std::function<void(const ServiceAnswer&)>;

  ServiceCaller();
  ~ServiceCaller();  ///< does not wait for answers
  ServiceCaller(const ServiceCaller&) = delete;
  ServiceCaller& operator=(const ServiceCaller&) = delete;

  /// Of services whose responses have `success` and `message`. `done` runs in the thread that made this object, if that is still
  /// there then. Calls that find too many before them are answered at once.
  template <typename Service>
  void call(const std::string& name, const typename Service::Request& request, Done done) {
    add(
        [this, name, request] {
          Service service;
          service.request = request;
          return connect<Service>(name) && client_.call(service)
                     ? ServiceAnswer{service.response.success != 0, service.response.message}
                     : ServiceAnswer{false, "no answer from " + name};
        },
        std::move(done));
  }

 private:
  struct Call {
    std::function<ServiceAnswer()> run;
    Done done;
  };

  /// Connected persistently: only such a client can be shut down while it waits for an answer.
  template <typename Service>
  bool connect(const std::string& name) {
    std::string problem;
    if (!ros::names::validate(name, problem) || !ros::service::exists(name, false)) return false;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stops_) return false;
    client_ = ros::NodeHandle().serviceClient<Service>(name, true);
    return client_.isValid();
  }

  void add(std::function<ServiceAnswer()> run, Done done);
  void run();

  QObject context_;  // receives the answers
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Call> calls_;
  ros::ServiceClient client_;
  bool stops_ = false;
  std::thread thread_;
};

}  // namespace verlet_cable
