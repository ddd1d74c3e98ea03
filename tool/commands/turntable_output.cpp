#include "turntable_output.h"

#include <fmt/format.h>

#include "errors.h"

namespace vitrail::tool {

TurntableOutput::TurntableOutput(const OutputArguments& arguments, const OutputFormat& format, std::uint32_t width,
                                 std::uint32_t height)
    : format_(format), output_(arguments.output), width_(width), height_(height), count_(*arguments.turntable) {
  if (format.kind != FileKind::Mp4) {
    pattern_ = FramePattern::of(output_);
    for (std::uint32_t i = 0; i < count_; ++i) static_cast<void>(OutputFile(pattern_->name(i)));
    return;
  }
  if (width % 2 != 0 || height % 2 != 0) {
    throw UsageError(fmt::format("--size {}x{}: the width and the height of a film are even", width, height));
  }
  film_ = std::make_unique<OutputFile>(output_);
  if (film_->isSpecial()) throw UsageError(fmt::format("{}: a film is written to a file", output_));
  requireFfmpeg(output_);
}

void TurntableOutput::add(const RenderResult& result) {
  ++added_;
  isEmpty_ = isEmpty_ && result.isEmpty;
  if (film_) {
    if (!video_) video_ = std::make_unique<Video>(*film_, width_, height_);
    return video_->add(result.picture);
  }
  waiting_.push_back(encodePicture(result, format_));
  if (!isEmpty_) keep();
}

void TurntableOutput::keep() {
  for (const std::vector<std::byte>& bytes : waiting_) {
    OutputFile file(pattern_->name(kept_++));
    file.write(bytes);
    file.commit();
  }
  waiting_.clear();
}

void TurntableOutput::finish() {
  if (!film_) return keep();
  video_->finish();
  film_->commit();
}

bool TurntableOutput::has(const OutputFile& file) const {
  if (film_) return film_->isSameAs(file);
  for (std::uint32_t i = 0; i < count_; ++i) {
    if (OutputFile(pattern_->name(i)).isSameAs(file)) return true;
  }
  return false;
}

std::string TurntableOutput::nameOf(std::uint32_t frame) const { return pattern_ ? pattern_->name(frame) : output_; }

std::string TurntableOutput::name() const {
  return film_ || count_ < 2 ? nameOf(0) : fmt::format("{} to {}", nameOf(0), nameOf(count_ - 1));
}

} // namespace vitrail::tool
