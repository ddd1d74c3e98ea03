// Loads PLY: text and binary of both byte orders. Vertices may have normals, colours (red, green, blue, alpha; also
// under the names r g b a and diffuse_red ...) and texture coordinates; faces are polygons or triangle strips. All
// other elements and properties are skipped.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../load.h"
#include "../mesh_build.h"
#include "../message.h"
#include "model.h"
#include "polygon.h"
#include "text_reader.h"

namespace vitrail::tool {
namespace {

enum class Type { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

std::size_t sizeOf(Type type) {
  constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

struct Property {
  std::string name;
  Type type = Type::Float32;
  bool isList = false;
  Type countType = Type::Uint8;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { Text, LittleEndian, BigEndian };

struct Header {
  Encoding encoding = Encoding::Text;
  std::vector<Element> elements;
  std::string texture; // from a TextureFile comment
  std::size_t bodyOffset = 0;
};

Type parseType(std::string_view word, const TextLines& lines) {
  constexpr std::array<std::pair<std::string_view, Type>, 16> types{{{"char", Type::Int8},
                                                                     {"int8", Type::Int8},
                                                                     {"uchar", Type::Uint8},
                                                                     {"uint8", Type::Uint8},
                                                                     {"short", Type::Int16},
                                                                     {"int16", Type::Int16},
                                                                     {"ushort", Type::Uint16},
                                                                     {"uint16", Type::Uint16},
                                                                     {"int", Type::Int32},
                                                                     {"int32", Type::Int32},
                                                                     {"uint", Type::Uint32},
                                                                     {"uint32", Type::Uint32},
                                                                     {"float", Type::Float32},
                                                                     {"float32", Type::Float32},
                                                                     {"double", Type::Float64},
                                                                     {"float64", Type::Float64}}};
  for (const auto& [name, type] : types)
    if (word == name) return type;
  lines.fail(fmt::format("\"{}\" is not a PLY type", oneLine(word)));
}

Property parseProperty(TextLines& lines) {
  Property property;
  std::string_view type = lines.word();
  if (type == "list") {
    property.isList = true;
    property.countType = parseType(lines.word(), lines);
    if (property.countType >= Type::Float32) lines.fail("a list's length is not an integer");
    type = lines.word();
  }
  property.type = parseType(type, lines);
  property.name = lines.word();
  if (property.name.empty()) lines.fail("a property has no name");
  return property;
}

Element parseElement(TextLines& lines) {
  Element element;
  element.name = lines.word();
  const std::string_view count = lines.word();
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (count.empty() || error != std::errc{} || end != count.data() + count.size())
    lines.fail(fmt::format("\"{}\" is not a count of elements", oneLine(count)));
  return element;
}

Encoding parseEncoding(TextLines& lines) {
  const std::string_view name = lines.word();
  if (name == "ascii") return Encoding::Text;
  if (name == "binary_little_endian") return Encoding::LittleEndian;
  if (name == "binary_big_endian") return Encoding::BigEndian;
  lines.fail(fmt::format("\"{}\" is not a PLY format", oneLine(name)));
}

Header parseHeader(std::string_view text) {
  Header header;
  TextLines lines(text);
  if (!lines.next() || lines.word() != "ply") throw LoadError("the file does not begin with \"ply\"");
  bool hasFormat = false;
  while (lines.next()) {
    const std::string_view word = lines.word();
    if (word == "end_header") {
      if (!hasFormat) throw LoadError("the PLY header states no format");
      header.bodyOffset = lines.nextLineOffset();
      return header;
    }
    if (word == "format") {
      header.encoding = parseEncoding(lines);
      hasFormat = true;
    } else if (word == "element") {
      header.elements.push_back(parseElement(lines));
    } else if (word == "property") {
      if (header.elements.empty()) lines.fail("a property comes before any element");
      header.elements.back().properties.push_back(parseProperty(lines));
    } else if (word == "comment" && lines.word() == "TextureFile") {
      header.texture = lines.rest();
    }
    // Other lines are comments, or what careless writers left there.
  }
  throw LoadError("the PLY header does not end");
}

// The values of the body, one after the other, whatever their encoding.
class PlyBody {
 public:
  PlyBody(std::span<const std::byte> bytes, Encoding encoding) : bytes_(bytes), encoding_(encoding) {}

  // Throws LoadError where there is no room for `count` things of at least `bytes` bytes each in a binary file, before
  // memory is taken for them.
  void require(std::uint64_t count, std::size_t bytes, std::string_view what) const {
    // In text each takes a character and a separator at least; the last one needs no separator.
    const std::size_t least = encoding_ == Encoding::Text ? 2 : bytes;
    if (count > (bytes_.size() - offset_ + 1) / least)
      throw LoadError(
          fmt::format("{} {} are stated, but only {} bytes are left", count, oneLine(what), bytes_.size() - offset_));
  }

  // `where` is called for the message, as in "vertex 7".
  template <typename Where>
  double next(Type type, Where where) {
    if (encoding_ == Encoding::Text) return nextWord(where);
    const std::size_t size = sizeOf(type);
    if (bytes_.size() - offset_ < size) throw LoadError(fmt::format("the file ends in {}", where()));
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = encoding_ == Encoding::BigEndian ? i : size - 1 - i;
      bits = (bits << 8U) | std::to_integer<std::uint64_t>(bytes_[offset_ + place]);
    }
    offset_ += size;
    return decode(type, bits);
  }

 private:
  static double decode(Type type, std::uint64_t bits) {
    switch (type) {
      case Type::Int8:
        return static_cast<std::int8_t>(bits);
      case Type::Int16:
        return static_cast<std::int16_t>(bits);
      case Type::Int32:
        return static_cast<std::int32_t>(bits);
      case Type::Float32:
        return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
      case Type::Float64:
        return std::bit_cast<double>(bits);
      default:
        return static_cast<double>(bits);
    }
  }

  template <typename Where>
  double nextWord(Where where) {
    const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t begin = text.find_first_not_of(blanks, offset_);
    if (begin == std::string_view::npos) throw LoadError(fmt::format("the file ends in {}", where()));
    const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    offset_ = end;
    float value = 0.0F;
    if (parseWhole(word)) return whole_;
    if (!parseFloat(word, value))
      throw LoadError(fmt::format("{}: \"{}\" is not a finite number", where(), oneLine(word)));
    return static_cast<double>(value);
  }

  // Integers are kept exact, where a float would round them.
  bool parseWhole(std::string_view word) {
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    whole_ = static_cast<double>(number);
    return error == std::errc{} && end == word.data() + word.size();
  }

  std::span<const std::byte> bytes_;
  Encoding encoding_;
  std::size_t offset_ = 0;
  double whole_ = 0.0;
};

// What a vertex property fills.
enum class Slot { None, X, Y, Z, NormalX, NormalY, NormalZ, Red, Green, Blue, Alpha, U, V };
constexpr std::size_t slotCount = 13;

Slot slotOf(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, Slot>, 24> slots{{
      {"x", Slot::X},
      {"y", Slot::Y},
      {"z", Slot::Z},
      {"nx", Slot::NormalX},
      {"ny", Slot::NormalY},
      {"nz", Slot::NormalZ},
      {"red", Slot::Red},
      {"green", Slot::Green},
      {"blue", Slot::Blue},
      {"alpha", Slot::Alpha},
      {"r", Slot::Red},
      {"g", Slot::Green},
      {"b", Slot::Blue},
      {"a", Slot::Alpha},
      {"diffuse_red", Slot::Red},
      {"diffuse_green", Slot::Green},
      {"diffuse_blue", Slot::Blue},
      {"diffuse_alpha", Slot::Alpha},
      {"u", Slot::U},
      {"v", Slot::V},
      {"s", Slot::U},
      {"t", Slot::V},
      {"texture_u", Slot::U},
      {"texture_v", Slot::V},
  }};
  for (const auto& [known, slot] : slots)
    if (name == known) return slot;
  return Slot::None;
}

// Integer colours run to their type's largest value, floating ones to 1.
double colorScale(Type type) {
  constexpr std::array<double, 8> largest{127.0, 255.0, 32767.0, 65535.0, 2147483647.0, 4294967295.0, 1.0, 1.0};
  return 1.0 / largest[static_cast<std::size_t>(type)];
}

// Not a number where a float cannot hold it; what uses it decides what that means.
float narrowed(double value) {
  constexpr auto largest = static_cast<double>(std::numeric_limits<float>::max());
  return std::abs(value) <= largest ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
}

// Reads the body's elements in the order that the header states.
class PlyReader {
 public:
  PlyReader(const Header& header, std::span<const std::byte> body) : header_(header), body_(body, header.encoding) {
    for (const Element& element : header.elements)
      if (element.name == "vertex") vertexCount_ += element.count;
    if (vertexCount_ == 0) throw LoadError("the PLY file has no vertices");
    if (vertexCount_ > mostVertices) throw LoadError(fmt::format("{} vertices are too many", vertexCount_));
  }

  Mesh read() {
    for (const Element& element : header_.elements) {
      std::size_t least = 0;
      for (const Property& property : element.properties)
        least += sizeOf(property.isList ? property.countType : property.type);
      body_.require(element.count, std::max<std::size_t>(least, 1), "elements named " + element.name);
      if (element.name == "vertex")
        readVertices(element);
      else
        readLists(element);
    }
    std::size_t begin = 0;
    for (const std::uint32_t size : polygonSizes_) {
      addPolygon(std::span(corners_).subspan(begin, size), mesh_.positions, mesh_.indices);
      begin += size;
    }
    return std::move(mesh_);
  }

  std::vector<glm::vec3> normals() { return std::move(normals_); }
  bool hasNormals() const { return has(Slot::NormalX) && has(Slot::NormalY) && has(Slot::NormalZ); }
  bool hasColors() const { return has(Slot::Red) && has(Slot::Green) && has(Slot::Blue); }
  bool hasTexCoords() const { return has(Slot::U) && has(Slot::V); }

 private:
  static constexpr std::uint64_t mostVertices = 0xfffffffe;

  bool has(Slot slot) const { return present_[static_cast<std::size_t>(slot)]; }

  // Reads one property and gives each of its values, of a list or alone, to `take`.
  template <typename Take, typename Where>
  void readValues(const Property& property, Take take, Where where) {
    if (!property.isList) {
      take(body_.next(property.type, where));
      return;
    }
    const double length = body_.next(property.countType, where);
    if (!(length >= 0.0 && length <= 4294967295.0) || length != std::floor(length))
      throw LoadError(fmt::format("{}: a list has the length {}", where(), length));
    const auto count = static_cast<std::uint64_t>(length);
    body_.require(count, sizeOf(property.type), "list values");
    for (std::uint64_t i = 0; i < count; ++i) take(body_.next(property.type, where));
  }

  void readVertices(const Element& element) {
    std::vector<Slot> slots;
    for (const Property& property : element.properties) {
      slots.push_back(property.isList ? Slot::None : slotOf(property.name));
      present_[static_cast<std::size_t>(slots.back())] = true;
    }
    if (!has(Slot::X) || !has(Slot::Y) || !has(Slot::Z)) throw LoadError("the PLY vertices have no x, y and z");
    mesh_.positions.reserve(static_cast<std::size_t>(element.count));
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const auto where = [i] { return fmt::format("vertex {}", i); };
      std::array<double, slotCount> values{};
      values[static_cast<std::size_t>(Slot::Alpha)] = 1.0;
      for (std::size_t p = 0; p < slots.size(); ++p) {
        const Property& property = element.properties[p];
        const bool color = slots[p] >= Slot::Red && slots[p] <= Slot::Alpha;
        const double scale = color ? colorScale(property.type) : 1.0;
        readValues(
            property, [&](double value) { values[static_cast<std::size_t>(slots[p])] = value * scale; }, where);
      }
      addVertex(values, where);
    }
  }

  template <typename Where>
  void addVertex(const std::array<double, slotCount>& values, Where where) {
    const auto value = [&values](Slot slot) { return narrowed(values[static_cast<std::size_t>(slot)]); };
    Vertex vertex;
    vertex.position = {value(Slot::X), value(Slot::Y), value(Slot::Z)};
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(vertex.position[c])) throw LoadError(fmt::format("{}: its position is not finite", where()));
    if (hasNormals()) vertex.normal = {value(Slot::NormalX), value(Slot::NormalY), value(Slot::NormalZ)};
    if (hasColors()) vertex.color = {linearFromSrgb({value(Slot::Red), value(Slot::Green), value(Slot::Blue)}), 1.0F};
    // Written so that what is not a number leaves the vertex opaque.
    const float alpha = value(Slot::Alpha);
    if (alpha < 1.0F) vertex.color.a = std::max(alpha, 0.0F);
    // v grows upwards in these files and downwards in glTF.
    const glm::vec2 uv(value(Slot::U), 1.0F - value(Slot::V));
    if (std::isfinite(uv.x) && std::isfinite(uv.y)) vertex.texCoord0 = uv;
    normals_.push_back(vertex.normal);
    vertex.normal = Vertex{}.normal;
    mesh_.add(vertex);
  }

