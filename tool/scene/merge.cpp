#include "merge.h"

#include <cstdint>
#include <filesystem>
#include <iterator>
#include <utility>

#include "texture_slots.h"

namespace vitrail::tool {

namespace {

template <class Value>
void append(std::vector<Value>& to, std::vector<Value>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

glm::vec4 moved(const glm::vec4& place, const glm::dvec3& by) {
  return glm::vec4(glm::dvec3(place) + by, static_cast<double>(place.w));
}

// Turns the numbers of meshes, materials and images into those of a scene that has others before them, and places into
// those about another origin.
void renumber(Scene& scene, const Scene& before) {
  const glm::dvec3 by = scene.origin - before.origin;
  for (Material& material : scene.materials) {
    forEachSlot(material, [&](const char* /*use*/, TextureSlot& slot) {
      if (slot.image >= 0) slot.image += static_cast<std::int32_t>(before.images.size());
    });
  }
  for (Draw& draw : scene.draws) {
    draw.mesh += static_cast<std::uint32_t>(before.meshes.size());
    draw.material += static_cast<std::uint32_t>(before.materials.size());
    draw.transform[3] = moved(draw.transform[3], by);
  }
  for (SceneCamera& camera : scene.cameras) camera.cameraToWorld[3] = moved(camera.cameraToWorld[3], by);
  for (Light& light : scene.lights) light.position = glm::vec3(glm::dvec3(light.position) + by);
}

// Puts all objects below one of the file's name.
void putBelow(Scene& scene, const std::string& name) {
  nameDraws(scene);
  ObjectTree tree;
  const std::uint32_t first = tree.append(scene.objects, tree.add(std::filesystem::path(name).filename().string()));
  for (Draw& draw : scene.draws) draw.object += first;
  scene.objects = std::move(tree);
}

void prefixWarnings(Scene& scene, const std::string& name) {
  for (std::string& warning : scene.warnings) warning.insert(0, name + ": ");
}

} // namespace

Scene mergeScenes(std::vector<Scene> scenes, const std::vector<std::string>& names) {
  if (scenes.size() == 1) return std::move(scenes.front());
  for (std::size_t i = 0; i < scenes.size(); ++i) putBelow(scenes[i], names[i]);
  Scene merged = std::move(scenes.front());
  prefixWarnings(merged, names.front());
  for (std::size_t i = 1; i < scenes.size(); ++i) {
    Scene& scene = scenes[i];
    renumber(scene, merged);
    prefixWarnings(scene, names[i]);
    append(merged.meshes, scene.meshes);
    append(merged.images, scene.images);
    append(merged.materials, scene.materials);
    const std::uint32_t first = merged.objects.append(scene.objects, ObjectTree::none);
    for (Draw& draw : scene.draws) draw.object += first;
    append(merged.draws, scene.draws);
    append(merged.cameras, scene.cameras);
    append(merged.lights, scene.lights);
    append(merged.warnings, scene.warnings);
    if (!merged.background) merged.background = scene.background;
  }
  return merged;
}

} // namespace vitrail::tool
