#include <fcntl.h>
#include <poll.h>
#include <signal.h>

#include <chrono>
#include <map>
#include <thread>

#include "cable_sim_fixture.h"
#include "scene_text.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable {
namespace {

using test::sound_scene;

constexpr auto patience = std::chrono::seconds(60);

template <class Condition>
bool becomes(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// The program while it runs.
class CableSimSignals : public CableSim {
 protected:
  ~CableSimSignals() override {
    if (child_ > 0) {
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
  }

  void start(std::vector<std::string> arguments, int standard_input = -1, int standard_output = -1, bool nohup = false) {
    arguments.insert(arguments.begin(), "cable_sim");
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const std::string error_path = path("err");
    child_ = fork();
    ASSERT_GE(child_, 0);
    if (child_ > 0) return;
    dup2(standard_input >= 0 ? standard_input : open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(standard_output >= 0 ? standard_output : open("/dev/null", O_WRONLY), STDOUT_FILENO);
    dup2(open(error_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDERR_FILENO);
    // Whoever runs the tests may ignore some.
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_DFL);
    if (nohup) signal(SIGHUP, SIG_IGN);
    execv(CABLE_SIM_PROGRAM, pointers.data());
    _exit(127);
  }

  /// A run without end that has written rows.
  void start_long_run(bool nohup = false) {
    start({write("scene.yaml", sound_scene), "--duration", "1e6", "--rate", "500", "--output", path("o.csv"), "--summary",
           path("s.json")},
          -1, -1, nohup);
    ASSERT_TRUE(becomes([this] {
      const std::vector<std::string> files = open_files(child_);
      std::error_code gone;
      const auto has_rows = [&](const std::string& file) {
        const bool is_output =
            file.substr(file.rfind('/')) != "/2" && std::filesystem::read_symlink(file, gone) != path("scene.yaml");
        return is_output && std::filesystem::file_size(file, gone) > 0 && !gone;
      };
      return std::any_of(files.begin(), files.end(), has_rows);
    }));
  }

  void send(int signal) const { ASSERT_EQ(kill(child_, signal), 0); }

  /// Whether the program has a handler for a signal.
  bool catches(int signal) const {
    std::ifstream file("/proc/" + std::to_string(child_) + "/status");
    for (std::string line; std::getline(file, line);)
      if (line.rfind("SigCgt:", 0) == 0) return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1)) % 2 == 1;
    return false;
  }

  bool sleeps() const {
    const std::string stat = content("/proc/" + std::to_string(child_) + "/stat");
    return stat.find(") S ") != std::string::npos;
  }

  /// What waitpid says of its end.
  int status() {
    int status = -1;
    EXPECT_TRUE(becomes([&] { return waitpid(child_, &status, WNOHANG) == child_; }));
    child_ = -1;
    err = content(path("err"));
    return status;
  }
  int exit_status() {
    const int ended = status();
    return WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
  }

 private:
  pid_t child_ = -1;
};

TEST_F(CableSimSignals, whatWasSimulatedIsWrittenWhole) {
  const std::pair<int, const char*> signals[] = {{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}};
  for (const auto& [signal, name] : signals) {
    start_long_run();
    send(signal);
    EXPECT_EQ(exit_status(), 3);
    const YAML::Node json = summary("s.json");
    EXPECT_NE(err.find("stopped at " + number_text(json["sim_time"].as<double>()) + " s: ended by " + name), std::string::npos)
        << err;
    EXPECT_EQ(parts(), std::vector<std::string>());

    // All rows of all times, one a step: the cable has 21 nodes, the scene steps of 2 ms.
    std::map<double, int> rows_at;
    double last = 0;
    for (const Row& row : rows("o.csv")) ++rows_at[last = row.time];
    EXPECT_EQ(last, json["sim_time"].as<double>());
    EXPECT_EQ(rows_at.size(), json["steps"].as<std::size_t>() + 1);
    for (const auto& [time, count] : rows_at) ASSERT_EQ(count, 21) << time;
    EXPECT_EQ(content(path("o.csv")).back(), '\n');
    // An average of the last 0.1 s, and not the last step's: the cable swings.
    EXPECT_NE(json["attachments"]["left"]["force"][2].Scalar(), json["attachments"]["left"]["force_now"][2].Scalar());
  }
}

TEST_F(CableSimSignals, aSecondOneEndsItAtOnce) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  // Nobody reads: it waits for room in the pipe, where the first signal cannot be noticed.
  start({write("scene.yaml", sound_scene), "--duration", "1e6", "--output", "/dev/stdout", "--summary", path("s.json")}, -1,
        ends[1]);
  ASSERT_TRUE(becomes([&] {
    pollfd pipe_end{ends[1], POLLOUT, 0};
    return poll(&pipe_end, 1, 0) == 0 && sleeps();
  }));
  send(SIGINT);
  send(SIGTERM);
  EXPECT_EQ(exit_status(), 3);
  close(ends[0]);
  close(ends[1]);
  EXPECT_NE(err.find("cable_sim: stopped: ended by SIG"), std::string::npos) << err;
  EXPECT_EQ(parts(), std::vector<std::string>());
  EXPECT_FALSE(exists("s.json"));
}

TEST_F(CableSimSignals, oneBeforeTheFirstStepEndsItAtOnce) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  write("o.csv", "old");
  // Nobody writes the scene.
  start({"/dev/stdin", "--output", path("o.csv")}, ends[0]);
  ASSERT_TRUE(becomes([this] { return catches(SIGINT); }));
  send(SIGINT);
  EXPECT_EQ(exit_status(), 3);
  close(ends[0]);
  close(ends[1]);
  EXPECT_EQ(err, "cable_sim: stopped: ended by SIGINT\n");
  EXPECT_EQ(content(path("o.csv")), "old");
  EXPECT_EQ(parts(), std::vector<std::string>());
}

TEST_F(CableSimSignals, whatIsIgnoredStaysIgnored) {
  start_long_run(true);
  send(SIGHUP);
  send(SIGTERM);
  EXPECT_EQ(exit_status(), 3);
  EXPECT_NE(err.find("ended by SIGTERM"), std::string::npos) << err;
}

TEST_F(CableSimSignals, killedItLeavesTheOldFileAndNothingElse) {
  write("o.csv", "old");
  start_long_run();
  send(SIGKILL);
  EXPECT_TRUE(WIFSIGNALED(status()));
  EXPECT_EQ(content(path("o.csv")), "old");
  EXPECT_FALSE(exists("s.json"));
  EXPECT_EQ(parts(), std::vector<std::string>());
}

}  // namespace
}  // namespace verlet_cable
