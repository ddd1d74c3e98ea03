#include "process.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace vitrail::tests {

namespace {

namespace fs = std::filesystem;

std::string readAll(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// In the child: never returns.
[[noreturn]] void execute(const std::vector<std::string>& arguments, const ProcessOptions& options, const fs::path& out,
                          const fs::path& error) {
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  for (const std::string& variable : options.environment) ::putenv(const_cast<char*>(variable.c_str()));
  const bool ready = std::freopen("/dev/null", "r", stdin) != nullptr &&
                     std::freopen(out.c_str(), "w", stdout) != nullptr &&
                     std::freopen(error.c_str(), "w", stderr) != nullptr &&
                     (options.folder.empty() || ::chdir(options.folder.c_str()) == 0);
  if (ready) ::execv(words[0], words.data());
  ::_exit(127);
}

} // namespace

ProcessResult run(const std::vector<std::string>& arguments, const ProcessOptions& options) {
  const TemporaryFolder texts;
  const fs::path out = texts.path() / "out";
  const fs::path error = texts.path() / "error";
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) execute(arguments, options, out, error);
  if (options.running) options.running(child);

  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error("waitpid failed");
  }
  ProcessResult result;
  result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (result.exitCode == 127) throw std::runtime_error("cannot run " + arguments[0]);
  result.out = readAll(out);
  result.error = readAll(error);
  return result;
}

std::vector<std::string> cachesIn(const std::filesystem::path& folder) {
  std::vector<std::string> variables = {"XDG_CACHE_HOME=" + folder.string()};
  const char* usual = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  if (usual != nullptr) {
    variables.push_back(std::string("MESA_SHADER_CACHE_DIR=") + usual);
  } else if (home != nullptr) {
    variables.push_back(std::string("MESA_SHADER_CACHE_DIR=") + home + "/.cache");
  }
  return variables;
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "vitrail-test-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryFolder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(path_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

} // namespace vitrail::tests
