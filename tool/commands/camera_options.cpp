#include "camera_options.h"

#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "../scene/turntable.h"
#include "errors.h"
#include "option_values.h"

namespace vitrail::tool {

const char* const kCameraHelp =
    R"(  --up A                the axis of the file that points up: y (default), z or x
  --camera N            camera N of the file, from 0 (default: the file's first camera;
                        without one the whole model is seen from a three-quarter view)
  --orbit AZ,EL[,ZOOM]  look from azimuth and elevation in degrees: 0,0 is the front, 90,0 the right,
                        0,90 the top; ZOOM 2 shows it twice as large
  --eye X,Y,Z           look from this place, in the file's own coordinates
  --look-at X,Y,Z       at this one (default: the middle of the model); the picture is upright
  --fov DEG             how wide --orbit and --eye look: degrees from the lower to the upper edge of
                        the picture, 1 to 170 (default 45)
  --clip-plane A,B,C,D  cut the model open: only what has A x + B y + C z >= D, in the file's own
                        coordinates, is drawn. Up to 8 times; the cut stays open)";

namespace {

constexpr float kLeastFov = 1.0F;
constexpr float kMostFov = 170.0F;

// Finite numbers with commas between them: as many as there are places, or from `least` on.
template <std::size_t Most>
std::optional<std::array<double, Most>> numbersOf(const std::string& text, std::array<double, Most> values,
                                                  std::size_t least = Most) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() < least || parts.size() > Most) return {};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto value = numberOf<double>(parts[i]);
    if (!value || !std::isfinite(*value)) return {};
    values[i] = *value;
  }
  return values;
}

Orbit orbitOf(const std::string& text) {
  const auto values = numbersOf<3>(text, {0.0, 0.0, 1.0}, 2);
  if (!values) {
    throw CLI::ValidationError("--orbit",
                               fmt::format("'{}' is not AZIMUTH,ELEVATION[,ZOOM], such as 35,20 or 0,90,2", text));
  }
  const auto [azimuth, elevation, zoom] = *values;
  if (std::abs(elevation) > 90.0) throw CLI::ValidationError("--orbit", "the elevation is between -90 and 90");
  if (zoom < 0.01 || zoom > 100.0) throw CLI::ValidationError("--orbit", "the zoom is between 0.01 and 100");
  Orbit orbit;
  orbit.azimuth = std::remainder(static_cast<float>(azimuth), 360.0F);
  orbit.elevation = static_cast<float>(elevation);
  orbit.zoom = static_cast<float>(zoom);
  return orbit;
}

void addPlace(CLI::App& command, const std::string& name, std::optional<glm::dvec3>& place) {
  command.add_option_function<std::string>(name, [name, &place](const std::string& text) {
    const auto values = numbersOf<3>(text, {});
    if (!values) throw CLI::ValidationError(name, fmt::format("'{}' is not a place X,Y,Z, such as 2,1.5,-3", text));
    place = glm::dvec3((*values)[0], (*values)[1], (*values)[2]);
  });
}

glm::dvec4 planeOf(const std::string& text) {
  const auto values = numbersOf<4>(text, {});
  if (!values) {
    throw CLI::ValidationError("--clip-plane",
                               fmt::format("'{}' is not a plane A,B,C,D, such as 1,0,0,0.5 for x >= 0.5", text));
  }
  const glm::dvec4 plane((*values)[0], (*values)[1], (*values)[2], (*values)[3]);
  const double size = glm::length(glm::dvec3(plane));
  if (!(size > 0.0) || !std::isfinite(size)) {
    throw CLI::ValidationError("--clip-plane", fmt::format("'{}' has no direction: one of A, B and C is not 0", text));
  }
  return plane / size;
}

void addClipPlanes(CLI::App& command, std::vector<glm::dvec4>& planes) {
  command
      .add_option_function<std::vector<std::string>>(
          "--clip-plane",
          [&planes](const std::vector<std::string>& texts) {
            if (texts.size() > kMostClipPlanes) {
              throw CLI::ValidationError("--clip-plane", fmt::format("a picture has at most {}", kMostClipPlanes));
            }
            planes.clear();
            for (const std::string& text : texts) planes.push_back(planeOf(text));
          })
      ->allow_extra_args(false); // one value for each time that it is named
}

void addFov(CLI::App& command, std::optional<float>& fov) {
  command.add_option_function<std::string>("--fov", [&fov](const std::string& text) {
    const auto value = numberOf<float>(text);
    if (!value || !(*value >= kLeastFov) || *value > kMostFov) {
      throw CLI::ValidationError("--fov",
                                 fmt::format("'{}' is not between {} and {} degrees", text, kLeastFov, kMostFov));
    }
    fov = *value;
  });
}

