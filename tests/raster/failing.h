// Makes the system refuse what the library asks for: the program's own operator new and pthread_create.
#pragma once

#include <cstdint>

namespace vitrail::tests::raster {

// From now on the n-th allocation fails, counted from 0, on whatever thread, and with `allAfter` each one after it.
void failAllocation(std::uint64_t n, bool allAfter = false);
// Stops that. Whether an allocation has failed.
bool stopFailingAllocations();

// From now on every thread is refused but the first n.
void failThreads(std::uint32_t n);

} // namespace vitrail::tests::raster
