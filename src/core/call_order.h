// Which recording call may come next in a frame.
#pragma once

#include <cstdint>

#include "log.h"

namespace vitrail {

// The recording calls, in the order of a frame. Draws stands for the host's own commands that collect.
enum class Call : std::uint32_t { Begin, Draws, Collected, CopyLists, Resolve, End };
constexpr std::uint32_t kCalls = 6;

class CallOrder {
 public:
  // Whether a call may record what it is for. Where it may not, the log gets one line (`prefix` is what the API's calls
  // begin with, "vitrailVkCmd"), and the frame counts as out of order.
  bool allows(Call call, const Log& log, const char* prefix);

  // The memory that an open frame uses is about to be replaced: what was recorded of it may not be submitted any more.
  void drop(const Log& log, const char* why);

  [[nodiscard]] bool collected() const { return state_ == State::Collected || state_ == State::Resolved; }

  // Whether a call of this frame was missing, came at the wrong place, or could not do what it was asked for.
  [[nodiscard]] bool misused() const { return misused_; }
  void setMisused() { misused_ = true; }
  [[nodiscard]] bool begun() const { return state_ != State::Ended; }

 private:
  enum class State : std::uint32_t { Ended, Begun, Collected, Resolved };

  bool allowsEnd(const Log& log, const char* prefix);
  bool refuse(const Log& log, const char* prefix, const char* call, const char* reason);

  State state_ = State::Ended;
  bool misused_ = false;
};

} // namespace vitrail