// A place of the file in the scene, which has been turned.
glm::dvec3 placeIn(const CameraArguments& arguments, const Scene& scene, const glm::dvec3& place) {
  return turnOf(arguments.up) * place - scene.origin;
}

Orbit chosenOrbit(const CameraArguments& arguments) {
  Orbit orbit = arguments.orbit.value_or(Orbit{});
  orbit.fov = arguments.fov.value_or(orbit.fov);
  return orbit;
}

LookAt chosenLook(const CameraArguments& arguments, const Scene& scene) {
  LookAt look;
  look.eye = placeIn(arguments, scene, *arguments.eye);
  const Bounds bounds = worldBounds(scene);
  look.target = arguments.lookAt ? placeIn(arguments, scene, *arguments.lookAt)
                                 : 0.5 * (glm::dvec3(bounds.min) + glm::dvec3(bounds.max));
  look.fov = arguments.fov.value_or(look.fov);
  if (look.eye == look.target) {
    throw UsageError("--eye is the middle of the model, at which it would look: add --look-at X,Y,Z");
  }
  return look;
}

} // namespace

void addCameraOptions(CLI::App& command, CameraArguments& arguments) {
  addCount(command, "--camera", arguments.camera);
  command.add_option_function<std::string>("--orbit",
                                           [&arguments](const std::string& text) { arguments.orbit = orbitOf(text); });
  addPlace(command, "--eye", arguments.eye);
  addPlace(command, "--look-at", arguments.lookAt);
  addFov(command, arguments.fov);
  addClipPlanes(command, arguments.clipPlanes);
  addChoice(command, "--up", "y, z and x", arguments.up, upAxisNamed);
}

void checkCameraArguments(const CameraArguments& arguments) {
  if (arguments.camera && arguments.orbit)
    throw UsageError("--camera and --orbit exclude each other: give one of them");
  if (arguments.camera && arguments.eye) throw UsageError("--camera and --eye exclude each other: give one of them");
  if (arguments.orbit && arguments.eye) throw UsageError("--orbit and --eye exclude each other: give one of them");
  if (arguments.camera && arguments.fov)
    throw UsageError("--fov is of --orbit and --eye: the file's camera has its own");
  if (arguments.lookAt && !arguments.eye) throw UsageError("--look-at needs a place to look from: add --eye X,Y,Z");
  if (arguments.lookAt && *arguments.lookAt == *arguments.eye) throw UsageError("--eye and --look-at are one place");
}

void placeScene(const CameraArguments& arguments, Scene& scene) {
  turnScene(scene, arguments.up);
  setClipPlanes(arguments, scene);
}

void setClipPlanes(const CameraArguments& arguments, Scene& scene) {
  scene.clipPlanes.clear();
  for (const glm::dvec4& plane : arguments.clipPlanes) {
    const glm::dvec3 direction = turnOf(arguments.up) * glm::dvec3(plane);
    scene.clipPlanes.emplace_back(direction, plane.w - glm::dot(direction, scene.origin));
  }
}

View viewOf(const CameraArguments& arguments, const Scene& scene, float aspect, bool isOneFile) {
  const std::size_t cameras = scene.cameras.size();
  if (arguments.camera) {
    if (*arguments.camera < cameras) return viewOf(scene.cameras[*arguments.camera]);
    throw UsageError(cameras == 0
                         ? "--camera: this scene has no cameras"
                         : fmt::format("--camera {}: this scene has cameras 0 to {}", *arguments.camera, cameras - 1));
  }
  if (arguments.eye) return lookFrom(scene, chosenLook(arguments, scene));
  const bool hasItsOwn = cameras > 0 && isOneFile && !arguments.orbit;
  if (!hasItsOwn) return frameScene(scene, chosenOrbit(arguments), aspect);
  View view = viewOf(scene.cameras.front());
  if (arguments.fov) view.verticalFov = glm::radians(*arguments.fov);
  return view;
}

std::vector<View> turntableOf(const CameraArguments& arguments, const Scene& scene, float aspect, std::uint32_t count) {
  if (arguments.camera) throw UsageError("--turntable goes around the model from --orbit or --eye: leave --camera out");
  if (arguments.eye) return turntable(scene, chosenLook(arguments, scene), count);
  return turntable(scene, chosenOrbit(arguments), aspect, count);
}

} // namespace vitrail::tool
