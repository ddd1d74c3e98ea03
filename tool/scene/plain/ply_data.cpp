// Reads what a PLY file holds.
#include "ply_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "../load.h"
#include "../message.h"
#include "../scene.h"
#include "ply_body.h"
#include "ply_colors.h"

namespace vitrail::tool {
namespace {

// A splat's colour where its spherical harmonics are left at the first, and its opacity, as Kerbl et al., "3D Gaussian
// splatting for real-time radiance field rendering" (2023) store them.
std::uint64_t splatColor(const PlyRow& row) {
  constexpr double constantHarmonic = 0.28209479177387814;
  glm::vec4 color(1.0F);
  color.r = narrowed(0.5 + constantHarmonic * row[PlySlot::SplatRed]);
  color.g = narrowed(0.5 + constantHarmonic * row[PlySlot::SplatGreen]);
  color.b = narrowed(0.5 + constantHarmonic * row[PlySlot::SplatBlue]);
  color.a = narrowed(1.0 / (1.0 + std::exp(-row[PlySlot::SplatOpacity])));
  return packedFromSrgb(color);
}

class PlyReader {
 public:
  PlyReader(const PlyHeader& header, std::span<const std::byte> body, const glm::dvec3& origin)
      : header_(header), body_(body, header), origin_(origin) {
    for (const PlyElement& element : header.elements) {
      if (element.name != "vertex") continue;
      if (vertexCount_ != 0) throw LoadError("the PLY header states two elements named vertex");
      vertexCount_ = element.count;
    }
    if (vertexCount_ == 0) throw LoadError("the PLY file has no vertices");
    if (vertexCount_ > mostVertices) throw LoadError(fmt::format("{} vertices are too many", vertexCount_));
  }

  PlyData read() {
    for (const PlyElement& element : header_.elements) {
      const PlyLayout layout(element);
      if (element.name == "vertex")
        readVertices(element, layout);
      else if (isFaces(element) && layout.has(PlyList::Corners))
        readFaces(element, layout);
      else if (element.name == "tristrips")
        body_.readRows(element, layout,
                       [&](const PlyRow& row, std::uint64_t i) { addStrips(row[PlyList::Corners], element, i); });
      else if (element.name == "multi_texture_vertex")
        body_.readRows(element, layout, [&](const PlyRow& row, std::uint64_t) {
          texPlaces_.emplace_back(narrowed(row[PlySlot::U]), 1.0F - narrowed(row[PlySlot::V]));
        });
      else if (element.name == "multi_texture_face")
        readTexFaces(element, layout);
      else if (element.name == "edge")
        readEdges(element, layout);
      else
        skip(element, layout);
      if (!body_.end().empty()) break;
    }
    if (!body_.end().empty()) keepWhole();
    if (body_.longLines() > 0)
      data_.warnings.push_back(
          fmt::format("passed over: what {} lines hold behind the values that the header states", body_.longLines()));
    if (!texFaces_.empty()) spreadTexFaces();
    if (!data_.faceColors.empty()) data_.faceColors.resize(data_.faceCount, white);
    if (!data_.faceTextures.empty()) data_.faceTextures.resize(data_.faceCount, 0);
    if (!data_.cornerTexCoords.empty()) data_.cornerTexCoords.resize(data_.corners.size());
    if (!data_.cornerColors.empty()) data_.cornerColors.resize(data_.corners.size(), white);
    if (!data_.edgeColors.empty()) data_.edgeColors.resize(data_.edges.size() / 2, white);
    return std::move(data_);
  }

 private:
  static constexpr std::uint64_t mostVertices = 0xfffffffe;
  const std::uint64_t white = packColor(glm::vec4(1.0F));

  // Scanners' range grids say where vertices were measured, not what is between them.
  void skip(const PlyElement& element, const PlyLayout& layout) {
    if (layout.hasLists() && element.count > 0 && element.name != "range_grid")
      data_.warnings.push_back(fmt::format("left out: {} elements named {}, since {}", element.count,
                                           oneLine(element.name),
                                           isFaces(element) ? "none of their lists is known to hold their vertices"
                                                            : "it is not known what their lists are"));
    body_.readRows(element, layout, [](const PlyRow&, std::uint64_t) {});
  }

  // Of a file that is cut off: what is there. Vertices alone show nothing of a model of faces or edges.
  void keepWhole() {
    const bool anything = !data_.corners.empty() || !data_.edges.empty();
    const bool pointsAlone = std::ranges::none_of(header_.elements, [](const PlyElement& element) {
      return element.count > 0 && (isFaces(element) || element.name == "tristrips" || element.name == "edge");
    });
    const bool drawable = anything ? data_.positions.size() == vertexCount_ : pointsAlone && !data_.positions.empty();
    if (!drawable) throw LoadError(body_.end());
    // Bytes that were lost or changed on the way, as line ends are, leave numbers that are none.
    constexpr double farthest = 1e15;
    const glm::dvec3 far = glm::max(glm::abs(data_.bounds.min), glm::abs(data_.bounds.max));
    if (std::max({far.x, far.y, far.z}) > farthest)
      throw LoadError(body_.end() + ", and what is there before reaches farther than 1e+15: it is damaged");
    data_.warnings.push_back(body_.end() + ": what is there before is drawn");
  }

