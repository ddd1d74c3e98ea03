// How much tests try. On a driver for CPUs most of a test's time is the compilation of its pipelines, so that ./test
// tries each kind of what a test is about once, and ./test --thorough all of its values with each other.
#pragma once

#include <cstdlib>

namespace vitrail::tests {

// ./test --thorough was asked for, which sets VITRAIL_TEST_THOROUGH.
inline bool isThorough() {
  const char* given = std::getenv("VITRAIL_TEST_THOROUGH");
  return given != nullptr && *given != '\0';
}

} // namespace vitrail::tests
