// Films, which another program makes: ffmpeg, where it is installed.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include <sys/types.h>
#include <csignal>

#include "../image/picture.h"
#include "output_file.h"

namespace vitrail::tool {

// Throws std::runtime_error that says what to do where there is no ffmpeg among the folders of PATH.
void requireFfmpeg(const std::string& output);

// Pictures of one size on their way to a file, in the form of .mp4, 30 of them a second.
class Video {
 public:
  // Starts ffmpeg, which writes to the file's temporary name. Throws std::runtime_error.
  Video(OutputFile& file, std::uint32_t width, std::uint32_t height);
  ~Video();
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;

  // Throws std::runtime_error with ffmpeg's reason.
  void add(const Picture& picture);
  // Waits until the file is complete; it can be committed then. Throws std::runtime_error with ffmpeg's reason.
  void finish();

 private:
  [[noreturn]] void fail();

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string name_;
  std::unique_ptr<std::FILE, Close> messages_; // what ffmpeg says
  int pipe_ = -1;
  pid_t child_ = -1;
  struct sigaction oldPipe_ {};
};

} // namespace vitrail::tool
