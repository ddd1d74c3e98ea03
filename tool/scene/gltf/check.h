// Checks the JSON of a glTF file against the types, lengths and index ranges of the glTF 2.0 specification, before
// anything else looks at it. tinygltf skips values of a wrong type and does not compare indices with array sizes; after
// this check neither can happen.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace vitrail::tool {

// Throws LoadError that names the object, as in "node 4: mesh is 7, but meshes has 2 elements". Afterwards every
// property that the loader uses has its specified type, every number fits a 32-bit float, every index is in range, and
// every required extension is implemented.
void checkGltfJson(const nlohmann::json& document);

} // namespace vitrail::tool
