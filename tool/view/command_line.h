// The command that draws a picture again.
#pragma once

#include <string>

#include "../commands/render_options.h"

namespace vitrail::tool {

// `vitrail render ... -o FILE` with all that the arguments say, for a shell. A picture drawn with them on that device
// is the same, bit for bit.
std::string renderCommand(const RenderArguments& arguments, const std::string& output);

} // namespace vitrail::tool
