// Gathers the colours of a PLY element, whatever their type.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "ply_body.h"

namespace vitrail::tool {

// The linear colour, packed as meshes keep it, of an sRGB one. What is not a number is 0, or opaque as alpha.
std::uint64_t packedFromSrgb(const glm::vec4& srgb);

// Adds colours to the end of `packed`, in linear light. Bytes are added at once; what other types mean is known only
// when all have been seen.
class PlyColors {
 public:
  // Without red, green and blue an alpha alone makes colours of the plain one. Without either there is nothing to
  // gather.
  PlyColors(const PlyLayout& layout, std::vector<std::uint64_t>& packed);

  bool any() const { return hasHue_ || hasAlpha_; }
  bool hasHue() const { return hasHue_; }
  void add(const PlyRow& row);
  // Adds those that waited.
  void finish();

 private:
  bool hasHue_;
  PlyType type_;
  PlyType alphaType_;
  bool hasAlpha_;
  std::vector<glm::vec4> stated_;
  std::vector<std::uint64_t>& packed_;
};

} // namespace vitrail::tool
