// Move-only C++ wrappers of Vitrail's C headers: they own the handles and change nothing else. Every function is
// documented in vulkan.h, vulkan_raster.h, vulkan_trial.h, gl.h and tiles.h. C++17 or later. VITRAIL_NO_VULKAN leaves
// out what needs Vulkan's headers; what is of OpenGL needs no header of OpenGL's, and is there where the package has
// gl.h.
#pragma once

#include <vitrail/tiles.h>
#include <vitrail/types.h>
#ifndef VITRAIL_NO_VULKAN
#include <vitrail/vulkan.h>
#include <vitrail/vulkan_raster.h>
#include <vitrail/vulkan_trial.h>
#endif
#if __has_include(<vitrail/gl.h>)
#include <vitrail/gl.h>
#endif

#include <cstddef>
#include <cstdint>
#include <utility>

#if __cplusplus < 201703L && !(defined(_MSVC_LANG) && _MSVC_LANG >= 201703L)
#error vitrail.hpp needs C++17 or later; the C headers need none
#endif

namespace vitrail {

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
  static VitrailResult create(const VitrailTilePlanDesc& desc, TilePlan& plan) {
    plan = TilePlan();
    return vitrailCreateTilePlan(&desc, &plan.handle_);
  }

  explicit operator bool() const { return handle_ != nullptr; }
  VitrailTilePlan handle() const { return handle_; }
  // What a target that draws this plan's tiles is made with.
  std::uint32_t nodeCapacity() const { return vitrailTilePlanNodeCapacity(handle_); }
  std::uint32_t areaPixels() const { return vitrailTilePlanAreaPixels(handle_); }
  // False: all tiles are done.
  bool next(VitrailRect& tile) { return vitrailNextTile(handle_, &tile) != 0; }
  VitrailResult finish(const VitrailStats& stats) { return vitrailFinishTile(handle_, &stats); }

 private:
  VitrailTilePlan handle_ = nullptr;
};

