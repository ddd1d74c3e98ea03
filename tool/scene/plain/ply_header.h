// Reads the header of a PLY file: what elements follow, and what each consists of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vitrail::tool {

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Int64, Uint64, Float32, Float64 };

constexpr bool isInteger(PlyType type) { return type < PlyType::Float32; }

// In bytes, as binary files hold it.
std::size_t sizeOf(PlyType type);

struct PlyProperty {
  std::string name; // in lower case
  PlyType type = PlyType::Float32;
  bool isList = false;
  PlyType countType = PlyType::Uint8;
};

struct PlyElement {
  std::string name; // in lower case
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

// Whether these are faces, by the names that programs give them.
inline bool isFaces(const PlyElement& element) {
  return element.name == "face" || element.name == "polygon" || element.name == "polygons";
}

enum class PlyEncoding { Text, LittleEndian, BigEndian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::Text;
  std::vector<PlyElement> elements;
  std::vector<std::string> textures; // of the TextureFile comments, in their order
  std::string generator;             // of the first other comment
  std::size_t bodyOffset = 0;
};

// Throws LoadError.
PlyHeader parsePlyHeader(std::string_view file);

} // namespace vitrail::tool
