#include "output_format.h"

#include <cctype>
#include <filesystem>

#include <fmt/format.h>

#include "../image/exr_encode.h"
#include "../image/png_encode.h"
#include "errors.h"
#include "option_values.h"

namespace vitrail::tool {

const char* const kOutputHelp =
    R"(  -o, --output FILE     the picture, .png or .exr; it appears whole or not at all. - is standard
                        output, so that another program can read it
  --format F            png or exr, where the name does not say it (default: png)
  --bits N              of a number: 8 (default) or 16 in a PNG; in an EXR 16 (half, default) or 32
                        (float). An EXR holds linear light, brighter than white too, and colours
                        multiplied by alpha
  --turntable N         N pictures of one turn around the model, from the chosen --orbit or --eye on:
                        -o frame_%04d.png writes frame_0000.png and so on, -o turn.mp4 a film of 30
                        pictures a second, where ffmpeg is installed)";

namespace {

std::optional<FileKind> kindNamed(std::string_view name) {
  if (name == "png") return FileKind::Png;
  if (name == "exr") return FileKind::Exr;
  return {};
}

// By the extension of a name; nothing for others.
std::optional<FileKind> kindOf(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".mp4") return FileKind::Mp4;
  return extension.empty() ? std::nullopt : kindNamed(std::string_view(extension).substr(1));
}

const char* kindWord(FileKind kind) {
  return kind == FileKind::Png ? "a PNG" : kind == FileKind::Exr ? "an EXR" : "a film";
}

FileKind chooseKind(const OutputArguments& arguments) {
  const std::optional<FileKind> named = kindOf(arguments.output);
  if (named && arguments.format && *named != *arguments.format) {
    throw UsageError(fmt::format("{} would be {}, --format says {}: change one of them", arguments.output,
                                 kindWord(*named), kindWord(*arguments.format)));
  }
  if (arguments.format) return *arguments.format;
  if (named) return *named;
  if (isStandardOutput(arguments) || arguments.output.starts_with("/dev/")) return FileKind::Png;
  throw UsageError(
      fmt::format("{}: pictures are written as .png or .exr, the turn of --turntable as .mp4 too", arguments.output));
}

std::uint32_t chooseBits(FileKind kind, std::optional<std::uint32_t> bits) {
  const std::uint32_t usual = kind == FileKind::Exr ? 16 : 8;
  const std::uint32_t more = 2 * usual;
  const std::uint32_t chosen = bits.value_or(usual);
  if (kind == FileKind::Mp4 ? chosen != usual : chosen != usual && chosen != more) {
    throw UsageError(kind == FileKind::Mp4
                         ? fmt::format("--bits {}: a film has 8 bits", chosen)
                         : fmt::format("--bits {}: {} has {} or {} bits", chosen, kindWord(kind), usual, more));
  }
  return chosen;
}

void checkTurntable(const OutputArguments& arguments, FileKind kind) {
  if (!arguments.turntable) {
    if (kind == FileKind::Mp4) throw UsageError("an .mp4 is for a turn: add --turntable N, the number of pictures");
    return;
  }
  if (isStandardOutput(arguments)) {
    throw UsageError("--turntable writes many pictures: name them, as in -o frame_%04d.png");
  }
  if (kind != FileKind::Mp4 && !FramePattern::of(arguments.output)) {
    throw UsageError(fmt::format(
        "{}: --turntable writes many pictures: put their number in the name, as in -o frame_%04d.png, or write an .mp4",
        arguments.output));
  }
}

} // namespace

void addOutputOptions(CLI::App& command, OutputArguments& arguments) {
  command.add_option("-o,--output", arguments.output);
  command.add_option_function<std::string>("--format", [&arguments](const std::string& text) {
    arguments.format = kindNamed(text);
    if (!arguments.format) throw CLI::ValidationError("--format", fmt::format("'{}' is none of png and exr", text));
  });
  addPositive(command, "--bits", arguments.bits);
  addFrames(command, "--turntable", arguments.turntable);
}

OutputFormat outputFormatOf(const OutputArguments& arguments) {
  if (arguments.output.empty()) throw UsageError("no output: add -o picture.png");
  const FileKind kind = chooseKind(arguments);
  checkTurntable(arguments, kind);
  return {kind, chooseBits(kind, arguments.bits)};
}

Encoding encodingOf(const OutputFormat& format) {
  if (format.kind == FileKind::Exr) return Encoding::Linear;
  return format.bits == 16 ? Encoding::Srgb16 : Encoding::Srgb8;
}

std::vector<std::byte> encodePicture(const RenderResult& result, const OutputFormat& format) {
  if (format.kind == FileKind::Exr) {
    return encodeExr(result.deep, format.bits == 32 ? ExrNumbers::Float : ExrNumbers::Half);
  }
  return format.bits == 16 ? encodePng(result.deep) : encodePng(result.picture);
}

std::optional<FramePattern> FramePattern::of(const std::string& text) {
  const std::size_t mark = text.find('%');
  if (mark == std::string::npos || text.find('%', mark + 1) != std::string::npos) return {};
  std::size_t at = mark + 1;
  FramePattern pattern;
  if (at < text.size() && text[at] == '0') {
    pattern.fill_ = '0';
    ++at;
  }
  if (at < text.size() && text[at] >= '1' && text[at] <= '9')
    pattern.digits_ = static_cast<std::size_t>(text[at++] - '0');
  if (at >= text.size() || text[at] != 'd') return {};
  pattern.before_ = text.substr(0, mark);
  pattern.after_ = text.substr(at + 1);
  return pattern;
}

std::string FramePattern::name(std::uint32_t frame) const {
  const std::string number = std::to_string(frame);
  const std::size_t missing = digits_ > number.size() ? digits_ - number.size() : 0;
  return before_ + std::string(missing, fill_) + number + after_;
}

} // namespace vitrail::tool