#ifndef VITRAIL_NO_VULKAN
namespace vulkan {

// Owns a VitrailVkContext.
class Context {
 public:
  Context() = default;
  ~Context() { vitrailVkDestroyContext(handle_); }
  Context(Context&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Context& operator=(Context&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  // Replaces what `context` owns. On error it owns nothing.
  static VkResult create(const VitrailVkContextDesc& desc, Context& context) {
    context = Context();
    return vitrailVkCreateContext(&desc, &context.handle_);
  }

  explicit operator bool() const { return handle_ != nullptr; }
  VitrailVkContext handle() const { return handle_; }
  VkDescriptorSetLayout descriptorSetLayout() const { return vitrailVkDescriptorSetLayout(handle_); }
  std::uint32_t maxNodeCapacity(VitrailNodeFormat format, VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT) const {
    return vitrailVkMaxNodeCapacity(handle_, format, samples);
  }
  VitrailResolve defaultResolve(const VitrailVkTargetDesc& desc) const {
    return vitrailVkDefaultResolve(handle_, &desc);
  }
  VitrailListBuild defaultListBuild(const VitrailVkTargetDesc& desc) const {
    return vitrailVkDefaultListBuild(handle_, &desc);
  }
  VitrailVkSpecialization collectSpecialization(const VitrailVkTargetDesc& desc) const {
    VitrailVkSpecialization specialization{};
    vitrailVkCollectSpecialization(handle_, &desc, &specialization);
    return specialization;
  }
  VkResult targetRequirements(const VitrailVkTargetDesc& desc, VitrailVkRequirements& requirements) const {
    return vitrailVkTargetRequirements(handle_, &desc, &requirements);
  }
  VkResult tileLimits(VitrailNodeFormat format, VkSampleCountFlagBits samples, VitrailTileLimits& limits) const {
    return vitrailVkTileLimits(handle_, format, samples, &limits);
  }

 private:
  VitrailVkContext handle_ = nullptr;
};

// Owns a VitrailVkTarget. Its context outlives it.
class Target {
 public:
  Target() = default;
  ~Target() { vitrailVkDestroyTarget(handle_); }
  Target(Target&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Target& operator=(Target&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  // Replaces what `target` owns. On error it owns nothing.
  static VkResult create(const Context& context, const VitrailVkTargetDesc& desc, Target& target) {
    target = Target();
    return vitrailVkCreateTarget(context.handle(), &desc, &target.handle_);
  }

  explicit operator bool() const { return handle_ != nullptr; }
  VitrailVkTarget handle() const { return handle_; }
  VkDescriptorSet descriptorSet() const { return vitrailVkTargetDescriptorSet(handle_); }
  VitrailResolve resolveKind() const { return vitrailVkTargetResolve(handle_); }
  VitrailListBuild listBuild() const { return vitrailVkTargetListBuild(handle_); }
  std::uint64_t frame() const { return vitrailVkTargetFrame(handle_); }
  VitrailMemory memory() const {
    VitrailMemory memory{};
    vitrailVkTargetMemory(handle_, &memory);
    return memory;
  }

  // A resize changes the descriptor set, and an update may.
  VkResult update(std::uint64_t frame = 0) { return vitrailVkUpdateTarget(handle_, frame); }
  VkResult resize(const VitrailVkResizeInfo& info) { return vitrailVkResizeTarget(handle_, &info); }

  void begin(VkCommandBuffer commandBuffer, const VitrailVkBeginInfo& info = {}) const {
    vitrailVkCmdBegin(commandBuffer, handle_, &info);
  }
  void collected(VkCommandBuffer commandBuffer) const { vitrailVkCmdCollected(commandBuffer, handle_); }
  void resolve(VkCommandBuffer commandBuffer, const VitrailVkResolveInfo& info = {}) const {
    vitrailVkCmdResolve(commandBuffer, handle_, &info);
  }
  void end(VkCommandBuffer commandBuffer) const { vitrailVkCmdEnd(commandBuffer, handle_); }

  VkDeviceSize copySize(std::uint32_t width, std::uint32_t height) const {
    return vitrailVkCopySize(handle_, width, height);
  }
  void copyLists(VkCommandBuffer commandBuffer, const VitrailVkCopyInfo& info) const {
    vitrailVkCmdCopyLists(commandBuffer, handle_, &info);
  }

  VitrailVkBarriers barriers(VitrailVkBarrierPoint point) const {
    VitrailVkBarriers barriers{};
    vitrailVkBarriers(handle_, point, &barriers);
    return barriers;
  }
  VkResult readStats(std::uint64_t frame, VitrailStats& stats) const {
    return vitrailVkReadStats(handle_, frame, &stats);
  }

 private:
  VitrailVkTarget handle_ = nullptr;
};

// Owns a VitrailVkRaster. Its context outlives it.
class Raster {
 public:
  Raster() = default;
  ~Raster() { vitrailVkDestroyRaster(handle_); }
  Raster(Raster&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Raster& operator=(Raster&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  // Replaces what `raster` owns. On error it owns nothing.
  static VkResult create(const Context& context, const VitrailVkRasterDesc& desc, Raster& raster) {
    raster = Raster();
    return vitrailVkCreateRaster(context.handle(), &desc, &raster.handle_);
  }

  explicit operator bool() const { return handle_ != nullptr; }
  VitrailVkRaster handle() const { return handle_; }
  std::uint32_t bands() const { return vitrailVkRasterBands(handle_); }
  VitrailVkRasterMemory memory() const {
    VitrailVkRasterMemory memory{};
    vitrailVkRasterMemory(handle_, &memory);
    return memory;
  }

  VkResult update(std::uint64_t frame = 0) { return vitrailVkUpdateRaster(handle_, frame); }
  VkResult resize(const VkExtent2D& extent) { return vitrailVkResizeRaster(handle_, extent); }
  void draw(VkCommandBuffer commandBuffer, const VitrailVkRasterInfo& info) const {
    vitrailVkCmdRaster(commandBuffer, handle_, &info);
  }
  VkResult readStats(std::uint64_t frame, VitrailVkRasterStats& stats) const {
    return vitrailVkReadRasterStats(handle_, frame, &stats);
  }

 private:
  VitrailVkRaster handle_ = nullptr;
};

// Owns a VitrailVkTrial. Its context outlives it.
class Trial {
 public:
  Trial() = default;
  ~Trial() { vitrailVkDestroyTrial(handle_); }
  Trial(Trial&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Trial& operator=(Trial&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  // Replaces what `trial` owns. On error it owns nothing.
  static VkResult create(const Context& context, const VitrailVkTrialDesc& desc, Trial& trial) {
    trial = Trial();
    return vitrailVkCreateTrial(context.handle(), &desc, &trial.handle_);
  }

  explicit operator bool() const { return handle_ != nullptr; }
  VitrailVkTrial handle() const { return handle_; }
  std::uint32_t way() { return vitrailVkTrialWay(handle_); }
  void begin(VkCommandBuffer commandBuffer, std::uint32_t way) { vitrailVkCmdTrialBegin(commandBuffer, handle_, way); }
  void end(VkCommandBuffer commandBuffer) { vitrailVkCmdTrialEnd(commandBuffer, handle_); }
  VkResult read(VitrailVkTrialResult& result) { return vitrailVkReadTrial(handle_, &result); }
  VkResult memory(std::size_t& size, void* data) { return vitrailVkTrialMemory(handle_, &size, data); }

 private:
  VitrailVkTrial handle_ = nullptr;
};

} // namespace vulkan
#endif

#ifdef VITRAIL_GL_H
namespace opengl {

// Owns a VitrailGlContext.
class Context {
 public:
  Context() = default;
  ~Context() { vitrailGlDestroyContext(handle_); }
  Context(Context&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Context& operator=(Context&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  // Replaces what `context` owns. On error it owns nothing.
  static VitrailResult create(const VitrailGlContextDesc& desc, Context& context) {
    context = Context();
    return vitrailGlCreateContext(&desc, &context.handle_);
  }

  explicit operator bool() const { return handle_ != nullptr; }
  VitrailGlContext handle() const { return handle_; }
  const char* collectSource() const { return vitrailGlCollectSource(handle_); }
  const char* listSource() const { return vitrailGlListSource(handle_); }
  std::uint32_t maxNodeCapacity(VitrailNodeFormat format, std::uint32_t samples = 1) const {
    return vitrailGlMaxNodeCapacity(handle_, format, samples);
  }
  VitrailResolve defaultResolve(const VitrailGlTargetDesc& desc) const {
    return vitrailGlDefaultResolve(handle_, &desc);
  }
  VitrailListBuild defaultListBuild(const VitrailGlTargetDesc& desc) const {
    return vitrailGlDefaultListBuild(handle_, &desc);
  }
  VitrailGlSpecialization collectSpecialization(const VitrailGlTargetDesc& desc) const {
    VitrailGlSpecialization specialization{};
    vitrailGlCollectSpecialization(handle_, &desc, &specialization);
    return specialization;
  }
  VitrailResult targetRequirements(const VitrailGlTargetDesc& desc, VitrailGlRequirements& requirements) const {
    return vitrailGlTargetRequirements(handle_, &desc, &requirements);
  }
  VitrailResult tileLimits(VitrailNodeFormat format, std::uint32_t samples, VitrailTileLimits& limits) const {
    return vitrailGlTileLimits(handle_, format, samples, &limits);
  }

 private:
  VitrailGlContext handle_ = nullptr;
};

// Owns a VitrailGlTarget. Its context outlives it.
class Target {
 public:
  Target() = default;
  ~Target() { vitrailGlDestroyTarget(handle_); }
  Target(Target&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Target& operator=(Target&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  // Replaces what `target` owns. On error it owns nothing.
  static VitrailResult create(const Context& context, const VitrailGlTargetDesc& desc, Target& target) {
    target = Target();
    return vitrailGlCreateTarget(context.handle(), &desc, &target.handle_);
  }

  explicit operator bool() const { return handle_ != nullptr; }
  VitrailGlTarget handle() const { return handle_; }
  VitrailResolve resolveKind() const { return vitrailGlTargetResolve(handle_); }
  VitrailListBuild listBuild() const { return vitrailGlTargetListBuild(handle_); }
  std::uint64_t frame() const { return vitrailGlTargetFrame(handle_); }
  VitrailMemory memory() const {
    VitrailMemory memory{};
    vitrailGlTargetMemory(handle_, &memory);
    return memory;
  }

  VitrailResult update(std::uint64_t frame = 0) { return vitrailGlUpdateTarget(handle_, frame); }
  VitrailResult resize(const VitrailGlResizeInfo& info) { return vitrailGlResizeTarget(handle_, &info); }

  void begin(const VitrailGlBeginInfo& info = {}) const { vitrailGlBegin(handle_, &info); }
  void bind() const { vitrailGlBind(handle_); }
  void collected() const { vitrailGlCollected(handle_); }
  void resolve(const VitrailGlResolveInfo& info = {}) const { vitrailGlResolve(handle_, &info); }
  void end() const { vitrailGlEnd(handle_); }

  std::uint64_t copySize(std::uint32_t width, std::uint32_t height) const {
    return vitrailGlCopySize(handle_, width, height);
  }
  void copyLists(const VitrailGlCopyInfo& info) const { vitrailGlCopyLists(handle_, &info); }

  // The bits for glMemoryBarrier().
  std::uint32_t barriers(VitrailGlBarrierPoint point) const { return vitrailGlBarriers(handle_, point); }
  VitrailResult readStats(std::uint64_t frame, VitrailStats& stats) const {
    return vitrailGlReadStats(handle_, frame, &stats);
  }

 private:
  VitrailGlTarget handle_ = nullptr;
};

} // namespace opengl
#endif

} // namespace vitrail
