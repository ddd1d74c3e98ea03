// Sizes: nodes of each format, the most that a pool can have, and where everything lies in a target's one buffer.
#pragma once

#include <algorithm>
#include <cstdint>

#include "vitrail/layout.h"

namespace vitrail {

// Bytes of a node, with or without a word of the host's; 0 where `format` is none of VITRAIL_FORMAT_*.
constexpr std::uint32_t nodeBytes(std::uint32_t format, bool userWords = false) {
  const std::uint32_t word = userWords ? sizeof(layout::uint) : 0; // behind all nodes
  switch (format) {
    case layout::VITRAIL_FORMAT_STANDARD:
      return sizeof(layout::VitrailNodeStandard) + sizeof(layout::uint) + word; // the link lies apart
    case layout::VITRAIL_FORMAT_COMPACT:
      return sizeof(layout::VitrailNodeCompact) + word;
    case layout::VITRAIL_FORMAT_HDR:
      return sizeof(layout::VitrailNodeHdr) + word;
    default:
      return 0;
  }
}

// Bits of a node's last word that hold its coverage.
constexpr std::uint32_t coverageBits(std::uint32_t samples) { return samples == 1 ? 0 : samples <= 4 ? 4 : 8; }

// Bits of a node's last word that hold the index of the next node.
constexpr std::uint32_t indexBits(std::uint32_t format, std::uint32_t samples) {
  return format == layout::VITRAIL_FORMAT_COMPACT ? 24 : 32 - coverageBits(samples);
}

// The most nodes that one pool can have: of the indices that fit into a node the last ends a list, and the counter that
// hands them out must not come round to them. 0 where the format does not go with the sample count.
constexpr std::uint32_t maxNodeIndexCount(std::uint32_t format, std::uint32_t samples) {
  const bool knownSamples = samples == 1 || samples == 2 || samples == 4 || samples == 8;
  if (nodeBytes(format) == 0 || !knownSamples) return 0;
  if (format == layout::VITRAIL_FORMAT_COMPACT && samples > 4) return 0;
  constexpr std::uint64_t kCountable = layout::VITRAIL_WRAP_AT - layout::VITRAIL_WRAP_STEP;
  return static_cast<std::uint32_t>(std::min((std::uint64_t{1} << indexBits(format, samples)) - 2, kCountable));
}

// Bytes of a pool. A pool without nodes still has the room of one: a buffer cannot be empty.
constexpr std::uint64_t nodePoolBytes(std::uint32_t format, std::uint32_t capacity, bool userWords = false) {
  return std::max<std::uint64_t>(capacity, 1) * nodeBytes(format, userWords);
}

// Bytes of the head pointers of an area.
constexpr std::uint64_t headBytes(std::uint32_t areaPixels) {
  return std::max<std::uint64_t>(areaPixels, 1) * sizeof(layout::uint);
}

// Bytes of an array of the pixels that have more than `shorter` fragments: a pool makes only so many of them.
constexpr std::uint64_t listBytes(std::uint32_t areaPixels, std::uint32_t capacity, std::uint32_t shorter) {
  return std::max<std::uint64_t>(std::min(areaPixels, capacity / (shorter + 1)), 1) * sizeof(layout::uint);
}

// Bytes of an array of the lists that groups of invocations take, four words each, and eight where the list has more
// than VITRAIL_LONG_LIST fragments.
constexpr std::uint64_t groupListBytes(std::uint32_t areaPixels, std::uint32_t capacity) {
  const std::uint64_t most = std::uint64_t{2} * capacity / (layout::VITRAIL_LONG_LIST + 1); // shorter lists: no more
  return std::max<std::uint64_t>(std::min(std::uint64_t{2} * areaPixels, most), 1) * sizeof(layout::uvec4);
}

// The most nodes for which that array takes no more than `range` bytes, whatever the area.
constexpr std::uint64_t nodesForGroupLists(std::uint64_t range) {
  return range / sizeof(layout::uvec4) * (layout::VITRAIL_LONG_LIST + 1) / 2;
}

// Bytes of the sums that a frame is blended from when it overflows.
constexpr std::uint64_t sumBytes(std::uint32_t areaPixels) {
  return std::uint64_t{areaPixels} * layout::VITRAIL_SUM_WORDS * sizeof(layout::uint);
}

// Bytes of a copy of lists: what precedes the layers of an area of so many pixels, and the whole.
constexpr std::uint64_t copyListsOffset() { return sizeof(layout::VitrailCopyHeader); }
constexpr std::uint64_t copyLayersOffset(std::uint64_t pixels) {
  return copyListsOffset() + pixels * 2 * sizeof(layout::uint);
}
constexpr std::uint64_t copyBytes(std::uint64_t pixels, std::uint32_t layers) {
  return copyLayersOffset(pixels) + std::uint64_t{layers} * sizeof(layout::VitrailLayer);
}

// A part of a buffer, in bytes.
struct StoragePart {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
};

// Everything that the shaders of a target share, in one buffer.
struct StorageLayout {
  StoragePart parameters;  // VitrailParameters
  StoragePart control;     // VitrailControl
  StoragePart heads;       // a node index a pixel of the area
  StoragePart mediumLists; // pixels whose lists one invocation takes
  StoragePart longLists;   // lists that groups of invocations take, or pixels
  StoragePart sums;        // VITRAIL_SUM_WORDS a pixel of the area; 16 unused bytes where none are kept
  StoragePart copy;        // copied lists, of at most as many pixels as layers; 16 unused bytes where none are
  StoragePart nodes;       // the pool
  std::uint64_t total = 0; // bytes of the buffer
};

// What that depends on.
struct StorageNeeds {
  std::uint32_t areaPixels = 0;
  std::uint32_t nodeCapacity = 0;
  std::uint32_t format = 0; // VITRAIL_FORMAT_*
  bool keepSums = false;
  bool userWords = false;
  std::uint32_t copyLayers = 0;
  std::uint64_t alignment = 256; // of each part, in bytes: a power of two, at least 4
};

// Places the parts one after the other.
constexpr StorageLayout layoutStorage(const StorageNeeds& needs) {
  constexpr std::uint64_t kEmpty = 16; // a binding cannot be empty
  StorageLayout storage;
  const auto place = [&](std::uint64_t size) {
    const StoragePart part{(storage.total + needs.alignment - 1) / needs.alignment * needs.alignment, size};
    storage.total = part.offset + part.size;
    return part;
  };
  storage.parameters = place(sizeof(layout::VitrailParameters));
  storage.control = place(sizeof(layout::VitrailControl));
  storage.heads = place(headBytes(needs.areaPixels));
  storage.mediumLists = place(listBytes(needs.areaPixels, needs.nodeCapacity, layout::VITRAIL_SHORT_LIST));
  // Where lists are not left to groups of invocations, it holds the pixels of all that are not short, which are fewer.
  storage.longLists = place(groupListBytes(needs.areaPixels, needs.nodeCapacity));
  storage.sums = place(needs.keepSums ? std::max(sumBytes(needs.areaPixels), kEmpty) : kEmpty);
  storage.copy = place(needs.copyLayers > 0 ? copyBytes(needs.copyLayers, needs.copyLayers) : kEmpty);
  storage.nodes = place(nodePoolBytes(needs.format, needs.nodeCapacity, needs.userWords));
  return storage;
}

// The most nodes for which layoutStorage() takes no more than `bytes`, and that the format can have at that sample
// count; 0 where not even one fits. `needs` with any nodeCapacity.
constexpr std::uint32_t nodeCapacityFor(std::uint64_t bytes, StorageNeeds needs, std::uint32_t samples) {
  std::uint32_t fits = 0;
  std::uint32_t most = maxNodeIndexCount(needs.format, samples);
  while (fits < most) { // the size grows with the capacity
    needs.nodeCapacity = most - (most - fits) / 2;
    if (layoutStorage(needs).total <= bytes) {
      fits = needs.nodeCapacity;
    } else {
      most = needs.nodeCapacity - 1;
    }
  }
  return fits;
}

} // namespace vitrail
