// Where the pictures of a turn go.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "output_file.h"
#include "output_format.h"
#include "video.h"

namespace vitrail::tool {

// Many pictures, each whole, or one film. Pictures get their names as they come, but for those at the beginning that
// are empty: where all are, nothing has been written before finish().
class TurntableOutput {
 public:
  // Checks that all files can be made. Throws std::runtime_error, UsageError.
  TurntableOutput(const OutputArguments& arguments, const OutputFormat& format, std::uint32_t width,
                  std::uint32_t height);

  void add(const RenderResult& result);
  // Gives the last files their names.
  void finish();

  // Whether all pictures so far show the background alone.
  [[nodiscard]] bool isEmpty() const { return isEmpty_; }
  // Whether a file is one of those that are written.
  [[nodiscard]] bool has(const OutputFile& file) const;
  // The files in words: "turn.mp4", "frame_0000.png to frame_0035.png".
  [[nodiscard]] std::string name() const;
  // The file that a picture is in.
  [[nodiscard]] std::string nameOf(std::uint32_t frame) const;

 private:
  void keep();

  OutputFormat format_;
  std::string output_;
  std::uint32_t width_;
  std::uint32_t height_;
  std::uint32_t count_;
  std::optional<FramePattern> pattern_;
  std::unique_ptr<OutputFile> film_;
  std::unique_ptr<Video> video_;
  std::uint32_t added_ = 0;
  std::uint32_t kept_ = 0;
  std::vector<std::vector<std::byte>> waiting_; // files of empty pictures
  bool isEmpty_ = true;
};

} // namespace vitrail::tool
