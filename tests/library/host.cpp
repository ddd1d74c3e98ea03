#include "host.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <random>

namespace vitrail::tests {

FloatColor behindAt(const HostDesc& desc, std::uint32_t sample) {
  return desc.behindSamples.empty() ? desc.behind : desc.behindSamples.at(sample);
}

StorageLayout layoutOf(const HostDesc& desc, std::uint64_t alignment) {
  StorageNeeds parts;
  parts.areaPixels = desc.width * desc.height;
  parts.nodeCapacity = desc.capacity;
  parts.format = desc.nodes;
  parts.keepSums = desc.overflow == VITRAIL_OVERFLOW_APPROXIMATE;
  parts.userWords = desc.userWords;
  parts.copyLayers = desc.copyLayers;
  parts.alignment = alignment;
  return layoutStorage(parts);
}

void scatterNodes(const HostDesc& desc, const StorageLayout& storage, std::span<std::byte> memory) {
  if (desc.nodes != VITRAIL_NODE_STANDARD || desc.samples != 1) {
    throw std::logic_error("scatterNodes: knows standard nodes at one sample only");
  }
  const std::uint32_t capacity = desc.capacity;
  const std::span heads(reinterpret_cast<std::uint32_t*>(memory.data() + storage.heads.offset),
                        std::size_t{desc.width} * desc.height);
  const std::span nodes(reinterpret_cast<layout::VitrailNodeStandard*>(memory.data() + storage.nodes.offset), capacity);
  const std::span links(reinterpret_cast<std::uint32_t*>(nodes.data() + capacity), capacity);
  std::vector<std::uint32_t> place(capacity); // of each node
  std::iota(place.begin(), place.end(), 0U);
  std::shuffle(place.begin(), place.end(), std::mt19937(1));
  const auto moved = [&](std::uint32_t index) { return index < capacity ? place[index] : index; };
  const std::vector<layout::VitrailNodeStandard> oldNodes(nodes.begin(), nodes.end());
  const std::vector<std::uint32_t> oldLinks(links.begin(), links.end());
  const bool linked = desc.listBuild == VITRAIL_LIST_BUILD_FRAGMENT; // else no node names another one yet
  for (std::uint32_t& head : heads) head = moved(head);
  for (std::uint32_t i = 0; i < capacity; ++i) {
    nodes[place[i]] = oldNodes[i];
    links[place[i]] = linked ? moved(oldLinks[i]) : oldLinks[i];
  }
}

} // namespace vitrail::tests
