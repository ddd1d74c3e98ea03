// Models whose up axis is another than +Y, as CAD programs, scanners and surveyors write them.
#pragma once

#include <optional>
#include <string_view>

#include "scene.h"

namespace vitrail::tool {

// The axis of a file that points up.
enum class UpAxis { Y, Z, X };

std::optional<UpAxis> upAxisNamed(std::string_view name);

// From the file's axes to a scene's: a rotation that makes the up axis +Y. It only swaps coordinates and their signs,
// so it is exact. Z up: X stays to the right; X up: Z stays in front.
glm::dmat3 turnOf(UpAxis up);

// Turns all that is in a scene, which came from a file with that up axis: draws, cameras, lights, and its origin.
void turnScene(Scene& scene, UpAxis up);

} // namespace vitrail::tool
