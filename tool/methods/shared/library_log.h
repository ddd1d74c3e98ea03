// What the library says when a call of it fails.
#pragma once

#include <string>

#include <vitrail/types.h>

namespace vitrail::tool {

// For VitrailLog: keeps the last error in `reason`, a std::string.
inline void rememberError(VitrailLogSeverity severity, const char* message, void* reason) {
  if (severity == VITRAIL_LOG_ERROR) *static_cast<std::string*>(reason) = message;
}

} // namespace vitrail::tool
