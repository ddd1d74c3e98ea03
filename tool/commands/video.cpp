#include "video.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "option_values.h"

namespace vitrail::tool {

namespace {

constexpr int kOutput = 3; // ffmpeg's descriptor of the file

// The first folder of PATH that has it; empty where none has.
std::string findFfmpeg() {
  const char* path = std::getenv("PATH");
  for (const std::string& folder : split(path != nullptr ? path : "", ':')) {
    const std::string file = folder + "/ffmpeg";
    if (!folder.empty() && ::access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

// The file is written by its descriptor, not by its name: what was removed meanwhile does not come back.
std::vector<std::string> wordsFor(const std::string& program, std::uint32_t width, std::uint32_t height) {
  return {program,
          "-nostdin",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "rawvideo",
          "-pix_fmt",
          "rgba",
          "-s",
          fmt::format("{}x{}", width, height),
          "-framerate",
          "30",
          "-i",
          "pipe:0",
          "-an",
          "-vf",
          "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
          "-crf",
          "18",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "iec61966-2-1",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          fmt::format("/proc/self/fd/{}", kOutput)};
}

// What a new process has as its first descriptors.
class Descriptors {
 public:
  Descriptors() { posix_spawn_file_actions_init(&actions_); }
  ~Descriptors() { posix_spawn_file_actions_destroy(&actions_); }
  Descriptors(const Descriptors&) = delete;
  Descriptors& operator=(const Descriptors&) = delete;

  void add(int from, int to) { posix_spawn_file_actions_adddup2(&actions_, from, to); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

pid_t start(const std::vector<std::string>& words, int input, int output, int messages) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str())); // it is not written to
  arguments.push_back(nullptr);
  // Above those that they become, so that none is taken before it is copied.
  const int high = ::fcntl(input, F_DUPFD_CLOEXEC, 10);
  const int highOutput = ::fcntl(output, F_DUPFD_CLOEXEC, 10);
  const int highMessages = ::fcntl(messages, F_DUPFD_CLOEXEC, 10);
  Descriptors descriptors;
  descriptors.add(high, STDIN_FILENO);
  descriptors.add(highMessages, STDOUT_FILENO);
  descriptors.add(highMessages, STDERR_FILENO);
  descriptors.add(highOutput, kOutput);
  pid_t child = -1;
  const int error = posix_spawn(&child, words.front().c_str(), descriptors.get(), nullptr, arguments.data(), environ);
  for (const int file : {high, highOutput, highMessages}) ::close(file);
  if (error != 0) throw std::runtime_error(fmt::format("cannot run {}: {}", words.front(), std::strerror(error)));
  return child;
}

} // namespace

void requireFfmpeg(const std::string& output) {
  if (!findFfmpeg().empty()) return;
  throw std::runtime_error(fmt::format(
      "cannot write {}: ffmpeg, which makes films, is not installed; install it, or write pictures: -o frame_%04d.png",
      output));
}

Video::Video(OutputFile& file, std::uint32_t width, std::uint32_t height)
    : name_(file.name()), messages_(std::tmpfile()) {
  requireFfmpeg(name_);
  std::array<int, 2> ends{};
  if (!messages_ || ::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error(fmt::format("cannot write {}: {}", name_, std::strerror(errno)));
  }
  pipe_ = ends[1];
  // Where ffmpeg ends early the write fails, and says so.
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &oldPipe_);
  int output = -1;
  try {
    output = file.create();
    child_ = start(wordsFor(findFfmpeg(), width, height), ends[0], output, ::fileno(messages_.get()));
  } catch (...) {
    if (output >= 0) ::close(output);
    ::close(ends[0]);
    ::close(pipe_);
    sigaction(SIGPIPE, &oldPipe_, nullptr);
    throw;
  }
  ::close(output);
  ::close(ends[0]);
}

Video::~Video() {
  if (pipe_ >= 0) ::close(pipe_);
  if (child_ > 0) {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }
  sigaction(SIGPIPE, &oldPipe_, nullptr);
}

void Video::fail() {
  std::array<char, 256> line{};
  std::rewind(messages_.get());
  const bool said = std::fgets(line.data(), static_cast<int>(line.size()), messages_.get()) != nullptr;
  line[std::strcspn(line.data(), "\n")] = '\0';
  throw std::runtime_error(fmt::format("cannot write {}: ffmpeg {}{}", name_, said ? "says: " : "failed", line.data()));
}

void Video::add(const Picture& picture) {
  const std::uint8_t* data = picture.rgba.data();
  for (std::size_t left = picture.rgba.size(); left > 0;) {
    const ssize_t written = ::write(pipe_, data, left);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return finish(); // which says why
    data += written;
    left -= static_cast<std::size_t>(written);
  }
}

void Video::finish() {
  if (child_ < 0) fail();
  ::close(pipe_);
  pipe_ = -1;
  int status = 0;
  while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  if (status != 0) fail();
}

} // namespace vitrail::tool
