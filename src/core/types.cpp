// What types.h declares and no other file is about.
#include "vitrail/types.h"
#include "core/pool.h"

extern "C" uint32_t vitrailVersion(void) { return VITRAIL_VERSION; }

extern "C" uint64_t vitrailNodePoolSize(VitrailNodeFormat format, uint32_t nodeCapacity) {
  return vitrail::nodePoolBytes(format, nodeCapacity);
}