  void readVertices(const PlyElement& element, const PlyLayout& layout) {
    using enum PlySlot;
    if (!layout.has(X) || !layout.has(Y) || !layout.has(Z)) refusePlaces(element);
    const bool normals = layout.has(NormalX) && layout.has(NormalY) && layout.has(NormalZ);
    PlyColors colors(layout, data_.colors);
    data_.splats = !colors.hasHue() && layout.has(SplatRed) && layout.has(SplatGreen) && layout.has(SplatBlue) &&
                   layout.has(SplatOpacity);
    const bool texCoords = layout.has(U) && layout.has(V);
    const bool gathered = colors.any() && !data_.splats;
    data_.onlyAlpha = gathered && !colors.hasHue();
    const std::uint64_t count = body_.roomFor(element.count, layout.leastBytes());
    data_.positions.reserve(count);
    if (normals) data_.normals.reserve(count);
    if (gathered || data_.splats) data_.colors.reserve(count);
    if (texCoords) data_.texCoords.reserve(count);
    body_.readRows(element, layout, [&](const PlyRow& row, std::uint64_t) {
      addPosition({row[X], row[Y], row[Z]});
      if (normals) data_.normals.emplace_back(narrowed(row[NormalX]), narrowed(row[NormalY]), narrowed(row[NormalZ]));
      if (gathered) colors.add(row);
      if (data_.splats) data_.colors.push_back(splatColor(row));
      // v grows upwards in these files and downwards in glTF.
      if (texCoords) data_.texCoords.emplace_back(narrowed(row[U]), 1.0F - narrowed(row[V]));
    });
    colors.finish();
  }

  [[noreturn]] static void refusePlaces(const PlyElement& element) {
    if (std::ranges::find(element.properties, "packed_position", &PlyProperty::name) != element.properties.end())
      throw LoadError("its vertices are compressed Gaussian splats (packed_position), which cannot be read");
    throw LoadError("the PLY vertices have no x, y and z");
  }

  void addPosition(const glm::dvec3& place) {
    const glm::dvec3 moved = place - origin_;
    glm::vec3 position(narrowed(moved.x), narrowed(moved.y), narrowed(moved.z));
    if (std::isfinite(position.x + position.y + position.z) ||
        (std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z))) {
      data_.bounds.add(place);
    } else {
      position.x = std::numeric_limits<float>::quiet_NaN();
      ++data_.notFinite;
    }
    data_.positions.push_back(position);
  }

  void readFaces(const PlyElement& element, const PlyLayout& layout) {
    PlyColors colors(layout, data_.faceColors);
    // Files may hold several elements of faces, not all of them with the same properties.
    const std::size_t before = data_.faceCount;
    if (colors.any()) data_.faceColors.resize(before, white);
    if (layout.has(PlySlot::TexNumber)) data_.faceTextures.resize(before, 0);
    if (layout.has(PlyList::TexCoords)) data_.cornerTexCoords.resize(data_.corners.size());
    if (layout.has(PlyList::Colors)) data_.cornerColors.resize(data_.corners.size(), white);
    if (layout.has(PlyList::Corners))
      data_.corners.reserve(data_.corners.size() + 3 * body_.roomFor(element.count, layout.leastBytes()));
    body_.readRows(element, layout, [&](const PlyRow& row, std::uint64_t i) {
      const std::vector<double>& corners = row[PlyList::Corners];
      if (data_.corners.size() + corners.size() > mostVertices) throw LoadError("the faces have too many corners");
      for (const double corner : corners) data_.corners.push_back(vertexNumber(corner, element, i));
      addFace(corners.size());
      if (colors.any()) colors.add(row);
      if (layout.has(PlySlot::TexNumber)) data_.faceTextures.push_back(textureNumber(row));
      if (layout.has(PlyList::TexCoords)) addTexCoords(row[PlyList::TexCoords], corners.size());
      if (layout.has(PlyList::Colors)) addCornerColors(row[PlyList::Colors], corners.size());
    });
    colors.finish();
  }

  void addFace(std::size_t size) {
    if (size != 3 && data_.sizes.empty()) data_.sizes.assign(data_.faceCount, 3);
    ++data_.faceCount;
    if (size != 3 || !data_.sizes.empty()) data_.sizes.push_back(static_cast<std::uint32_t>(size));
  }

