// Several models as one scene.
#pragma once

#include <string>
#include <vector>

#include "scene.h"

namespace vitrail::tool {

// All that is in the scenes, each where its own file puts it: their coordinates are those of one space, whatever their
// origins. Warnings begin with the scene's name of `names`, which has one for each. At least one scene; one alone is
// returned as it is. What the first of them that asks for a background asks for is kept.
Scene mergeScenes(std::vector<Scene> scenes, const std::vector<std::string>& names);

} // namespace vitrail::tool
