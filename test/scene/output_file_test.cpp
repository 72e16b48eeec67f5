#include "common/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "cable_sim_fixture.h"
#include "scene/named_file.h"

namespace verlet_cable::tools {
namespace {

constexpr mode_t permissions = 07777;

mode_t mode_of(const std::string& path) {
  struct stat status {};
  EXPECT_EQ(stat(path.c_str(), &status), 0);
  return status.st_mode & permissions;
}

/// In a directory of its own.
class OutputFileTest : public CableSim {
 protected:
  /// Writes "new" without an end to it.
  void begin(OutputFile& file, const std::string& name) const {
    EXPECT_EQ(file.open(path(name)), "");
    file.write("new", 3);
    EXPECT_FALSE(file.is_direct());
  }
};

TEST_F(OutputFileTest, isThereWhenItIsWhole) {
  write("old", "old");
  {
    OutputFile file, other;
    begin(file, "old");
    begin(other, "none");
    EXPECT_EQ(content(path("old")), "old");
    EXPECT_EQ(names(), std::vector<std::string>{"old"});
  }
  EXPECT_EQ(names(), std::vector<std::string>{"old"});
  EXPECT_EQ(content(path("old")), "old");

  OutputFile file;
  begin(file, "old");
  EXPECT_EQ(file.finish(), "");
  EXPECT_EQ(content(path("old")), "new");
  EXPECT_EQ(names(), std::vector<std::string>{"old"});
}

TEST_F(OutputFileTest, whatAnEarlierRunHasLeftIsInNobodysWay) {
  write("o." + std::to_string(getpid()) + "-0.part", "left");
  EXPECT_EQ(write_file(path("o"), "new"), "");
  EXPECT_EQ(content(path("o")), "new");
  EXPECT_EQ(content(path("o." + std::to_string(getpid()) + "-0.part")), "left");
}

TEST_F(OutputFileTest, linksAndPermissionsStay) {
  write("real", "old");
  chmod(path("real").c_str(), 0640);
  std::filesystem::create_directory(path("d"));
  std::filesystem::create_symlink("../real", path("d/link"));
  std::filesystem::create_symlink("d/missing", path("dangling"));
  EXPECT_EQ(write_file(path("d/link"), "new"), "");
  EXPECT_EQ(write_file(path("dangling"), "made"), "");
  EXPECT_TRUE(std::filesystem::is_symlink(path("d/link")) && std::filesystem::is_symlink(path("dangling")));
  EXPECT_EQ(content(path("real")), "new");
  EXPECT_EQ(mode_of(path("real")), 0640u);
  EXPECT_EQ(content(path("d/missing")), "made");
  const mode_t mask = umask(0);
  umask(mask);
  EXPECT_EQ(mode_of(path("d/missing")), 0666u & ~mask);
}

TEST_F(OutputFileTest, namesMayBeLongAndHaveSpaces) {
  for (const std::string& name : {std::string(255, 'n'), std::string("a b 'c'")}) {
    EXPECT_EQ(write_file(path(name), "text"), "") << name;
    EXPECT_EQ(content(path(name)), "text") << name;
  }
  EXPECT_NE(write_file(path(std::string(256, 'n')), "text").find("File name too long"), std::string::npos);
}

TEST_F(OutputFileTest, devicesAreWrittenDirectly) {
  OutputFile file;
  ASSERT_EQ(file.open("/dev/full"), "");
  EXPECT_TRUE(file.is_direct());
  file.write("ab", 2);
  EXPECT_TRUE(file.has_failed());
  EXPECT_EQ(file.finish(), "No space left on device");
  EXPECT_EQ(write_file("/dev/null", "ab"), "");
}

TEST_F(OutputFileTest, openStreamsAreWrittenDirectly) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const std::string stream = "/dev/fd/" + std::to_string(ends[1]);
  EXPECT_EQ(write_file(stream, "ab"), "");
  char text[3] = "";
  EXPECT_EQ(read(ends[0], text, 2), 2);
  EXPECT_STREQ(text, "ab");
  EXPECT_EQ(why_not_writable("/dev/fd/" + std::to_string(ends[0])), "Bad file descriptor");
  EXPECT_TRUE(is_same_file(stream, stream));
  close(ends[0]);
  std::signal(SIGPIPE, SIG_IGN);
  EXPECT_NE(write_file(stream, "ab").find("Broken pipe"), std::string::npos);
  std::signal(SIGPIPE, SIG_DFL);
  close(ends[1]);
}

TEST_F(OutputFileTest, aFullPipeThatDoesNotBlockIsWaitedFor) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_NONBLOCK), 0);
  const pid_t reader = fork();
  if (reader == 0) {
    close(ends[1]);
    fcntl(ends[0], F_SETFL, 0);
    std::size_t total = 0;
    std::array<char, 4096> buffer;
    for (ssize_t size = 1; size > 0; total += static_cast<std::size_t>(size)) size = read(ends[0], buffer.data(), buffer.size());
    _exit(total == 1'000'000 ? 0 : 1);
  }
  close(ends[0]);
  EXPECT_EQ(write_file("/dev/fd/" + std::to_string(ends[1]), std::string(1'000'000, 'x')), "");
  close(ends[1]);
  int status = -1;
  EXPECT_EQ(waitpid(reader, &status, 0), reader);
  EXPECT_EQ(status, 0);
}

