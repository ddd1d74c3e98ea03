#include "vitrail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace vitrail::tests {

ProcessResult vitrail(const TemporaryFolder& folder, Words words, const std::string& tool) {
  words.insert(words.begin(), tool);
  ProcessOptions options;
  options.folder = folder.path();
  return run(words, options);
}

ProcessResult vitrail(Words words, const ProcessOptions& options) {
  words.insert(words.begin(), kTool);
  return run(words, options);
}

std::string onTerminal(const TemporaryFolder& folder, const std::string& command) {
  return run({"/usr/bin/script", "-qec", kTool + " " + command, "/dev/null"},
             {.folder = folder.path(), .environment = {}, .running = {}})
      .out;
}

std::string readText(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Json readJson(const std::filesystem::path& path) { return Json::parse(readText(path)); }

void expectRefusal(const TemporaryFolder& folder, const std::string& tool, const Words& words, int exitCode,
                   const std::string& reason) {
  std::string command;
  for (const std::string& word : words) command += " " + word;
  SCOPED_TRACE(tool + command);
  const Words before = folder.names();
  const ProcessResult result = vitrail(folder, words, tool);
  EXPECT_EQ(result.exitCode, exitCode) << result.error;
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(result.error.starts_with("vitrail: error: ")) << result.error;
  EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
  EXPECT_LT(result.error.size(), 500U) << result.error;
  EXPECT_NE(result.error.find(reason), std::string::npos) << result.error;
  EXPECT_EQ(folder.names(), before);
}

void expectRefusal(const std::string& tool, const Words& words, int exitCode, const std::string& reason) {
  expectRefusal(TemporaryFolder(), tool, words, exitCode, reason);
}

} // namespace vitrail::tests
