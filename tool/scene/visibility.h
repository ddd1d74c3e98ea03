// Why a picture shows nothing of its scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "camera.h"

namespace vitrail::tool {

// How a scene is looked at.
struct Seen {
  View view;
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  std::optional<float> opacity; // of every material
};

// What is sure to leave a picture empty, in words that follow "nothing of the model is seen: "; nothing where the scene
// alone gives no reason. Of several reasons, each for other parts of the scene, the last that a part could meet is
// named. Looks at what is drawn until some of it is surely seen.
std::optional<std::string> whyNothingIsSeen(const Scene& scene, const Seen& seen);

// The warning of a model whose nodes are all hidden: no other one without draws is loaded.
std::string nothingDrawnWarning();

// The warning of a picture in which no pixel differs from the background.
std::string nothingSeenWarning(const Scene& scene, const Seen& seen);

} // namespace vitrail::tool