/// A limit on the size of files is a disk that is full, for who is not root.
TEST_F(OutputFileTest, aFullDiskLeavesWhatWasThere) {
  write("o", "old");
  const pid_t child = fork();
  if (child == 0) {
    const rlimit limit{1000, 1000};
    std::signal(SIGXFSZ, SIG_IGN);
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(2);
    _exit(write_file(path("o"), std::string(1001, 'x')).find("\": File too large") != std::string::npos ? 0 : 1);
  }
  int status = -1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(content(path("o")), "old");
  EXPECT_EQ(names(), std::vector<std::string>{"o"});
}

TEST_F(OutputFileTest, whatCannotBeRenamedIsNamed) {
  OutputFile file;
  begin(file, "o");
  std::filesystem::create_directory(path("o"));
  const std::string problem = file.finish();
  EXPECT_NE(problem.find("Is a directory; all of it is in \"" + path("o.")), std::string::npos) << problem;
  ASSERT_EQ(names().size(), 2u);
  EXPECT_EQ(content(path(names()[1])), "new");
}

TEST_F(OutputFileTest, onlyWhatIsThereIsNamed) {
  std::filesystem::create_directory(path("d"));
  OutputFile file;
  begin(file, "d/o");
  std::filesystem::remove_all(path("d"));
  EXPECT_EQ(file.finish(), "No such file or directory");
}

TEST_F(OutputFileTest, roomThatIsNotUsedIsGivenBack) {
  OutputFile file;
  begin(file, "o");
  file.reserve(1'000'000);
  struct stat status {};
  ASSERT_EQ(stat(open_files(getpid()).at(0).c_str(), &status), 0);
  EXPECT_EQ(status.st_size, 3);
  EXPECT_EQ(file.finish(), "");
  EXPECT_EQ(content(path("o")), "new");
  ASSERT_EQ(stat(path("o").c_str(), &status), 0);
  EXPECT_LT(status.st_blocks * 512, 100'000);
}

/// A directory in which there is no /proc, and so no way to name a file later.
TEST_F(OutputFileTest, whereFilesNeedNamesTheUnfinishedOnesAreRecognisedAndCanBeRemovedAtOnce) {
  if (geteuid() != 0) GTEST_SKIP() << "only root may change the root directory";
  const pid_t child = fork();
  if (child == 0) {
    if (chroot(path("").c_str()) != 0 || chdir("/") != 0) _exit(2);
    OutputFile file, whole;
    if (!file.open("/a").empty() || !whole.open("/b").empty()) _exit(3);
    file.write("new", 3);
    const std::string part = "." + std::to_string(getpid()) + "-0.part";
    if (access(("/a" + part).c_str(), F_OK) != 0 || access(("/b" + part).c_str(), F_OK) != 0) _exit(4);
    if (!whole.finish().empty()) _exit(5);
    remove_unfinished_files();
    _exit(0);
  }
  int status = -1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(names(), std::vector<std::string>{"b"});
}

TEST_F(OutputFileTest, saysWhyItCannotBeWritten) {
  EXPECT_EQ(why_not_writable(path("new")), "");
  EXPECT_EQ(why_not_writable("/nonexistent/file"), "No such file or directory");
  EXPECT_EQ(why_not_writable("/"), "Is a directory");
  EXPECT_EQ(why_not_writable(path("")), "Is a directory");
  EXPECT_EQ(why_not_writable("/dev/null/file"), "Not a directory");
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0666), 0);
  EXPECT_EQ(why_not_writable(path("fifo")), "it is a named pipe");
  EXPECT_EQ(why_not_readable(path("fifo")), "it is a named pipe");
  EXPECT_EQ(why_not_readable(path("new")), "");
  std::filesystem::create_symlink("circle", path("circle"));
  EXPECT_EQ(why_not_writable(path("circle")), "Too many levels of symbolic links");
}

TEST_F(OutputFileTest, permissionsAreAskedForBefore) {
  write("file", "");
  chmod(path("file").c_str(), 0444);
  chmod(path("").c_str(), 0555);
  constexpr int unreachable = 3;
  const pid_t child = fork();
  if (child == 0) {
    if (geteuid() == 0 && setuid(65534) != 0) _exit(2);
    if (access(path("").c_str(), X_OK) != 0) _exit(unreachable);
    _exit(why_not_writable(path("file")) == "Permission denied" &&
                  why_not_writable(path("new")) == "no file can be made in its directory: Permission denied"
              ? 0
              : 1);
  }
  int status = -1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  chmod(path("").c_str(), 0755);
  if (WIFEXITED(status) && WEXITSTATUS(status) == unreachable) GTEST_SKIP() << "nobody else can reach " << path("");
  EXPECT_EQ(status, 0);
}

TEST_F(OutputFileTest, knowsWhatIsTheSameFile) {
  write("a", "");
  std::filesystem::create_symlink("a", path("link"));
  std::filesystem::create_hard_link(path("a"), path("hard"));
  std::filesystem::create_symlink("new", path("dangling"));
  for (const char* other : {"a", "link", "hard"}) EXPECT_TRUE(is_same_file(path("a"), path(other))) << other;
  EXPECT_TRUE(is_same_file(path("new"), path("dangling")));
  EXPECT_FALSE(is_same_file(path("a"), path("new")));
  EXPECT_FALSE(is_same_file(path("new"), path("other")));
  EXPECT_FALSE(is_same_file("/dev/null", "/dev/null"));
  EXPECT_TRUE(is_same_file("/dev/stdout", "/dev/fd/1"));
  EXPECT_TRUE(is_standard_output("/dev/stdout"));
  EXPECT_FALSE(is_standard_output(path("a")));
  EXPECT_FALSE(is_standard_output(""));
}

}  // namespace
}  // namespace verlet_cable::tools
