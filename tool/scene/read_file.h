// Reads whole files from disk, and refuses what is not a file of a sensible size.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace vitrail::tool {

// The bytes of a regular file. Throws LoadError without a file name in front: "no such file", "is a directory", "is
// empty", "is not a regular file", or why it cannot be read.
std::vector<std::byte> readFile(const std::filesystem::path& path);

// The bytes of a file that a model names, relative to the model's folder `base`. Throws LoadError that begins with the
// name, also where `base` is empty (no file is read then) or the name is an absolute path.
std::vector<std::byte> readFileBeside(std::string_view name, const std::filesystem::path& base);

} // namespace vitrail::tool
