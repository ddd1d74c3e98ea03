#include "output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "errors.h"

namespace vitrail::tool {

namespace {

namespace fs = std::filesystem;

// The temporary files that a signal must remove: a picture and its report, or those of a whole folder and it.
struct Slot {
  std::array<char, 4096> path{};
  std::atomic<bool> used{false};
};
std::array<Slot, 128> slots;

void removeTemporaries(int signal) {
  for (auto slot = slots.rbegin(); slot != slots.rend(); ++slot) { // a folder after the files in it
    if (slot->used.load() && ::unlink(slot->path.data()) != 0) ::rmdir(slot->path.data());
  }
  ::signal(signal, SIG_DFL); // and end the way the signal ends a program
  ::raise(signal);
}

void watch(const fs::path& path) {
  static const bool installed = [] {
    ::signal(SIGXFSZ, SIG_IGN); // a file that may not be so large is then an error as others are
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
      struct sigaction old {};
      struct sigaction action {};
      action.sa_handler = removeTemporaries;
      sigaction(signal, nullptr, &old);
      if (old.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr); // nohup stays nohup
    }
    return true;
  }();
  static_cast<void>(installed);
  for (Slot& slot : slots) {
    if (slot.used.load() || path.native().size() >= slot.path.size()) continue;
    std::memcpy(slot.path.data(), path.c_str(), path.native().size() + 1);
    slot.used.store(true);
    return;
  }
}

void unwatch(const fs::path& path) {
  for (Slot& slot : slots) {
    if (slot.used.load() && path.native() == slot.path.data()) slot.used.store(false);
  }
}

[[noreturn]] void fail(const fs::path& path, const char* reason) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", path.string(), reason));
}

void writeAll(int file, std::span<const std::byte> content, const fs::path& path) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int reason = errno;
      ::close(file);
      fail(path, std::strerror(reason));
    }
    content = content.subspan(static_cast<std::size_t>(written));
  }
  if (::close(file) != 0) fail(path, std::strerror(errno));
}

// Where links lead to whose file is not there: it is made there, as a shell makes it. Else the new file would take the
// place of the link: of /dev/stdout itself, where standard output is closed.
fs::path endOfLinks(fs::path path) {
  constexpr int kMost = 40; // as the system
  std::error_code error;
  for (int i = 0; i < kMost && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    const fs::path to = fs::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / to;
  }
  if (fs::is_symlink(fs::symlink_status(path, error))) fail(path, std::strerror(ELOOP));
  return path;
}

} // namespace

OutputFile::OutputFile(fs::path path) : path_(std::move(path)), target_(path_) {
  isStandardOutput_ = isSpecial_ = path_ == "-";
  if (isSpecial_) return;
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (fs::is_directory(status)) fail(path_, "it is a folder");
  isSpecial_ = fs::exists(status) && !fs::is_regular_file(status);
  if (isSpecial_) return;
  if (fs::exists(status)) target_ = fs::canonical(path_, error); // a link stays a link to the new file
  if (error && fs::exists(status)) fail(path_, error.message().c_str());
  if (!fs::exists(status)) target_ = endOfLinks(path_);
  if (fs::exists(status) && ::access(target_.c_str(), W_OK) != 0) fail(path_, std::strerror(errno));
  fs::path folder = target_.parent_path();
  if (folder.empty()) folder = ".";
  if (!fs::exists(folder, error)) fail(path_, fmt::format("there is no folder {}", folder.string()).c_str());
  if (!fs::is_directory(folder, error)) fail(path_, fmt::format("{} is not a folder", folder.string()).c_str());
  if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(path_, std::strerror(errno));
}

OutputFile OutputFile::standardOutput() { return OutputFile(Standard{}); }

OutputFile::~OutputFile() {
  if (temporary_.empty()) return;
  ::unlink(temporary_.c_str());
  unwatch(temporary_);
}

void OutputFile::write(std::span<const std::byte> content) {
  if (isSpecial_) {
    special_ = content;
    return;
  }
  writeAll(create(), content, path_);
}

int OutputFile::create() {
  const fs::path name = target_.parent_path() / fmt::format(".{}.{}.part", target_.filename().string(), ::getpid());
  watch(name); // before the file exists: a signal in between finds nothing to remove
  const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); // never through a link
  if (file < 0) {
    const int reason = errno;
    unwatch(name); // somebody else's
    fail(path_, std::strerror(reason));
  }
  temporary_ = name;
  return file;
}

bool OutputFile::isSameAs(const OutputFile& other) const {
  std::error_code error;
  const auto place = [&](const fs::path& path) { return fs::weakly_canonical(fs::absolute(path, error), error); };
  if (isStandardOutput_ && other.isStandardOutput_) return true;
  return !isSpecial_ && !other.isSpecial_ && place(target_) == place(other.target_);
}

bool OutputFile::overwrites(const std::filesystem::path& file) const {
  std::error_code error;
  return !isSpecial_ && fs::equivalent(target_, file, error) && !error;
}

void checkNotRead(const OutputFile& output, std::span<const std::string> files) {
  for (const std::string& file : files) {
    if (!output.overwrites(file)) continue;
    throw UsageError(fmt::format("{}: a file that is read would be written over: choose another name", output.name()));
  }
}

void OutputFile::commit() {
  if (isSpecial_) {
    const int file =
        isStandardOutput_ ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0) : ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0) fail(name(), std::strerror(errno));
    writeAll(file, special_, name());
    return;
  }
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(path_, std::strerror(errno));
  unwatch(temporary_);
  temporary_.clear();
}

void watchFolder(const fs::path& folder) { watch(folder); }
void unwatchFolder(const fs::path& folder) { unwatch(folder); }

} // namespace vitrail::tool