  // Faces, triangle strips, and elements that are of no interest.
  void readLists(const Element& element) {
    const bool face = element.name == "face";
    const bool strips = element.name == "tristrips";
    std::vector<double> list;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const auto where = [&element, i] { return fmt::format("{} {}", oneLine(element.name), i); };
      for (const Property& property : element.properties) {
        const bool indices = property.isList && (property.name == "vertex_indices" || property.name == "vertex_index");
        list.clear();
        readValues(
            property,
            [&](double value) {
              if (indices) list.push_back(value);
            },
            where);
        if (indices && face) addFace(list, where);
        if (indices && strips) addStrips(list, where);
      }
    }
  }

  template <typename Where>
  std::uint32_t vertexIndex(double value, Where where) const {
    if (!(value >= 0.0 && value < static_cast<double>(vertexCount_)) || value != std::floor(value))
      throw LoadError(fmt::format("{}: names vertex {}, but there are {}", where(), value, vertexCount_));
    return static_cast<std::uint32_t>(value);
  }

  template <typename Where>
  void addFace(std::span<const double> list, Where where) {
    for (const double value : list) corners_.push_back(vertexIndex(value, where));
    polygonSizes_.push_back(static_cast<std::uint32_t>(list.size()));
  }

  // -1 ends a strip and begins the next one.
  template <typename Where>
  void addStrips(std::span<const double> list, Where where) {
    std::vector<std::uint32_t> strip;
    const auto finish = [&] {
      const std::vector<std::uint32_t> triangles = triangleList(strip, Topology::Strip);
      mesh_.indices.insert(mesh_.indices.end(), triangles.begin(), triangles.end());
      strip.clear();
    };
    for (const double value : list) {
      if (value == -1.0)
        finish();
      else
        strip.push_back(vertexIndex(value, where));
    }
    finish();
  }

  const Header& header_;
  PlyBody body_;
  std::uint64_t vertexCount_ = 0;
  std::array<bool, slotCount> present_{};
  Mesh mesh_;
  std::vector<glm::vec3> normals_;     // of the vertices
  std::vector<std::uint32_t> corners_; // of all polygons, one after the other
  std::vector<std::uint32_t> polygonSizes_;
};

} // namespace

Scene loadPly(std::span<const std::byte> file, const std::filesystem::path& base) {
  const Header header = parseHeader({reinterpret_cast<const char*>(file.data()), file.size()});
  PlyReader reader(header, file.subspan(header.bodyOffset));
  Mesh mesh = reader.read();
  Scene scene;
  TextureSlot texture;
  if (!header.texture.empty() && reader.hasTexCoords()) texture = TextureFiles(base).read(scene, header.texture);
  Material material = plainMaterial(reader.hasColors() || texture.image >= 0);
  material.baseColorTexture = texture;
  addPlainMesh(scene, std::move(mesh), reader.hasNormals() ? NormalsFrom::File : NormalsFrom::SharedCorners,
               std::move(material), reader.normals());
  requireDrawable(scene);
  return scene;
}

} // namespace vitrail::tool
