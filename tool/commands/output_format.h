// What pictures are written as: the options of render that say so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "../render/renderer.h"

namespace vitrail::tool {

enum class FileKind { Png, Exr, Mp4 };

struct OutputArguments {
  std::string output;
  std::optional<FileKind> format;
  std::optional<std::uint32_t> bits;
  std::optional<std::uint32_t> turntable; // pictures of one turn
};

struct OutputFormat {
  FileKind kind = FileKind::Png;
  std::uint32_t bits = 8; // of a number
};

// -o, --format, --bits and --turntable. Texts that cannot be understood end the parse with a CLI::ValidationError.
void addOutputOptions(CLI::App& command, OutputArguments& arguments);

// Takes the place of the mark @output@ in a help page.
extern const char* const kOutputHelp;

// What the options ask for. Throws UsageError.
OutputFormat outputFormatOf(const OutputArguments& arguments);

inline bool isStandardOutput(const OutputArguments& arguments) { return arguments.output == "-"; }

Encoding encodingOf(const OutputFormat& format);

// A file of a picture of that encoding; of pictures, not of films. Throws std::runtime_error.
std::vector<std::byte> encodePicture(const RenderResult& result, const OutputFormat& format);

// Names with a number in them: frame_%04d.png.
class FramePattern {
 public:
  // Nothing for a text that does not have one mark %d, or %04d with however many digits.
  static std::optional<FramePattern> of(const std::string& text);
  [[nodiscard]] std::string name(std::uint32_t frame) const;

 private:
  std::string before_;
  std::string after_;
  std::size_t digits_ = 0;
  char fill_ = ' ';
};

} // namespace vitrail::tool
