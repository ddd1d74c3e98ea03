#include "file_comparison.h"

#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

#include "../image/color_map.h"
#include "../image/png_decode.h"
#include "../image/png_encode.h"
#include "../report/difference.h"
#include "../scene/load.h"
#include "../scene/read_file.h"
#include "errors.h"
#include "output_file.h"

namespace vitrail::tool {

namespace {

Picture readPicture(const std::string& file) {
  try {
    return decodePng(readFile(file));
  } catch (const LoadError& error) {
    throw std::runtime_error(fmt::format("{}: {}", file, error.what()));
  }
}

Difference differenceOf(const FileComparison& files, const Picture& expected, const Picture& test) {
  if (expected.width != test.width || expected.height != test.height) {
    throw std::runtime_error(fmt::format("{} has {}x{} pixels and {} has {}x{}: pictures of one size are compared",
                                         files.expected, expected.width, expected.height, files.test, test.width,
                                         test.height));
  }
  return ComparedPicture(expected).differenceTo(test);
}

// An output is neither one of the pictures nor the other output.
void checkNames(const FileComparison& files, const std::optional<OutputFile>& heatmapFile,
                const std::optional<OutputFile>& report) {
  if (heatmapFile && report && heatmapFile->isSameAs(*report)) {
    throw UsageError("--heatmap and --json name the same file");
  }
  for (const std::string& output : {files.heatmap, files.json}) {
    for (const std::string& input : {files.expected, files.test}) {
      std::error_code error; // where one of them is not there they are not the same
      if (std::filesystem::equivalent(output, input, error)) {
        throw UsageError(fmt::format("{} would be written over: choose another name", input));
      }
    }
  }
}

} // namespace

void compareFiles(const FileComparison& files) {
  std::optional<OutputFile> heatmapFile;
  std::optional<OutputFile> report;
  if (!files.heatmap.empty()) heatmapFile.emplace(files.heatmap);
  if (!files.json.empty()) report.emplace(files.json);
  checkNames(files, heatmapFile, report);

  const Picture expected = readPicture(files.expected);
  const Picture test = readPicture(files.test);
  const Difference difference = differenceOf(files, expected, test);

  const PictureComparison compared{
      files.expected,    files.test, expected.width, expected.height, expected.hasAlpha || test.hasAlpha,
      difference.metrics};
  const std::string json = toJson(compared);
  std::vector<std::byte> png;
  if (heatmapFile) {
    png = encodePng(heatmap(difference.flip, 1.0, kMagma));
    heatmapFile->write(png);
  }
  if (report) report->write(std::as_bytes(std::span(json)));
  if (heatmapFile) heatmapFile->commit();
  if (report) report->commit();
  const bool outputIsTaken = (heatmapFile && heatmapFile->isSpecial()) || (report && report->isSpecial());
  if (!files.quiet && !outputIsTaken) {
    fmt::print("{}", toTable(compared));
  }
}

} // namespace vitrail::tool
