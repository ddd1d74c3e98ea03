// Which extensions the drawn part of a glTF file has.
#include "extension_use.h"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "extensions.h"

namespace vitrail::tool {

void GltfExtensionUse::noteAll(const tinygltf::ExtensionMap& extensions) {
  for (const auto& [name, value] : extensions) note(name);
}

// An extension beside a picture that can be read as it is loses nothing.
void GltfExtensionUse::noteTexture(int index) {
  if (index < 0) return;
  const tinygltf::Texture& texture = document_.model.textures[static_cast<std::size_t>(index)];
  if (texture.source < 0) noteAll(texture.extensions);
}

void GltfExtensionUse::noteAccessor(int index) {
  if (index < 0) return;
  const tinygltf::Accessor& accessor = document_.model.accessors[static_cast<std::size_t>(index)];
  if (accessor.bufferView < 0) return;
  noteAll(document_.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].extensions);
}

void GltfExtensionUse::notePrimitive(const tinygltf::Primitive& primitive) {
  const auto position = primitive.attributes.find("POSITION");
  if (position != primitive.attributes.end()) noteAccessor(position->second);
  noteAccessor(primitive.indices);
  // Compressed data beside plain ones are another form of the same.
  const bool plain = position != primitive.attributes.end() &&
                     document_.model.accessors[static_cast<std::size_t>(position->second)].bufferView >= 0;
  for (const auto& [name, value] : primitive.extensions)
    if (!plain || gltfExtension(name).support != GltfSupport::Unreadable) note(name);
}

void GltfExtensionUse::noteMaterial(std::size_t index) {
  const tinygltf::Material& material = document_.model.materials[index];
  noteAll(material.extensions);
  const auto noteInfo = [this](const auto& info) {
    if (info.index < 0) return;
    noteAll(info.extensions);
    noteTexture(info.index);
  };
  noteInfo(material.pbrMetallicRoughness.baseColorTexture);
  noteInfo(material.pbrMetallicRoughness.metallicRoughnessTexture);
  noteInfo(material.normalTexture);
  noteInfo(material.occlusionTexture);
  noteInfo(material.emissiveTexture);
}

std::string GltfExtensionUse::unreadable() const {
  for (const std::string& name : names_)
    if (gltfExtension(name).support == GltfSupport::Unreadable) return name;
  return {};
}

void GltfExtensionUse::report(Scene& scene) const {
  std::vector<std::string> names = document_.extensionsUsed;
  // What exporters forget to list.
  for (const std::string& name : names_)
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  for (const std::string& name : names) {
    const GltfExtension extension = gltfExtension(name);
    const bool required = std::ranges::find(document_.extensionsRequired, name) != document_.extensionsRequired.end();
    const bool honoured = extension.support == GltfSupport::Drawn || extension.support == GltfSupport::Partly ||
                          name == "KHR_texture_basisu" || name == "KHR_meshopt_compression";
    const auto losses = losses_.find(name);
    const std::string lost =
        losses == losses_.end() ? std::string(extension.lost) : fmt::format("{}", fmt::join(losses->second, "; "));
    scene.file.extensions.push_back({name, required, honoured, lost});
    if (losses != losses_.end()) warn(scene, fmt::format("the extension {} is drawn in part: {}", name, lost));
    // Where one that nobody knows may be cannot be told.
    const bool drawn = names_.contains(name) || (required && !extension.known);
    const std::string warning = drawn ? extensionWarning(name) : std::string{};
    if (!warning.empty()) warn(scene, warning);
  }
}

} // namespace vitrail::tool
