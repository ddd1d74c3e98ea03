// What tells the geometry of two primitives apart: those with equal keys make the same mesh, whichever meshes and nodes
// of the file they are in.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "material.h"
#include "tinygltf.h"

namespace vitrail::tool {

// `weights` are those of the morph targets, `skin` is that of the node where the primitive follows it.
std::string geometryKey(const tinygltf::Primitive& primitive, const GltfMaterial& material,
                        std::span<const double> weights, std::optional<std::uint32_t> skin);

} // namespace vitrail::tool
