// The program under test, and what every test of it asks: run it, read its report, see it refuse.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "process.h"

namespace vitrail::tests {

using Json = nlohmann::json;
using Words = std::vector<std::string>;

inline const std::string kTool = VITRAIL_TEST_TOOL;
inline const std::string kSanitizedTool = VITRAIL_TEST_SANITIZED_TOOL; // takes bad files; kTool where it was not built
// What takes bad options: both, each once.
inline const std::vector<std::string> kTools =
    kTool == kSanitizedTool ? std::vector{kTool} : std::vector{kTool, kSanitizedTool};

// Runs the program in a folder, or as the options say.
ProcessResult vitrail(const TemporaryFolder& folder, Words words, const std::string& tool = kTool);
ProcessResult vitrail(Words words, const ProcessOptions& options = {});

// What the program shows of a command, such as "bench --quiet", on a terminal.
std::string onTerminal(const TemporaryFolder& folder, const std::string& command);

std::string readText(const std::filesystem::path& path);
Json readJson(const std::filesystem::path& path);

// Expects that a command is refused: one line on standard error that says why, nothing on standard output, and nothing
// beside what was in the folder. Without a folder it runs in an empty one.
void expectRefusal(const TemporaryFolder& folder, const std::string& tool, const Words& words, int exitCode,
                   const std::string& reason);
void expectRefusal(const std::string& tool, const Words& words, int exitCode, const std::string& reason = "");

} // namespace vitrail::tests
