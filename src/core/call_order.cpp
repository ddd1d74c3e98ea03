#include "call_order.h"

namespace vitrail {

bool CallOrder::refuse(const Log& log, const char* prefix, const char* call, const char* reason) {
  const char* frame = begun() ? ", and the frame does not count as exact" : "";
  log.error("%s%s() %s: it records nothing%s", prefix, call, reason, frame);
  misused_ = true;
  return false;
}

bool CallOrder::allowsEnd(const Log& log, const char* prefix) {
  if (state_ == State::Ended) return refuse(log, prefix, "End", "without a frame that was begun");
  // The counters are still of use. A frame that has had its line needs no second one.
  if (state_ != State::Resolved && !misused_) {
    log.error(
        "%sEnd() of a frame that was not resolved: its fragments are in no picture, and it does not count as exact",
        prefix);
  }
  misused_ = misused_ || state_ != State::Resolved;
  state_ = State::Ended;
  return true;
}

void CallOrder::drop(const Log& log, const char* why) {
  if (!begun()) return;
  log.warn("%s while a frame was begun and not ended: that frame is taken to be dropped", why);
  state_ = State::Ended;
}

bool CallOrder::allows(Call call, const Log& log, const char* prefix) {
  switch (call) {
    case Call::Begin:
      if (begun())
        log.warn("%sBegin() while a frame was begun and not ended: that frame is taken to be dropped", prefix);
      state_ = State::Begun;
      misused_ = false;
      return true;
    case Call::Collected:
      if (!begun()) return refuse(log, prefix, "Collected", "without a frame that was begun");
      if (state_ != State::Begun) return refuse(log, prefix, "Collected", "for the second time in a frame");
      state_ = State::Collected;
      return true;
    case Call::CopyLists:
      if (!begun()) return refuse(log, prefix, "CopyLists", "without a frame that was begun");
      if (state_ == State::Begun) return refuse(log, prefix, "CopyLists", "of lists that were not collected");
      return true;
    case Call::Resolve:
      if (!begun()) return refuse(log, prefix, "Resolve", "without a frame that was begun");
      if (state_ == State::Begun) return refuse(log, prefix, "Resolve", "of lists that were not collected");
      if (state_ == State::Resolved) return refuse(log, prefix, "Resolve", "for the second time in a frame");
      state_ = State::Resolved;
      return true;
    case Call::End:
      return allowsEnd(log, prefix);
    case Call::Draws:
      break;
  }
  return true;
}

} // namespace vitrail
