// The material libraries that an OBJ file names.
#include "obj_libraries.h"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "../load.h"
#include "../message.h"
#include "../read_file.h"
#include "find_file.h"
#include "text_encoding.h"

namespace vitrail::tool {

void ObjLibraries::add(std::string_view names) {
  auto& group = groups_.emplace_back();
  if (const LoadedLibrary* whole = find(names)) {
    group.push_back(whole);
    return;
  }
  names = beforeComment(names);
  while (!names.empty()) {
    std::size_t length = names.size();
    const LoadedLibrary* library = find(names);
    while (library == nullptr && length > 0) {
      length = names.find_last_of(" \t", length - 1);
      if (length == std::string_view::npos) break;
      library = find(names.substr(0, length));
    }
    if (library != nullptr)
      group.push_back(library);
    else
      length = reportMissing(names);
    names.remove_prefix(std::min(names.find_first_not_of(" \t", length), names.size()));
  }
}

ObjLibraries::Found ObjLibraries::find(std::string_view name, std::size_t groupsSoFar) const {
  for (std::size_t i = groupsSoFar; i-- > 0;)
    if (const Found found = findIn(groups_[i], name); found.material != nullptr) return found;
  for (std::size_t i = groupsSoFar; i < groups_.size(); ++i)
    if (const Found found = findIn(groups_[i], name); found.material != nullptr) return found;
  return {};
}

ObjLibraries::Found ObjLibraries::findIn(const Group& group, std::string_view name) {
  for (const LoadedLibrary* library : group)
    if (const MtlMaterial* material = library->library.find(name)) return {material, library};
  return {};
}

const LoadedLibrary* ObjLibraries::find(std::string_view name) {
  if (base_.empty()) return nullptr;
  const std::optional<std::filesystem::path> path = findFile(name, std::span(&base_, 1));
  if (!path) return nullptr;
  std::unique_ptr<LoadedLibrary>& library = libraries_[path->lexically_normal()];
  if (library) return library.get();
  library = std::make_unique<LoadedLibrary>();
  library->folder = path->parent_path();
  try {
    const std::vector<std::byte> file = readFile(*path);
    library->library = readMtl(PlainText(file).view());
  } catch (const LoadError& error) {
    missing(name, error.what());
  }
  for (std::string& line : library->library.warnings) warn(scene_, std::move(line));
  return library.get();
}

std::size_t ObjLibraries::reportMissing(std::string_view names) {
  std::size_t length = names.size();
  for (std::size_t i = 0; i + 5 <= names.size(); ++i) {
    const bool ends = names[i] == '.' && (names[i + 1] | 32) == 'm' && (names[i + 2] | 32) == 't' &&
                      (names[i + 3] | 32) == 'l' && (names[i + 4] == ' ' || names[i + 4] == '\t');
    if (!ends) continue;
    length = i + 4;
    break;
  }
  missing(names.substr(0, length), base_.empty() ? "external files are not read here" : "no such file");
  return length;
}

void ObjLibraries::missing(std::string_view name, std::string_view reason) {
  anyMissing_ = true;
  warn(scene_, fmt::format("material library {}: {}; its materials are drawn plain", oneLine(name), reason));
}

} // namespace vitrail::tool
