// What a picture is of and how it is looked at: the options that render and compare share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "../render/still.h"
#include "../scene/builtin/builtin.h"
#include "../scene/camera.h"
#include "../scene/load.h"
#include "../scene/scene.h"
#include "warnings.h"

namespace vitrail::tool {

struct SceneArguments : WarningOptions {
  std::string model; // empty: a built-in scene
  LoadOptions load;
  std::string scene;
  std::optional<std::uint32_t> count;
  std::optional<std::uint32_t> seed;
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  std::optional<std::uint32_t> camera;
  std::optional<Orbit> orbit;
  std::optional<float> pointSize; // pixels
  std::optional<float> opacity;
  std::optional<Background> background;
};

// Adds all of them but MODEL. Texts that cannot be understood end the parse with a CLI::ValidationError.
void addSceneOptions(CLI::App& command, SceneArguments& arguments);

// A help page with all of them and MODEL in place of the mark @scene@.
std::string withSceneHelp(const std::string& page);

// --time, --animation and --variant.
void addLoadOptions(CLI::App& command, LoadOptions& options);

// Their lines of a help page.
extern const std::string_view kLoadHelp;

// Throws UsageError where a built-in scene is to be drawn with one of them.
void checkLoadOptions(const LoadOptions& options, bool model);

// Checks what one option alone does not show. Throws UsageError.
void checkSceneArguments(const SceneArguments& arguments, const std::string& command);

// Throws std::runtime_error that names the file, or UsageError.
Scene openModel(const std::string& file, const LoadOptions& options);
Scene openBuiltin(const std::string& name, const BuiltinOptions& options);
Scene openScene(const SceneArguments& arguments);

// Size, view and background. Throws UsageError where the scene does not have the camera.
RenderOptions pictureOf(const SceneArguments& arguments, const Scene& scene);

// Destroys the device once all that was made on it is gone. Throws std::runtime_error where the validation layer has
// reported errors.
void closeValidated(Gpu& gpu);

} // namespace vitrail::tool
