// What a picture is of and how it is looked at: the options that render and compare share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "../render/renderer.h"
#include "../scene/builtin/builtin.h"
#include "../scene/camera.h"
#include "../scene/load.h"
#include "../scene/scene.h"
#include "../scene/visibility.h"
#include "camera_options.h"
#include "progress.h"
#include "warnings.h"

namespace vitrail::tool {

struct SceneArguments : WarningOptions, CameraArguments {
  std::vector<std::string> models; // none: a built-in scene
  LoadOptions load;
  std::string scene;
  std::optional<std::uint32_t> count;
  std::optional<std::uint32_t> seed;
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  std::optional<float> pointSize; // pixels
  std::optional<float> opacity;
  std::optional<Background> background;
  ObjectChoice objects;
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

// All that is drawn, upright and cut, with its warnings. Throws the same.
Scene openScene(const SceneArguments& arguments, const Progress& progress);

// What is drawn, in words: the names of its files, or that of a built-in scene.
std::string nameOfScene(const SceneArguments& arguments);

// Size, view and background. Throws UsageError where the scene does not have the camera.
RenderOptions pictureOf(const SceneArguments& arguments, const Scene& scene);

// How visibility.h sees such a picture.
Seen seenOf(const RenderOptions& picture, std::optional<float> opacity);

// Adds the warning of a picture that is sure to show nothing. Whether it is.
bool warnIfUnseen(const Scene& scene, const Seen& seen, std::vector<std::string>& warnings);

} // namespace vitrail::tool
