#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "scene_text.h"

namespace verlet_cable {
namespace {

using test::errors_of;

TEST(SceneLimits, memoryThatIsNotThereIsANamedError) {
  const pid_t child = fork();
  if (child == 0) {
    std::string text = "cables: [";
    for (int i = 0; i < 400'000; ++i) text += "1, ";
    rlimit limit{};
    getrlimit(RLIMIT_AS, &limit);
    // What is there already, and some more.
    std::ifstream pages("/proc/self/statm");
    rlim_t size = 0;
    pages >> size;
    limit.rlim_cur = size * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + 20'000'000;
    setrlimit(RLIMIT_AS, &limit);
    const auto errors = errors_of(text + "1]");
    _exit(errors == std::vector<std::string>{"scene: needs more memory than there is"} ? 0 : 1);
  }
  int status = -1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace verlet_cable
