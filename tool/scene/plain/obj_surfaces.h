// Sorts the elements of an OBJ file by their materials.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "obj_libraries.h"
#include "obj_text.h"

namespace vitrail::tool {

// Smoothing groups of files without normals: "s off", "s 1" and so on.
struct ObjSmoothing {
  static constexpr std::int64_t unstated = -1;
  static constexpr std::int64_t off = 0;
};

// Elements of one part of the text that follow each other.
struct ObjRun {
  std::size_t part;
  std::size_t first;
  std::size_t count;
  std::size_t firstCorner;
};

// What has one material.
struct ObjSurface {
  std::string name;
  ObjLibraries::Found found;
  std::map<std::int64_t, std::vector<ObjRun>> faces; // by smoothing group
  std::vector<ObjRun> lines;
  std::vector<ObjRun> points;
};

// The surfaces of a text, as they come in it. Adds its libraries to `libraries`.
std::vector<ObjSurface> surfacesOf(const ObjText& text, ObjLibraries& libraries);

} // namespace vitrail::tool
