// Runs the program as a user would: arguments in, exit code and texts out.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace vitrail::tests {

struct ProcessResult {
  int exitCode = -1; // 128 + N where signal N ended it, as a shell says it
  std::string out;
  std::string error;
};

struct ProcessOptions {
  std::filesystem::path folder;         // where it runs; empty: here
  std::vector<std::string> environment; // NAME=value, added to this program's own
  std::function<void(pid_t)> running;   // called once, after the start
};

// Runs a program and waits for it. Throws std::runtime_error where it cannot be started.
ProcessResult run(const std::vector<std::string>& arguments, const ProcessOptions& options = {});

// The variables for a program whose caches are below a folder, but for Mesa's of compiled shaders, which stays the
// usual one: in an empty one a driver for CPUs compiles all of them again.
std::vector<std::string> cachesIn(const std::filesystem::path& folder);

// A new empty folder, removed with its content.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
  // The names of what lies in it, hidden files too, sorted.
  [[nodiscard]] std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

} // namespace vitrail::tests
