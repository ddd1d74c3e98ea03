// Which extensions the drawn part of a glTF file has: what it loses by them is said once each.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

#include "../scene.h"
#include "document.h"

namespace vitrail::tool {

class GltfExtensionUse {
 public:
  explicit GltfExtensionUse(const GltfDocument& document) : document_(document) {}

  // Something that is drawn has them.
  void note(std::string_view extension) { names_.emplace(extension); }
  void notePrimitive(const tinygltf::Primitive& primitive);
  void noteMaterial(std::size_t material);

  // The extension without which a mesh that was noted could not be read; empty where there is none.
  [[nodiscard]] std::string unreadable() const;

  // Warns of what is lost, and lists all extensions of the file.
  void report(Scene& scene) const;

 private:
  void noteAll(const tinygltf::ExtensionMap& extensions);
  void noteTexture(int index);
  void noteAccessor(int index);

  const GltfDocument& document_;
  std::set<std::string, std::less<>> names_;
};

} // namespace vitrail::tool
