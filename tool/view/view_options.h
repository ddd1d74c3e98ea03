// What `vitrail view` was asked for.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "../commands/render_options.h"

namespace vitrail::tool {

struct ViewArguments {
  RenderArguments picture;
  std::string events; // a file; empty: none
};

} // namespace vitrail::tool
