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
  uint32_t maxNodeCapacity(VitrailNodeFormat format, VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT) const {
    return vitrailMaxNodeCapacity(handle_, format, samples);
  }
  VitrailResolve defaultResolve(const VitrailTargetDesc& desc) const { return vitrailDefaultResolve(handle_, &desc); }
  VitrailLinking defaultLinking(const VitrailTargetDesc& desc) const { return vitrailDefaultLinking(handle_, &desc); }
  VitrailSpecialization collectSpecialization(const VitrailTargetDesc& desc) const {
    VitrailSpecialization specialization{};
    vitrailCollectSpecialization(handle_, &desc, &specialization);
    return specialization;
  }
  VkResult targetRequirements(const VitrailTargetDesc& desc, VitrailRequirements& requirements) const {
    return vitrailTargetRequirements(handle_, &desc, &requirements);
  }

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
  VitrailLinking linking() const { return vitrailTargetLinking(handle_); }
  VitrailMemory memory() const {
    VitrailMemory memory{};
    vitrailTargetMemory(handle_, &memory);
    return memory;
  }

  // Both change the descriptor set.
  VkResult update(uint64_t frame) { return vitrailUpdateTarget(handle_, frame); }
  VkResult resize(const VitrailResizeInfo& info) { return vitrailResizeTarget(handle_, &info); }

  void begin(VkCommandBuffer commandBuffer, const VitrailBeginInfo& info = {}) const {
    vitrailCmdBegin(commandBuffer, handle_, &info);
  }
  void collected(VkCommandBuffer commandBuffer) const { vitrailCmdCollected(commandBuffer, handle_); }
  void resolve(VkCommandBuffer commandBuffer, const VitrailResolveInfo& info = {}) const {
    vitrailCmdResolve(commandBuffer, handle_, &info);
  }
  void end(VkCommandBuffer commandBuffer) const { vitrailCmdEnd(commandBuffer, handle_); }

  VitrailBarriers barriers(VitrailBarrierPoint point) const {
    VitrailBarriers barriers{};
    vitrailBarriers(handle_, point, &barriers);
    return barriers;
  }
  VkResult readStats(uint64_t frame, VitrailStats& stats) const { return vitrailReadStats(handle_, frame, &stats); }

 private:
  VitrailTarget handle_ = nullptr;
};

// Owns a VitrailTilePlan.
class TilePlan {
 public:
  TilePlan() = default;
  ~TilePlan() { vitrailDestroyTilePlan(handle_); }
  TilePlan(TilePlan&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  TilePlan& operator=(TilePlan&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  // Replaces what `plan` owns. On error it owns nothing.
  static VkResult create(const Context& context, const VitrailTilePlanDesc& desc, TilePlan& plan) {
    plan = TilePlan();
    return vitrailCreateTilePlan(context.handle(), &desc, &plan.handle_);
  }

  explicit operator bool() const { return handle_ != nullptr; }
  VitrailTilePlan handle() const { return handle_; }
  // Sets the fields of a target that draws this plan's tiles.
  void prepare(VitrailTargetDesc& desc) const { vitrailTilePlanTarget(handle_, &desc); }
  // False: all tiles are done.
  bool next(VkRect2D& tile) { return vitrailNextTile(handle_, &tile) != VK_FALSE; }
  VkResult finish(const VitrailStats& stats) { return vitrailFinishTile(handle_, &stats); }

 private:
  VitrailTilePlan handle_ = nullptr;
};

} // namespace vitrail
