// The animations of a glTF file: which there are, and the pose of its nodes at a time.
#pragma once

#include "../load.h"
#include "document.h"

namespace vitrail::tool {

// The length of each animation, to the last of its times; 0 where they cannot be read.
std::vector<FileFacts::Animation> listAnimations(const GltfDocument& document);

// Moves the document's nodes, and sets the weights of their morph targets, to where the chosen animation has them at
// the chosen time. A time before its beginning or after its end is that of the end. Without either option nothing
// moves. Warns of what it moves that cannot be moved. Throws LoadError, also where there is no such animation.
void poseAt(GltfDocument& document, const LoadOptions& options, Scene& scene);

} // namespace vitrail::tool
