// The reason for a failure, in words, for the host's log.
#pragma once

#include <cstdarg>
#include <cstdio>

#include "vitrail/vitrail.h"

namespace vitrail {

struct Log {
  VitrailLog callback = nullptr;
  void* user = nullptr;

  // Logs an error and returns the code: `return log.fail(VK_ERROR_..., "...", ...)`. At most 511 characters.
  [[gnu::format(printf, 3, 4)]] VkResult fail(VkResult result, const char* format, ...) const {
    if (callback != nullptr) {
      char text[512];
      std::va_list arguments;
      va_start(arguments, format);
      std::vsnprintf(text, sizeof(text), format, arguments);
      va_end(arguments);
      callback(VITRAIL_LOG_ERROR, text, user);
    }
    return result;
  }
};

} // namespace vitrail
