// A compute shader of the host's that walks lists (vitrail/list.glsl) and writes them down.
#pragma once

#include <compare>
#include <optional>
#include <vector>

#include "../host.h"
#include "objects.h"

namespace vitrail::tests::vulkan {

struct WalkKind {
  bool byAddress = false; // the shader reaches the pool by its address
  bool sorted = false;    // it takes long lists to lie sorted (VITRAIL_SORTED_LISTS)

  auto operator<=>(const WalkKind&) const = default;
};

class ListWalker {
 public:
  // `set` is the library's layout.
  ListWalker(const Device& device, VkDescriptorSetLayout set, const WalkKind& kind);

  // Walks the lists of an area of the target with this set. The lists are visible to compute shaders.
  void cmdWalk(VkCommandBuffer commands, VkDescriptorSet set, const VitrailRect& area);

  // What was written down, once it has been executed; nothing for a list whose walk was cut.
  [[nodiscard]] std::vector<std::optional<std::vector<VitrailLayer>>> read() const;

 private:
  const Device& device_;
  Owned<VkDescriptorSetLayout> setLayout_;
  Owned<VkPipelineLayout> layout_;
  Owned<VkPipeline> pipeline_;
  Owned<VkDescriptorPool> pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  Buffer walked_;
  std::uint32_t pixels_ = 0;
};

} // namespace vitrail::tests::vulkan
