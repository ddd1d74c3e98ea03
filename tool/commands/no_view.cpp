// `vitrail view` in a program that was built without it (VITRAIL_BUILD_VIEW).
#include <stdexcept>

#include "commands.h"

namespace vitrail::tool {

void addViewCommand(CLI::App& app, std::function<void()>& run) {
  CLI::App* command = app.add_subcommand("view");
  setHelpPage(*command, "This program was built without a window: build it with VITRAIL_BUILD_VIEW=ON.\n");
  command->allow_extras();
  command->callback([&run] {
    run = [] {
      throw std::runtime_error(
          "this program was built without a window: start ./vitrail view, or build it with -DVITRAIL_BUILD_VIEW=ON");
    };
  });
}

} // namespace vitrail::tool
