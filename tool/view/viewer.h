// The window of `vitrail view`.
#pragma once

#include "view_options.h"

namespace vitrail::tool {

// Opens the window and returns when the user has closed it. Throws WindowError, GpuError, and what loading the first
// scene throws.
void runViewer(const ViewArguments& arguments);

} // namespace vitrail::tool
