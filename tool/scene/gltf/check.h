// Checks the JSON of a glTF file against the types, lengths and index ranges of the glTF 2.0 specification, before
// anything else looks at it. tinygltf skips values of a wrong type and does not compare indices with array sizes; after
// this check neither can happen.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "../load.h"
#include "node_list.h"

namespace vitrail::tool {

// Checks one element of "nodes", all but that its indices are in range: that only the whole document tells. Throws
// LoadError.
void checkGltfNode(const nlohmann::json& node, std::size_t index);

// Puts plain cameras in the place of those that are not as the specification says, and tells what is wrong with each:
// the rest of a model can be drawn without them.
std::map<std::size_t, std::string> repairGltfCameras(nlohmann::json& document);

// Checks the rest of a document, whose "nodes" are empty since they have been taken out of it: `nodes` are those that
// passed, `nodeError` is what the first one that did not was refused with. Throws LoadError that names the object, as
// in "node 4: mesh is 7, but meshes has 2 elements". Afterwards every property that the loader uses has its specified
// type, every number fits a 32-bit float, every index is in range but those of KHR_materials_variants, and no extension
// is required without which the data cannot be read.
void checkGltfJson(const nlohmann::json& document, const GltfNodes& nodes, const std::optional<LoadError>& nodeError);

} // namespace vitrail::tool
