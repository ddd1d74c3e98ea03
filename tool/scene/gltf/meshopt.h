// EXT_meshopt_compression, and KHR_meshopt_compression where it holds the same streams: buffer views whose bytes are
// compressed. https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_meshopt_compression
#pragma once

#include "document.h"

namespace vitrail::tool {

// Decodes every compressed buffer view of the document into GltfDocument::decodedViews. Throws LoadError.
void decodeMeshopt(GltfDocument& document);

} // namespace vitrail::tool
