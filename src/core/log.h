// The reason for a failure, in words, for the host's log.
#pragma once

#include <cstdarg>
#include <cstdio>

#include "vitrail/types.h"

namespace vitrail {

struct Log {
  VitrailLog callback = nullptr;
  void* user = nullptr;

  // Logs an error and returns the code: `return log.fail(VITRAIL_ERROR_..., "...", ...)`. At most 511 characters.
  template <class Result>
  [[gnu::format(printf, 3, 4)]] Result fail(Result result, const char* format, ...) const {
    std::va_list arguments;
    va_start(arguments, format);
    write(VITRAIL_LOG_ERROR, format, arguments);
    va_end(arguments);
    return result;
  }

  // Of a call that returns nothing.
  [[gnu::format(printf, 2, 3)]] void error(const char* format, ...) const {
    std::va_list arguments;
    va_start(arguments, format);
    write(VITRAIL_LOG_ERROR, format, arguments);
    va_end(arguments);
  }

  // Of a call that goes on.
  [[gnu::format(printf, 2, 3)]] void warn(const char* format, ...) const {
    std::va_list arguments;
    va_start(arguments, format);
    write(VITRAIL_LOG_WARNING, format, arguments);
    va_end(arguments);
  }

 private:
  [[gnu::format(printf, 3, 0)]] void write(VitrailLogSeverity severity, const char* format,
                                           std::va_list arguments) const {
    if (callback == nullptr) return;
    char text[512];
    std::vsnprintf(text, sizeof(text), format, arguments);
    callback(severity, text, user);
  }
};

} // namespace vitrail
