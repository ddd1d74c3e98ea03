// `vitrail compare A.png B.png`: how far one picture is from another.
#pragma once

#include <string>

namespace vitrail::tool {

struct FileComparison {
  std::string expected;
  std::string test;
  std::string heatmap; // where the FLIP error of each pixel goes; empty: nowhere
  std::string json;    // empty: no report
  bool quiet = false;
};

// Throws std::runtime_error for a file that is no PNG, for pictures of different sizes, and where a file cannot be
// written, UsageError where one file would be written over another.
void compareFiles(const FileComparison& files);

} // namespace vitrail::tool
