// EXT_mesh_gpu_instancing.
#include "instances.h"

#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "../load.h"
#include "accessor.h"

namespace vitrail::tool {

std::vector<glm::dmat4> instancesOf(const GltfDocument& document, const GltfPlacedNode& placed, Scene& scene) {
  const GltfRareParts& rare = document.nodes.rare(placed.node);
  if (!rare.instanced) return {};
  std::optional<std::size_t> count;
  const auto read = [&](std::optional<std::uint32_t> accessor, int components, std::string_view name) {
    std::vector<glm::vec4> values;
    if (!accessor) return values;
    values = readVectors(document, *accessor, components, components, name);
    if (count && *count != values.size())
      throw LoadError(fmt::format("{}: has {} instances, but {} values of {}", document.nodes.name(placed.node), *count,
                                  values.size(), name));
    count = values.size();
    return values;
  };
  const std::vector<glm::vec4> translations = read(rare.translations, 3, "TRANSLATION");
  const std::vector<glm::vec4> rotations = read(rare.rotations, 4, "ROTATION");
  const std::vector<glm::vec4> scales = read(rare.scales, 3, "SCALE");
  std::vector<glm::dmat4> instances;
  instances.reserve(count.value_or(0));
  for (std::size_t i = 0; i < count.value_or(0); ++i) {
    GltfPlace place;
    if (!translations.empty()) place.translation = glm::dvec3(translations[i]);
    if (!scales.empty()) place.scale = glm::dvec3(scales[i]);
    if (!rotations.empty()) {
      const glm::dvec4 rotation(rotations[i]);
      const double length = glm::length(rotation);
      if (length > 0.0)
        place.rotation = rotation / length;
      else
        warn(scene, "EXT_mesh_gpu_instancing: a ROTATION is zero, not a quaternion: that copy is not rotated");
    }
    instances.push_back(matrixOf(place));
  }
  return instances;
}

} // namespace vitrail::tool
