// The extensions of glTF's materials: KHR_materials_... but unlit.
#pragma once

#include <functional>
#include <string>

#include "../scene.h"
#include "tinygltf.h"

namespace vitrail::tool {

// Fills in what the extensions of `source` say, and warns of what of them is not drawn. `texture` reads a texture slot
// from an extension's JSON.
void readMaterialExtensions(const tinygltf::Material& source,
                            const std::function<TextureSlot(const tinygltf::Value&)>& texture, Material& material,
                            Scene& scene);

} // namespace vitrail::tool
