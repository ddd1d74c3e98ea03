// Reads what a URI in a glTF file stands for: a data URI's payload, or a file beside the model.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "../read_file.h"

namespace vitrail::tool {

// `base` is the model's folder; when it is empty only data URIs are read. Percent-encoding is decoded. Throws LoadError
// with a reason that reads on after "buffer 0: ".
std::vector<std::byte> readUri(std::string_view uri, const std::filesystem::path& base);

// The same, with the file mapped.
MappedFile mapUri(std::string_view uri, const std::filesystem::path& base);

} // namespace vitrail::tool
