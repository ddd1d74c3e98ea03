// Per-pixel linked lists: exact transparency through libvitrail, as any host embeds it.
#pragma once

#include <string>

#include <vitrail/vitrail.hpp>

#include "../draw/device.h"
#include "method.h"

namespace vitrail::tool {

class LinkedList final : public Method {
 public:
  // Throws GpuError.
  explicit LinkedList(Gpu& gpu);
  ~LinkedList() override;

  std::string_view name() const override { return "linked-list"; }
  std::span<const std::uint32_t> collectShader() const override;
  VkDescriptorSetLayout collectLayout() const override { return context_.descriptorSetLayout(); }
  VkDescriptorSet collectSet() const override { return target_.descriptorSet(); }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void cmdClear(VkCommandBuffer commands, std::uint64_t frame) override;
  void cmdCollected(VkCommandBuffer commands) override { target_.collected(commands); }
  void cmdResolve(VkCommandBuffer commands) override { target_.resolve(commands); }
  MethodStats stats(std::uint64_t frame) const override;
  bool grow(const MethodStats& stats) override;

 private:
  void createTarget(std::uint32_t nodeCapacity);
  void check(VkResult result, const char* call) const;

  Gpu& gpu_;
  std::string reason_; // what the library last logged
  Context context_;
  Target target_;
  MethodTarget wanted_;
  std::uint64_t counted_ = 0; // the target's bytes, as the Gpu counts them
};

} // namespace vitrail::tool
