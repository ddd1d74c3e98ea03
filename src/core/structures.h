// The first field of every public structure, whatever the API.
#pragma once

#include "log.h"
#include "vitrail/types.h"

namespace vitrail {

// Zeroes a structure that the library fills in; its `next` is the host's.
template <class Structure>
void clearKeepingNext(Structure& structure) {
  void* next = structure.next;
  structure = {};
  structure.next = next;
}

// Refuses, with a log line, a descriptor whose `next` is not null: this version knows nothing for it.
inline VitrailResult checkNoNext(const Log& log, const void* next, const char* structure) {
  if (next == nullptr) return VITRAIL_SUCCESS;
  return log.fail(VITRAIL_ERROR_INVALID, "%s::next: version %d.%d knows no further structures", structure,
                  VITRAIL_VERSION_MAJOR, VITRAIL_VERSION_MINOR);
}

} // namespace vitrail
