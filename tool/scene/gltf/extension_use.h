// Which extensions the drawn part of a glTF file has: what it loses by them is said once each.
#pragma once

#include <cstddef>
#include <map>
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
  // It is drawn but for something.
  void noteLoss(std::string_view extension, std::string_view lost) { losses_[std::string(extension)].emplace(lost); }
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
  std::map<std::string, std::set<std::string>, std::less<>> losses_; // of those in the table of what is drawn
};

} // namespace vitrail::tool
