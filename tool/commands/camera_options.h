// How a scene is looked at and what of it is cut away: options that render and compare share.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <CLI/CLI.hpp>

#include "../scene/camera.h"
#include "../scene/scene.h"
#include "../scene/turn.h"

namespace vitrail::tool {

// Places are in the file's own coordinates: before it is turned, and whatever Scene::origin is.
struct CameraArguments {
  std::optional<std::uint32_t> camera;
  std::optional<Orbit> orbit;
  std::optional<glm::dvec3> eye;
  std::optional<glm::dvec3> lookAt;
  std::optional<float> fov; // degrees
  UpAxis up = UpAxis::Y;
  std::vector<glm::dvec4> clipPlanes; // what is kept has dot(xyz, place) >= w; xyz is not 0
};

// Adds them all. Texts that cannot be understood end the parse with a CLI::ValidationError.
void addCameraOptions(CLI::App& command, CameraArguments& arguments);

// Takes the place of the mark @camera@ in a help page.
extern const char* const kCameraHelp;

// Checks what one option alone does not show. Throws UsageError.
void checkCameraArguments(const CameraArguments& arguments);

// Gives a scene that was turned upright the clip planes, and no others.
void setClipPlanes(const CameraArguments& arguments, Scene& scene);

// Turns a scene upright and gives it its clip planes.
void placeScene(const CameraArguments& arguments, Scene& scene);

// The view of such a scene; `isOneFile`: it may have cameras that were made for all of it. Throws UsageError where the
// scene does not have the camera.
View viewOf(const CameraArguments& arguments, const Scene& scene, float aspect, bool isOneFile);

// The views of a turn. Throws UsageError.
std::vector<View> turntableOf(const CameraArguments& arguments, const Scene& scene, float aspect, std::uint32_t count);

} // namespace vitrail::tool
