// Whether a target can be as its descriptor says.
#pragma once

#include "context.h"
#include "vitrail/vitrail.h"

namespace vitrail {

// The descriptor with the area that it stands for.
VitrailTargetDesc withAreaPixels(const VitrailTargetDesc& desc);

// The descriptor with its defaults filled in.
VitrailTargetDesc withDefaults(VitrailContext context, const VitrailTargetDesc& desc);

// Checks what concerns memory: extent, samples, node format, linking, area, capacity, budget. `desc` has its defaults.
// Logs the reason where it fails.
VkResult checkMemory(VitrailContext context, const VitrailTargetDesc& desc);

// Checks everything. `desc` has its defaults. Logs the reason where it fails.
VkResult checkTarget(VitrailContext context, const VitrailTargetDesc& desc);

// Checks the images that a target of that descriptor resolves from and into.
VkResult checkViews(VitrailContext context, const VitrailTargetDesc& desc, const VitrailViews& views);

// Whether the target keeps sums of the fragments that found no node.
bool keepsSums(const VitrailTargetDesc& desc);

// The nodes that the budget has room for, at most as many as a pool can have.
std::uint32_t budgetCapacity(VitrailContext context, const VitrailTargetDesc& desc, std::uint32_t areaPixels);

// Bytes that the target keeps beside its one buffer.
VkDeviceSize statsBytes(const VitrailTargetDesc& desc);

} // namespace vitrail
