// Where the renderer puts a scene: the space in which it is drawn, and what moves into it. No graphics API.
#pragma once

#include "../scene/scene.h"

namespace vitrail::tool {

// The point of the world that is (0, 0, 0) where a scene is drawn: the middle of a scene that is far away compared with
// its size, so that it keeps its precision in 32-bit floats, else 0: most scenes keep their own numbers.
glm::dvec3 drawnOrigin(const Scene& scene);

// A draw's transform into that space.
glm::mat4 placed(const glm::mat4& transform, const glm::dvec3& origin);

// A clip plane of the scene in that space: points with dot(xyz, point) + w >= 0 are kept.
glm::vec4 placedClipPlane(const glm::dvec4& plane, const glm::dvec3& origin);

} // namespace vitrail::tool
