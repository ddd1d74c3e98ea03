// The renderer in double precision: one ray a sample, every surface on it, shaded, sorted and blended. It is written
// from docs/shading.md and the glTF specification and shares nothing with the GPU renderer but the scene and the view;
// what the node formats round it has from tests/library/reference/node.h, which is written without the shaders too.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "../../tool/image/picture.h"
#include "../../tool/scene/camera.h"
#include "../../tool/scene/scene.h"
#include "vitrail/layout.h"

namespace vitrail::tool::reference {

struct ReferenceOptions {
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  View view;
  Background background;
  std::optional<float> opacity; // X-ray view: every material is blended with this factor
  std::uint32_t samples = 1;    // 1, 2, 4 or 8, at Vulkan's standard positions; the picture is their mean
  std::uint32_t nodeFormat = layout::VITRAIL_FORMAT_STANDARD; // what `rounded` is stored as
};

// A picture in both forms: linear with premultiplied alpha, and as 8-bit sRGB with straight alpha.
struct ReferencePicture {
  std::vector<glm::dvec4> linear;
  Picture picture;
};

// How many fragments a pixel's list may have: the least and the most that any rays within 1/256 pixel of its samples
// met.
struct LayerRange {
  std::uint32_t least = 0;
  std::uint32_t most = 0;
};

struct Reference {
  ReferencePicture exact;   // no rounding anywhere; transparent colours clamped as the node format clamps them
  ReferencePicture rounded; // transparent fragments as the node format stores them, then sorted and blended
  // Fragments of each pixel that a list holds: transparent, seen at a sample, and not stored as nothing.
  std::vector<std::uint32_t> layers;
  std::vector<LayerRange> layerRanges;
  // 1 where a renderer that is right may differ: the `exact` picture changes by more than 0.5/255 in a channel on the
  // sRGB curve where the rays move diagonally by 1/256 pixel (Vulkan snaps corners to a grid that fine), or where
  // surfaces at almost the same depth (1e-6 of it; with `compact` nodes what their codes cannot tell apart) change
  // places. With several samples the corners of triangles move, too, half as far. Elsewhere 0.
  std::vector<std::uint8_t> edge;
};

// Renders on all processors. Throws std::invalid_argument for a scene with textures other than base colour ones: those
// are beyond this reference. Texture filtering is bilinear on the base level, without mipmaps.
Reference renderReference(const Scene& scene, const ReferenceOptions& options);

} // namespace vitrail::tool::reference
