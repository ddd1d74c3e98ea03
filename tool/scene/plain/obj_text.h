// What the text of an OBJ file states, before anything is made of it. Large texts are read in parts by several threads.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace vitrail::tool {

// Indices from 0 into the attributes of ObjText; -1: none.
struct ObjCorner {
  std::int32_t position = -1;
  std::int32_t texCoord = -1;
  std::int32_t normal = -1;
};

enum ObjKind : std::size_t { objFaces, objLines, objPoints, objKindCount };

// The faces, lines or points of a part: their corners one after the other, and how many each has.
struct ObjElements {
  std::vector<ObjCorner> corners;
  std::vector<std::uint32_t> sizes;
};

// A statement that concerns the elements after it.
struct ObjStatement {
  enum class Kind { Library, Material, Smoothing };
  Kind kind = Kind::Library;
  std::string_view text;                          // what follows the word
  std::array<std::size_t, objKindCount> before{}; // how many elements of its part precede it, by kind
};

// A part of the text: whole lines.
struct ObjPart {
  std::array<ObjElements, objKindCount> elements;
  std::vector<ObjStatement> statements;
  std::deque<std::string> joined; // the lines that go on after a backslash, for the statements' texts
};

struct ObjText {
  std::vector<glm::dvec3> positions; // of NaN where one is not finite
  std::size_t notFinite = 0;         // how many are not
  std::vector<glm::vec4> colors;     // linear; as many as positions, or none at all
  std::vector<glm::vec2> texCoords;  // v grows downwards, as in glTF
  std::vector<glm::vec3> normals;    // zero where the file has what is none
  std::vector<ObjPart> parts;        // in the text's order; their corners name what there is
  std::string generator;             // the first comment
  std::vector<std::string> warnings;

  bool isFinite(const ObjCorner& corner) const {
    return notFinite == 0 || !std::isnan(positions[static_cast<std::size_t>(corner.position)].x);
  }
  bool isFinite(std::span<const ObjCorner> corners) const {
    return notFinite == 0 || std::ranges::all_of(corners, [this](const ObjCorner& corner) { return isFinite(corner); });
  }
};

// Reads a text that outlives the result. Throws LoadError with the number of the line that makes no sense. Texture
// coordinates and normals that corners name without their being there are left out, with a warning.
ObjText readObjText(std::string_view text);

} // namespace vitrail::tool
