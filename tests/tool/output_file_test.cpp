// Output files in a child process that is stopped in the middle: by a signal, by a full disk.
#include <gtest/gtest.h>

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "commands/output_file.h"
#include "commands/output_folder.h"
#include "process.h"

namespace vitrail::tests {
namespace {

using tool::OutputFile;
using tool::OutputFolder;

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

// The same on a disk that takes 1000 bytes a file. Exit code 7: the work threw std::runtime_error.
int onAFullDisk(const std::function<void()>& work) {
  return inChild([&] {
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      work();
    } catch (const std::runtime_error&) {
      ::_exit(7);
    }
  });
}

// As a shell writes through it. /dev/stdout is such a link where standard output is closed.
TEST(OutputFile, ALinkToNothingStaysALink) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("there.png", folder.path() / "middle");
  std::filesystem::create_symlink(folder.path() / "middle", folder.path() / "link");
  {
    OutputFile file(folder.file("link"));
    file.write(kContent);
    file.commit();
  }
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "middle"));
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "there.png"), kContent.size());
  std::filesystem::create_symlink("nowhere/a.png", folder.path() / "lost");
  EXPECT_THROW(OutputFile(folder.file("lost")), std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "lost"));
  std::filesystem::create_symlink("round", folder.path() / "round");
  EXPECT_THROW(OutputFile(folder.file("round")), std::runtime_error);
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
  const int status = onAFullDisk([&] {
    OutputFile file(folder.file("a.png"));
    file.write(kContent);
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

TEST(OutputFolder, ASignalRemovesItWithWhatIsNotWhole) {
  const TemporaryFolder folder;
  const int status = inChild([&] {
    OutputFolder out(folder.file("out"));
    if (!folder.names().empty()) ::_exit(4); // nothing is made before there is something to write
    for (int i = 0; i < 50; ++i) out.write(std::to_string(i), kContent);
    if (folder.names().size() != 1) ::_exit(3);
    ::raise(SIGTERM);
  });
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM) << status;
  EXPECT_EQ(folder.names(), std::vector<std::string>{});
}

TEST(OutputFolder, AFullDiskRemovesItWithWhatIsNotWhole) {
  const TemporaryFolder folder;
  const int status = onAFullDisk([&] {
    OutputFolder out(folder.file("out"));
    out.write("small", std::span(kContent).first(10));
    out.write("large", kContent);
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 7) << status;
  EXPECT_EQ(folder.names(), std::vector<std::string>{});
}

TEST(OutputFolder, CommitGivesAllFilesTheirNames) {
  const TemporaryFolder folder;
  {
    OutputFolder out(folder.file("out"));
    out.write("a", kContent);
    out.write("b", kContent);
    out.commit();
  }
  EXPECT_TRUE(std::filesystem::exists(folder.file("out/a")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("out/b")));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path() / "out"), {}), 2);
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
