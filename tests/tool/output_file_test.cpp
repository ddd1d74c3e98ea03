// Output files in a child process that is stopped in the middle: by a signal, by a full disk.
#include <gtest/gtest.h>

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <stdexcept>
#include <vector>

#include "commands/output_file.h"
#include "process.h"

namespace vitrail::tests {
namespace {

using tool::OutputFile;

const std::vector<std::byte> kContent(100000, std::byte{42});

// Runs `work` in a child process. Returns its wait status.
int inChild(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    ::_exit(0);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return status;
}

TEST(OutputFile, ASignalRemovesWhatIsNotWhole) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const TemporaryFolder folder;
    const int status = inChild([&] {
      OutputFile file(folder.file("a.png"));
      file.write(kContent);
      if (folder.names().size() != 1) ::_exit(3); // the part is there
      ::raise(signal);
    });
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
    EXPECT_EQ(folder.names(), std::vector<std::string>{});
  }
}

TEST(OutputFile, AFullDiskRemovesWhatIsNotWhole) {
  const TemporaryFolder folder;
  const int status = inChild([&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000}; // bytes a file may have
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      OutputFile file(folder.file("a.png"));
      file.write(kContent);
    } catch (const std::runtime_error&) {
      ::_exit(7);
    }
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 7) << status;
  EXPECT_EQ(folder.names(), std::vector<std::string>{});
}

TEST(OutputFile, WithoutCommitNothingStays) {
  const TemporaryFolder folder;
  {
    OutputFile file(folder.file("a.png"));
    file.write(kContent);
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{});
  OutputFile file(folder.file("a.png"));
  file.write(kContent);
  file.commit();
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.png"});
}

TEST(OutputFile, TheSameFileUnderTwoNames) {
  const TemporaryFolder folder;
  std::filesystem::create_directory_symlink(folder.path(), folder.path() / "loop");
  const OutputFile one(folder.file("a.png"));
  EXPECT_TRUE(one.isSameAs(OutputFile(folder.file("loop/a.png"))));
  EXPECT_FALSE(one.isSameAs(OutputFile(folder.file("b.png"))));
}

} // namespace
} // namespace vitrail::tests
