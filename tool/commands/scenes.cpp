// `vitrail scenes`: lists the built-in scenes.
#include <fmt/format.h>

#include "../scene/builtin/builtin.h"
#include "commands.h"

namespace vitrail::tool {

namespace {

constexpr const char* kScenesHelp = R"(Lists the built-in scenes: what each shows, and what --count counts.

Usage:
  vitrail scenes

Draw one with   vitrail render --scene NAME [--count N] [--seed S] -o picture.png
)";

void runScenes() {
  for (const BuiltinScene& scene : builtinScenes()) {
    fmt::print("{:<12} {}\n{:<12} --count {}: {} (1 to {})\n", scene.name, scene.summary, "", scene.defaultCount,
               scene.countMeaning, scene.maxCount);
  }
}

} // namespace

void addScenesCommand(CLI::App& app, std::function<void()>& run) {
  addPlainCommand(app, run, "scenes", kScenesHelp, runScenes);
}

} // namespace vitrail::tool
