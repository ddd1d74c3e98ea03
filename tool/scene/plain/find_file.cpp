// Finds the files that models name.
#include "find_file.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "letters.h"

namespace vitrail::tool {
namespace {

namespace fs = std::filesystem;

// The entry of a folder in that letter case or, without it, in any; of several the first in the order of bytes.
std::optional<fs::path> findEntry(const fs::path& folder, const std::string& name) {
  std::error_code error;
  if (name == ".." || fs::exists(folder / name, error)) return folder / name;
  const std::string wanted = lowerCase(name);
  std::optional<fs::path> found;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (lowerCase(entry->path().filename().string()) != wanted) continue;
    if (!found || entry->path() < *found) found = entry->path();
  }
  return found;
}

std::optional<fs::path> findBelow(fs::path folder, std::span<const std::string> parts) {
  for (const std::string& part : parts) {
    const std::optional<fs::path> entry = findEntry(folder, part);
    if (!entry) return std::nullopt;
    folder = *entry;
  }
  std::error_code error;
  if (!fs::is_regular_file(folder, error)) return std::nullopt;
  return folder;
}

std::vector<std::string> splitPath(std::string_view name) {
  std::vector<std::string> parts;
  while (!name.empty()) {
    const std::size_t end = std::min(name.find_first_of("/\\"), name.size());
    const std::string_view part = name.substr(0, end);
    if (!part.empty() && part != ".") parts.emplace_back(part);
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return parts;
}

} // namespace

std::optional<fs::path> findFile(std::string_view name, std::span<const fs::path> folders) {
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  if (name.empty() || name.find('\0') != std::string_view::npos || name.size() > 4096) return std::nullopt;
  const bool absolute = name[0] == '/' || name[0] == '\\' || (name.size() > 1 && name[1] == ':');
  std::error_code error;
  for (const fs::path& folder : folders)
    if (!absolute && fs::is_regular_file(folder / fs::path(name), error)) return folder / fs::path(name);
  const std::vector<std::string> parts = splitPath(name);
  constexpr std::size_t mostParts = 64;
  if (parts.size() > mostParts) return std::nullopt;
  for (std::size_t first = absolute ? 1 : 0; first < std::max<std::size_t>(parts.size(), 1); ++first)
    for (const fs::path& folder : folders)
      if (const auto found = findBelow(folder, std::span(parts).subspan(std::min(first, parts.size())))) return found;
  // "/wood.png" and "C:wood.png" have no part before the last.
  if (parts.size() != 1 || !absolute) return std::nullopt;
  const std::string last = parts[0].size() > 1 && parts[0][1] == ':' ? parts[0].substr(2) : parts[0];
  for (const fs::path& folder : folders)
    if (const auto found = findBelow(folder, std::span(&last, 1))) return found;
  return std::nullopt;
}

} // namespace vitrail::tool
