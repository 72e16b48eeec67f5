#pragma once

#include <functional>
#include <future>
#include <list>
#include <memory>
#include <utility>

namespace verlet_cable {

/// What takes long, done by threads of its own; all end before this does. For one thread.
class BackgroundTasks {
 public:
  /// What the task holds is destroyed by its thread, too.
  void run(std::function<void()> task);
  /// Destroys a large value.
  template <class T>
  void dispose(T value) {
    run([held = std::make_shared<T>(std::move(value))] {});
  }
  bool busy() const;

 private:
  std::list<std::future<void>> tasks_;
};

}  // namespace verlet_cable
