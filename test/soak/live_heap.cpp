// Preloaded into a node that was built with AddressSanitizer: writes every second how much of its heap is in use [bytes] to the
// file that LIVE_HEAP_FILE names.
#include <pthread.h>
#include <sanitizer/allocator_interface.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace {

void* report(void* path) {
  for (;; sleep(1)) {
    std::FILE* const file = std::fopen(static_cast<const char*>(path), "w");
    if (file == nullptr) continue;
    std::fprintf(file, "%zu\n", __sanitizer_get_current_allocated_bytes());
    std::fclose(file);
  }
}

/// Leaves nothing to the programs that the node starts, and all signals to the node.
__attribute__((constructor)) void start() {
  char* const path = std::getenv("LIVE_HEAP_FILE");
  if (path == nullptr) return;
  unsetenv("LD_PRELOAD");
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  pthread_t thread;
  pthread_create(&thread, nullptr, report, path);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace
