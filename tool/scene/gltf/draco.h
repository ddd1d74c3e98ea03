// KHR_draco_mesh_compression: primitives whose indices and attributes are one compressed mesh.
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_draco_mesh_compression
#pragma once

#include "document.h"

namespace vitrail::tool {

// Decodes every compressed primitive of the document: its accessors then read from buffer views that are added for
// them. Where the compressed data are damaged, and the accessors have data of their own, those are left as they are,
// with a warning. Throws LoadError.
void decodeDraco(GltfDocument& document);

} // namespace vitrail::tool
