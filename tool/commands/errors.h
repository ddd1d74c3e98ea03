// What ends a command early. `main` catches each once and prints one line.
#pragma once

#include <stdexcept>

namespace vitrail::tool {

// The command line asks for something that cannot be meant: exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

} // namespace vitrail::tool
