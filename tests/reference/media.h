// Light through objects that absorb it, as docs/shading.md states it under "Volume": which draws enclose a volume, and
// what is left of light on its way along a ray, from the definition, without walking anything in order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "../../tool/scene/scene.h"

namespace vitrail::tool::reference {

// Where the ray of a sample goes through the surface of a solid, visible or not.
struct Crossing {
  std::uint32_t draw = 0;
  bool entering = true;
  double at = 0.0; // distance from the eye
};

class SolidDraws {
 public:
  SolidDraws() = default;
  // With an opacity as ReferenceOptions has it.
  SolidDraws(const Scene& scene, double opacity);

  [[nodiscard]] bool isSolid(std::uint32_t draw) const { return turns_[draw] != 0; }
  // Whether a ray that meets that side of the draw's surface goes in.
  [[nodiscard]] bool isEntry(std::uint32_t draw, bool front) const { return front == (turns_[draw] > 0); }
  // exp(-absorption * length), channel by channel, of the part of a ray between two distances that is inside of solids.
  // `crossings` are all of the ray's from `start` on, those behind opaque surfaces too.
  [[nodiscard]] glm::dvec3 left(std::span<const Crossing> crossings, double start, double end) const;

 private:
  [[nodiscard]] glm::dvec3 at(std::span<const Crossing> crossings, double distance) const;

  std::vector<int> turns_; // by draw: 1 and -1 for solids whose fronts show outwards and inwards, else 0
  std::vector<glm::dvec3> absorption_;
};

// The absorption of a material, 0 without a volume.
glm::dvec3 absorptionOf(const Material& material);

} // namespace vitrail::tool::reference