  void addTexCoords(std::span<const double> list, std::size_t corners) {
    const bool fits = list.size() == 2 * corners;
    if (!fits && !list.empty()) ++data_.oddTexCoords;
    for (std::size_t i = 0; i < corners; ++i)
      data_.cornerTexCoords.push_back(fits ? glm::vec2(narrowed(list[2 * i]), 1.0F - narrowed(list[2 * i + 1]))
                                           : glm::vec2(0.0F));
  }

  // MeshLab writes three floats a corner.
  void addCornerColors(std::span<const double> list, std::size_t corners) {
    const std::size_t channels = corners == 0 ? 0 : list.size() / corners;
    const bool fits = (channels == 3 || channels == 4) && list.size() == channels * corners;
    for (std::size_t i = 0; i < corners; ++i) {
      glm::vec4 color(1.0F);
      for (std::size_t c = 0; fits && c < channels; ++c) color[static_cast<int>(c)] = narrowed(list[channels * i + c]);
      data_.cornerColors.push_back(packedFromSrgb(color));
    }
  }

  // Artec's way of texture coordinates: a list of places in textures, and for each face a texture and its corners among
  // them.
  void readTexFaces(const PlyElement& element, const PlyLayout& layout) {
    body_.readRows(element, layout, [&](const PlyRow& row, std::uint64_t i) {
      const std::vector<double>& corners = row[PlyList::TexCorners];
      texFaces_.push_back(static_cast<std::uint32_t>(corners.size()));
      texNumbers_.push_back(textureNumber(row));
      for (const double corner : corners) {
        if (!(corner >= 0.0 && corner < static_cast<double>(texPlaces_.size())))
          throw LoadError(fmt::format("{} {}: names texture vertex {}, but there are {}", oneLine(element.name), i,
                                      corner, texPlaces_.size()));
        texCorners_.push_back(texPlaces_[static_cast<std::size_t>(corner)]);
      }
    });
  }

  void spreadTexFaces() {
    if (!data_.sizes.empty() ? data_.sizes != texFaces_ : texFaces_ != std::vector<std::uint32_t>(data_.faceCount, 3)) {
      data_.oddTexCoords += texFaces_.size();
      return;
    }
    data_.cornerTexCoords = std::move(texCorners_);
    data_.faceTextures = std::move(texNumbers_);
  }

  static std::int32_t textureNumber(const PlyRow& row) {
    const double number = row[PlySlot::TexNumber];
    return std::abs(number) < 1e9 ? static_cast<std::int32_t>(number) : -1;
  }

  // -1 ends a strip and begins the next one.
  void addStrips(std::span<const double> list, const PlyElement& element, std::uint64_t number) {
    std::array<std::uint32_t, 2> before{};
    std::size_t place = 0;
    for (const double value : list) {
      if (value == -1.0) {
        place = 0;
        continue;
      }
      const std::uint32_t vertex = vertexNumber(value, element, number);
      if (place >= 2) {
        const bool odd = place % 2 != 0;
        data_.corners.insert(data_.corners.end(), {before[odd ? 1 : 0], before[odd ? 0 : 1], vertex});
        addFace(3);
      }
      before = {before[1], vertex};
      ++place;
    }
  }

  void readEdges(const PlyElement& element, const PlyLayout& layout) {
    if (!layout.has(PlySlot::Vertex1) || !layout.has(PlySlot::Vertex2)) {
      body_.readRows(element, layout, [](const PlyRow&, std::uint64_t) {});
      return;
    }
    PlyColors colors(layout, data_.edgeColors);
    if (colors.any()) data_.edgeColors.resize(data_.edges.size() / 2, white);
    body_.readRows(element, layout, [&](const PlyRow& row, std::uint64_t i) {
      data_.edges.push_back(vertexNumber(row[PlySlot::Vertex1], element, i));
      data_.edges.push_back(vertexNumber(row[PlySlot::Vertex2], element, i));
      if (colors.any()) colors.add(row);
    });
    colors.finish();
  }

  std::uint32_t vertexNumber(double value, const PlyElement& element, std::uint64_t number) const {
    if (!(value >= 0.0 && value < static_cast<double>(vertexCount_)) || value != std::floor(value))
      throw LoadError(
          fmt::format("{} {}: names vertex {}, but there are {}", oneLine(element.name), number, value, vertexCount_));
    return static_cast<std::uint32_t>(value);
  }

  const PlyHeader& header_;
  PlyBody body_;
  glm::dvec3 origin_;
  std::uint64_t vertexCount_ = 0;
  PlyData data_;
  std::vector<glm::vec2> texPlaces_;    // of the elements named multi_texture_vertex
  std::vector<std::uint32_t> texFaces_; // those named multi_texture_face: how many corners each has
  std::vector<std::int32_t> texNumbers_;
  std::vector<glm::vec2> texCorners_;
};

} // namespace

PlyData readPlyBody(const PlyHeader& header, std::span<const std::byte> body, const glm::dvec3& origin) {
  return PlyReader(header, body, origin).read();
}

} // namespace vitrail::tool
