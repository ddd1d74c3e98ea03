// What happens in a window, for scripts and tests: a line of JSON each.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "drawer.h"

namespace vitrail::tool {

class EventLog {
 public:
  // Empty: none is kept. Throws std::runtime_error where the file cannot be written.
  explicit EventLog(const std::string& file);

  // A picture is on the screen; `command` draws it again.
  void shown(const Drawn& drawn, const std::string& command);
  void picked(const Picked& picked);
  // "error", "saved", "copied", "opened" and what of it.
  void happened(const std::string& event, const std::string& text);

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_{nullptr, std::fclose};
};

} // namespace vitrail::tool
