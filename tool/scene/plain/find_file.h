// Finds the files that models name, as far as their names still tell after a change of machine.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace vitrail::tool {

// The file that a model names, looked for in each of the folders in turn: under the very name; in another letter case,
// with / and \ alike; and, for a path from somewhere else ("C:\work\maps\wood.png"), by as many of its last parts as
// are found ("maps/wood.png", then "wood.png"). A path from the root of a disk is never opened as it stands. The file
// may still turn out not to be readable.
std::optional<std::filesystem::path> findFile(std::string_view name, std::span<const std::filesystem::path> folders);

} // namespace vitrail::tool
