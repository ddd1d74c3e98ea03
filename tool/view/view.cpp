// `vitrail view`: a window in which models are looked at.
#include <memory>
#include <utility>

#include "../commands/commands.h"
#include "viewer.h"

namespace vitrail::tool {

namespace {

constexpr const char* kViewHelp =
    R"(Opens a window to look at models in, and through them.

Usage:
  vitrail view MODEL... [options]
  vitrail view --scene NAME [options]

In the window:
  drag                  orbits; with the right button, or shift, pans; the wheel zooms
  arrows, + and -       the same by keys; with shift the arrows pan
  F, R                  shows all of it from here; goes back to where it began
  1, 3, 7               from the front, the right, above; with ctrl from the other side
  space                 automatic rotation
  S, M, [ and ]         sorting on or off; the next method; fewer or more sorted layers
  B                     beside the picture: depth complexity, error, another method, nothing
  P                     saves the picture as NAME_1.png in the current folder
  C                     copies the command that draws the picture again, bit for bit, and prints it
  tab                   shows or hides the panel
  a file dropped in     opens

@scene@

@blend@

For scripts:
  --events FILE         writes a line of JSON for each picture that is shown, and for what happens

Which device:
@api@
@device@
  --validate            run under the Vulkan validation layer, or with OpenGL's debug output; errors
                        fail the command

Examples:
  vitrail view engine.glb --opacity 0.25
  vitrail view --scene spheres --count 64
)";

} // namespace

void addViewCommand(CLI::App& app, std::function<void()>& run) {
  CLI::App* command = app.add_subcommand("view");
  setHelpPage(*command, withPictureHelp(kViewHelp));
  const auto arguments = std::make_shared<ViewArguments>();
  addPictureOptions(*command, arguments->picture);
  command->add_option("--events", arguments->events);
  command->callback([arguments, &run] {
    run = [arguments] {
      // The window runs under it, whatever draws the pictures.
      const bool validate = std::exchange(arguments->picture.validate, false);
      checkPictureArguments(arguments->picture, "view");
      arguments->picture.validate = validate;
      runViewer(*arguments);
    };
  });
}

} // namespace vitrail::tool
