// What tells the geometry of two primitives apart.
#include "geometry_key.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace vitrail::tool {
namespace {

// The bytes of numbers, one after the other. Texts come with their length.
class Key {
 public:
  template <typename Number>
  void add(Number number) {
    char bytes[sizeof(Number)];
    std::memcpy(bytes, &number, sizeof number);
    text_.append(bytes, sizeof bytes);
  }
  void add(const std::string& text) {
    add(text.size());
    text_ += text;
  }
  // Those attributes that make a mesh, with their accessors; -1 where there is none.
  void addAttributes(const std::map<std::string, int>& attributes, const GltfMaterial& material, bool skinned) {
    const auto accessor = [&](const std::string& name) {
      const auto found = attributes.find(name);
      add(found == attributes.end() ? -1 : found->second);
    };
    for (const char* name : {"POSITION", "NORMAL", "TANGENT", "COLOR_0"}) accessor(name);
    for (const std::uint32_t set : material.texCoordSets) accessor(fmt::format("TEXCOORD_{}", set));
    if (!skinned) return;
    for (const char* name : {"JOINTS_0", "WEIGHTS_0", "JOINTS_1", "WEIGHTS_1"}) accessor(name);
  }
  // Compressed geometry, for example.
  void addValue(const tinygltf::Value& value) {
    std::vector<const tinygltf::Value*> waiting{&value};
    while (!waiting.empty()) {
      const tinygltf::Value& next = *waiting.back();
      waiting.pop_back();
      add(static_cast<int>(next.Type()));
      if (next.IsNumber()) add(next.GetNumberAsDouble());
      if (next.IsString()) add(next.Get<std::string>());
      if (next.IsArray() || next.IsObject()) add(next.Size());
      if (next.IsArray())
        for (const tinygltf::Value& element : next.Get<tinygltf::Value::Array>()) waiting.push_back(&element);
      if (!next.IsObject()) continue;
      for (const auto& [name, member] : next.Get<tinygltf::Value::Object>()) {
        add(name);
        waiting.push_back(&member);
      }
    }
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

} // namespace

std::string geometryKey(const tinygltf::Primitive& primitive, const GltfMaterial& material,
                        std::span<const double> weights, std::optional<std::uint32_t> skin) {
  Key key;
  key.add(primitive.mode);
  key.add(primitive.indices);
  key.add(skin.value_or(0xffffffff));
  key.addAttributes(primitive.attributes, material, skin.has_value());
  for (std::size_t i = 0; i < std::min(primitive.targets.size(), weights.size()); ++i) {
    if (weights[i] == 0.0) continue;
    key.add(weights[i]);
    key.addAttributes(primitive.targets[i], material, false);
  }
  // Tangents are made along the coordinates of the normal texture.
  const TextureSlot& normals = material.material.normalTexture;
  key.add(normals.image >= 0);
  if (normals.image >= 0) {
    key.add(normals.texCoord);
    key.add(normals.transform);
  }
  for (const auto& [name, value] : primitive.extensions) {
    if (name == "KHR_materials_variants") continue;
    key.add(name);
    key.addValue(value);
  }
  return key.take();
}

} // namespace vitrail::tool
