// The material libraries that an OBJ file names.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string_view>
#include <vector>

#include "../scene.h"
#include "mtl.h"
#include "obj_material.h"

namespace vitrail::tool {

// The libraries of a file. A name is looked up in those that have been named so far, from the last mtllib statement
// back, and then in those that follow: files are joined out of others whose materials have the same names.
class ObjLibraries {
 public:
  struct Found {
    const MtlMaterial* material = nullptr;
    const LoadedLibrary* library = nullptr;
  };

  ObjLibraries(Scene& scene, const std::filesystem::path& base) : scene_(scene), base_(base) {}

  // What stands behind mtllib: a name that may hold spaces, or several.
  void add(std::string_view names);

  std::size_t groupCount() const { return groups_.size(); }
  bool anyMissing() const { return anyMissing_; }

  // `groupsSoFar`: the mtllib statements before the usemtl.
  Found find(std::string_view name, std::size_t groupsSoFar) const;

 private:
  using Group = std::vector<const LoadedLibrary*>;

  static Found findIn(const Group& group, std::string_view name);

  // Null where there is no such file.
  const LoadedLibrary* find(std::string_view name);

  // Of several names, one that ends in ".mtl" ends there. Its length.
  std::size_t reportMissing(std::string_view names);

  void missing(std::string_view name, std::string_view reason);

  Scene& scene_;
  std::filesystem::path base_;
  std::map<std::filesystem::path, std::unique_ptr<LoadedLibrary>> libraries_;
  std::vector<Group> groups_;
  bool anyMissing_ = false;
};

} // namespace vitrail::tool
