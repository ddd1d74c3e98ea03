// What a model's file holds and what of it is drawn: for people, and as JSON for programs.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "../scene/scene.h"

namespace vitrail::tool {

// A file that was loaded.
struct ModelInfo {
  std::string file;        // its name, as the user wrote it
  std::uint64_t bytes = 0; // its size
  Scene scene;             // as the file has it, not turned
};

// Lines of text, one block.
std::string toText(const ModelInfo& model);

// One JSON document of all.
std::string toJson(std::span<const ModelInfo> models);

} // namespace vitrail::tool
