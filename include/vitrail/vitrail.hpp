// Move-only C++ wrappers of vitrail.h: they own the handles and change nothing else. Every function is documented
// there.
#pragma once

#include <vitrail/vitrail.h>

#include <utility>

namespace vitrail {

// Owns a VitrailContext.
class Context {
 public:
  Context() = default;
  ~Context() { vitrailDestroyContext(handle_); }
  Context(Context&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Context& operator=(Context&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  // Replaces what `context` owns. On error it owns nothing.
  static VkResult create(const VitrailContextDesc& desc, Context& context) {
    context = Context();
    return vitrailCreateContext(&desc, &context.handle_);
  }

  explicit operator bool() const { return handle_ != nullptr; }
  VitrailContext handle() const { return handle_; }
  VkDescriptorSetLayout descriptorSetLayout() const { return vitrailDescriptorSetLayout(handle_); }
  uint32_t maxNodeCapacity(VitrailNodeFormat format) const { return vitrailMaxNodeCapacity(handle_, format); }

 private:
  VitrailContext handle_ = nullptr;
};

// Owns a VitrailTarget. Its context must outlive it.
class Target {
 public:
  Target() = default;
  ~Target() { vitrailDestroyTarget(handle_); }
  Target(Target&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Target& operator=(Target&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  // Replaces what `target` owns. On error it owns nothing.
  static VkResult create(const Context& context, const VitrailTargetDesc& desc, Target& target) {
    target = Target();
    return vitrailCreateTarget(context.handle(), &desc, &target.handle_);
  }

  explicit operator bool() const { return handle_ != nullptr; }
  VitrailTarget handle() const { return handle_; }
  VkDescriptorSet descriptorSet() const { return vitrailTargetDescriptorSet(handle_); }
  VitrailMemory memory() const {
    VitrailMemory memory{};
    vitrailTargetMemory(handle_, &memory);
    return memory;
  }

  void begin(VkCommandBuffer commandBuffer, const VitrailBeginInfo& info = {}) const {
    vitrailCmdBegin(commandBuffer, handle_, &info);
  }
  void collected(VkCommandBuffer commandBuffer) const { vitrailCmdCollected(commandBuffer, handle_); }
  void resolve(VkCommandBuffer commandBuffer, const VitrailResolveInfo& info = {}) const {
    vitrailCmdResolve(commandBuffer, handle_, &info);
  }
  VkResult readStats(uint64_t frame, VitrailStats& stats) const { return vitrailReadStats(handle_, frame, &stats); }

 private:
  VitrailTarget handle_ = nullptr;
};

} // namespace vitrail
