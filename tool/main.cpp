// The program `vitrail`: parses the command line, runs one command, reports a failure once.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <functional>
#include <new>

#include "commands/commands.h"
#include "commands/errors.h"
#include "scene/message.h"

namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kUsage = 2;

constexpr const char* kHelp =
    R"(Vitrail draws transparent models exactly: every pixel's surfaces are blended in depth order.

Usage:
  vitrail view MODEL                      look at a model in a window
  vitrail render MODEL -o picture.png     draw glTF, OBJ, PLY and STL models
  vitrail render --scene NAME -o pic.png  draw a built-in scene
  vitrail pick MODEL --at X,Y             list the surfaces under a pixel, front to back
  vitrail scenes                          list the built-in scenes
  vitrail compare MODEL -o DIR            compare transparency methods: their pictures and their costs
  vitrail compare A.png B.png             compare two pictures
  vitrail bench                           measure what transparency costs on a device
  vitrail info MODEL                      tell what is in a model's file
  vitrail info                            list the devices that pictures are drawn on, and what they can do

  vitrail COMMAND --help                  all about one command
  vitrail --version

Exit codes: 0 done, 1 could not be done, 2 wrong usage.
)";

int report(int code, const char* reason) {
  fmt::print(stderr, "vitrail: error: {}\n", vitrail::tool::printable(reason)); // it may quote a file's bytes
  return code;
}

int runProgram(int argc, char** argv) {
  CLI::App app;
  vitrail::tool::setHelpPage(app, kHelp);
  app.set_version_flag("--version", "vitrail " VITRAIL_TOOL_VERSION);
  app.require_subcommand(0, 1);
  std::function<void()> run;
  vitrail::tool::addRenderCommand(app, run);
  vitrail::tool::addViewCommand(app, run);
  vitrail::tool::addPickCommand(app, run);
  vitrail::tool::addCompareCommand(app, run);
  vitrail::tool::addBenchCommand(app, run);
  vitrail::tool::addInfoCommand(app, run);
  vitrail::tool::addScenesCommand(app, run);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success); // --help, --version
  } catch (const CLI::ParseError& error) {
    return report(kUsage, fmt::format("{} (see vitrail {}--help)", error.what(),
                                      app.get_subcommands().empty() ? "" : app.get_subcommands()[0]->get_name() + " ")
                              .c_str());
  }
  if (!run) {
    fmt::print(stderr, "{}", kHelp);
    return kUsage;
  }
  run();
  if (std::fflush(stdout) != 0) return report(kFailed, "cannot write to standard output");
  return kDone;
}

} // namespace

int main(int argc, char** argv) {
  try {
    return runProgram(argc, argv);
  } catch (const vitrail::tool::UsageError& error) {
    return report(kUsage, error.what());
  } catch (const std::bad_alloc&) {
    return report(kFailed, "out of memory");
  } catch (const std::exception& error) {
    return report(kFailed, error.what());
  }
}
