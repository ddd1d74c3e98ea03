#include "point_host.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "gpu/barrier.h"
#include "gpu/vk.h"
#include "shaders/opaque.h"

namespace vitrail::tests {

namespace {

using tool::Access;
using tool::MemoryKind;
using tool::UsedImage;
using tool::vkStruct;

constexpr Access kColorBlend{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                             VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
constexpr Access kDepthTest{VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                            VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT};
constexpr Access kDepthWrite{kDepthTest.stages, kDepthTest.accesses | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
constexpr Access kComputeReadWrite{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                   VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
constexpr Access kCopyRead{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};

// Why the library refused something last.
std::string& reason() {
  static std::string text;
  return text;
}

void check(VkResult result, const std::string& call) {
  if (result < 0) throw std::runtime_error(call + ": " + tool::resultName(result) + ": " + reason());
}

// The clip-space vertex whose point covers the pixel's centre.
PointVertex toVertex(const Point& point, const PointHostDesc& desc) {
  const auto clip = [](std::uint32_t pixel, std::uint32_t size) {
    return (static_cast<float>(pixel) + 0.5F) * 2.0F / static_cast<float>(size) - 1.0F;
  };
  return {{clip(point.x, desc.width), clip(point.y, desc.height), point.depth}, point.color, point.blend};
}

VkRenderingAttachmentInfo attachment(const UsedImage& image, VkImageLayout layout, VkAttachmentLoadOp load,
                                     VkClearValue clear = {}) {
  auto info = vkStruct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
  info.imageView = image.get().view();
  info.imageLayout = layout;
  info.loadOp = load;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  info.clearValue = clear;
  return info;
}

// Begins a scope over a whole picture. Null attachments are left out.
void beginScope(VkCommandBuffer commands, VkExtent2D extent, const VkRenderingAttachmentInfo* color,
                const VkRenderingAttachmentInfo* depth, const VkRenderingAttachmentInfo* stencil) {
  auto info = vkStruct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
  info.renderArea = {{0, 0}, extent};
  info.layerCount = 1;
  info.colorAttachmentCount = color != nullptr ? 1 : 0;
  info.pColorAttachments = color;
  info.pDepthAttachment = depth;
  info.pStencilAttachment = stencil;
  vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{0.0F, 0.0F, static_cast<float>(extent.width), static_cast<float>(extent.height),
                            0.0F, 1.0F};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &info.renderArea);
}

tool::Unique<VkImageView> depthOnlyView(tool::Gpu& gpu, const tool::GpuImage& image) {
  auto info = vkStruct<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
  info.image = image.get();
  info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  info.format = image.info().format;
  info.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
  VkImageView view = VK_NULL_HANDLE;
  check(vkCreateImageView(gpu.device(), &info, nullptr, &view), "vkCreateImageView");
  return {gpu.device(), view, vkDestroyImageView};
}

std::uint32_t featureBits(const tool::Gpu& gpu, const PointHostDesc& desc) {
  std::uint32_t features = 0;
  if (desc.addresses) features |= VITRAIL_FEATURE_BUFFER_DEVICE_ADDRESS;
  if (desc.dualSourceBlending && gpu.features().dualSourceBlending) features |= VITRAIL_FEATURE_DUAL_SRC_BLEND;
  if (gpu.features().sampleRateShading) features |= VITRAIL_FEATURE_SAMPLE_RATE_SHADING;
  return features;
}

// What hosts share. Contexts go last: pipelines are made with their layouts.
struct Shared {
  std::map<std::pair<VkDevice, std::uint32_t>, Context> contexts;
  std::map<PointPipelinesInfo, PointPipelines> pipelines; // a context's set layout tells devices apart
};

Shared& shared() {
  static Shared all;
  return all;
}

PointPipelines& sharedPipelines(tool::Gpu& gpu, const PointPipelinesInfo& info) {
  return shared().pipelines.try_emplace(info, gpu, info).first->second;
}

} // namespace

Context& sharedContext(tool::Gpu& gpu, std::uint32_t features) {
  Context& context = shared().contexts[{gpu.device(), features}];
  if (context) return context;
  VitrailContextDesc desc{};
  desc.instance = gpu.instance();
  desc.physicalDevice = gpu.physicalDevice();
  desc.device = gpu.device();
  desc.getInstanceProcAddr = vkGetInstanceProcAddr;
  desc.features = features;
  desc.log = [](VitrailLogSeverity, const char* message, void*) { reason() = message; };
  check(Context::create(desc, context), "vitrailCreateContext");
  return context;
}

void dropContexts() {
  shared().pipelines.clear();
  shared().contexts.clear();
}

FloatColor behindAt(const PointHostDesc& desc, std::uint32_t sample) {
  return desc.behindSamples.empty() ? desc.behind : desc.behindSamples.at(sample);
}

PointHost::PointHost(tool::Gpu& gpu, const PointHostDesc& desc)
    : gpu_(gpu), desc_(desc), context_(&sharedContext(gpu, featureBits(gpu, desc))), submitter_(gpu) {
  postDepthCoverage_ = multisampled() && desc.postDepthCoverage && gpu.features().postDepthCoverage;
  if (desc.stencilMark) {
    depthFormat_ = VK_FORMAT_D32_SFLOAT_S8_UINT;
  } else if (multisampled() || !desc.opaqueDepth.empty()) {
    depthFormat_ = VK_FORMAT_D32_SFLOAT;
  }
  makeSlots();
  VitrailTargetDesc target = targetDesc();
  createTarget(target);
  pipelines_ = &sharedPipelines(gpu, specialized(pipelinesInfo(), target));
  if (!desc.strangersFor) return;
  desc_.specialized = true;
  target.overflow = *desc.strangersFor;
  strangers_ = &sharedPipelines(gpu, specialized(pipelinesInfo(), target));
}

PointHost::Slot PointHost::makeSlot() const {
  Slot slot;
  slot.extent = {desc_.width, desc_.height};
  tool::GpuImageInfo info;
  info.extent = slot.extent;
  info.format = desc_.colorFormat;
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
               VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  slot.color = UsedImage(tool::GpuImage(gpu_, info, "points: colour"));
  info.samples = static_cast<VkSampleCountFlagBits>(desc_.samples);
  if (multisampled()) {
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    slot.multisampled = UsedImage(tool::GpuImage(gpu_, info, "points: multisampled colour"));
  }
  if (hasDepth()) {
    info.format = depthFormat_;
    info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    info.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
    if (desc_.stencilMark) info.aspect |= VK_IMAGE_ASPECT_STENCIL_BIT;
    slot.depth = UsedImage(tool::GpuImage(gpu_, info, "points: depth"));
    slot.sampledDepth = depthOnlyView(gpu_, slot.depth.get());
  }
  slot.readback = tool::GpuBuffer(gpu_, std::uint64_t{desc_.width} * desc_.height * sizeof(FloatColor),
                                  VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Readback, "points: readback");
  return slot;
}

void PointHost::makeSlots() {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    slots_[i] = makeSlot();
    colorViews_[i] = slots_[i].color.get().view();
    if (multisampled()) opaqueViews_[i] = slots_[i].multisampled.get().view();
    if (hasDepth()) depthViews_[i] = slots_[i].sampledDepth.get();
  }
}

VitrailViews PointHost::views() {
  VitrailViews views{};
  views.count = kFramesTogether;
  if (desc_.resolve != VITRAIL_RESOLVE_FRAGMENT) views.color = colorViews_.data();
  if (multisampled() && !perSample()) views.opaque = opaqueViews_.data();
  if (multisampled() && !postDepthCoverage_) views.depth = depthViews_.data();
  return views;
}

VitrailTargetDesc PointHost::targetDesc() {
  VitrailTargetDesc desc{};
  desc.extent = {desc_.width, desc_.height};
  desc.samples = static_cast<VkSampleCountFlagBits>(desc_.samples);
  desc.nodeFormat = desc_.nodes;
  desc.depthOrder = desc_.depthOrder;
  desc.resolve = desc_.resolve;
  desc.msaaResolve = desc_.msaaResolve;
  desc.postDepthCoverage = postDepthCoverage_ ? VK_TRUE : VK_FALSE;
  desc.maxLayers = desc_.maxLayers;
  desc.overflow = desc_.overflow;
  desc.linking = desc_.linking;
  desc.nodeCapacity = desc_.capacity;
  desc.memoryBudget = desc_.memoryBudget;
  desc.areaPixels = desc_.areaPixels;
  desc.colorFormat = desc_.colorFormat;
  desc.views = views();
  desc.debugName = "points";
  const bool perPixel = multisampled() && !perSample();
  if (desc_.stencilMark && !perPixel) {
    desc.scope.stencilFormat = depthFormat_;
    desc.scope.stencilMark = VK_TRUE;
  }
  return desc;
}

void PointHost::createTarget(VitrailTargetDesc& desc) {
  if (desc_.guarded) {
    VitrailRequirements needs{};
    check(context_->targetRequirements(desc, needs), "vitrailTargetRequirements");
    guardBytes_ = (kGuardWords * sizeof(std::uint32_t) + needs.alignment - 1) / needs.alignment * needs.alignment;
    // Not in memory that the host can read: shaders do atomics in it, and some machines do not carry those there.
    memory_ = tool::GpuBuffer(gpu_, needs.size + 2 * guardBytes_, needs.usage, MemoryKind::Device, "points: memory");
    guards_ = tool::GpuBuffer(gpu_, 2 * guardBytes_, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Readback,
                              "points: guards");
    submitter_.run("guards", [&](VkCommandBuffer commands) {
      vkCmdFillBuffer(commands, memory_.get(), 0, VK_WHOLE_SIZE, kGuard);
      // Writer: the fill. Readers and writers: the library, first its clears.
      tool::cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                             {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT});
    });
    storage_ = layoutStorage(desc.extent.width * desc.extent.height, desc.nodeCapacity, desc.nodeFormat,
                             desc.overflow == VITRAIL_OVERFLOW_APPROXIMATE, needs.alignment);
    desc.buffer = memory_.get();
    desc.bufferOffset = guardBytes_;
  }
  check(Target::create(*context_, desc, target_), "vitrailCreateTarget");
}

PointPipelinesInfo PointHost::pipelinesInfo() const {
  PointPipelinesInfo info;
  info.set = context_->descriptorSetLayout();
  info.samples = static_cast<VkSampleCountFlagBits>(desc_.samples);
  info.colorFormat = desc_.colorFormat;
  info.depthFormat = depthFormat_;
  info.nearestIsOne = desc_.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
  info.postDepthCoverage = postDepthCoverage_;
  info.addresses = desc_.addresses;
  return info;
}

PointPipelinesInfo PointHost::specialized(PointPipelinesInfo info, const VitrailTargetDesc& desc) const {
  if (!desc_.specialized) return info;
  VitrailTargetDesc target = desc;
  target.nodeFormat = desc_.specializedFor.value_or(target.nodeFormat);
  target.overflow = desc_.specializedForOverflow.value_or(target.overflow);
  target.linking = desc_.specializedForLinking.value_or(target.linking);
  const VitrailSpecialization specialization = context_->collectSpecialization(target);
  info.specialized = true;
  info.firstConstant = specialization.entries[0].constantID;
  std::copy(std::begin(specialization.data), std::end(specialization.data), info.constants.begin());
  return info;
}

PointHost::Vertices PointHost::upload(std::span<const Point> points) const {
  Vertices vertices{points, tool::GpuBuffer(gpu_, points.size() * sizeof(PointVertex),
                                            VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, MemoryKind::Upload, "points: vertices")};
  auto* written = static_cast<PointVertex*>(vertices.buffer.mapped());
  for (const Point& point : points) *written++ = toVertex(point, desc_);
  return vertices;
}

// Fills the image that a per-pixel resolve writes.
void PointHost::recordClear(VkCommandBuffer commands, Slot& slot) const {
  slot.color.cmdUse(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorBlend);
  VkClearValue before{};
  std::copy(desc_.beforeResolve.begin(), desc_.beforeResolve.end(), before.color.float32);
  const auto color =
      attachment(slot.color, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR, before);
  beginScope(commands, slot.extent, &color, nullptr, nullptr);
  vkCmdEndRendering(commands);
}

// The opaque scene: one colour and one depth a sample.
void PointHost::recordOpaque(VkCommandBuffer commands, Slot& slot) {
  slot.color.forget();
  slot.multisampled.forget();
  slot.depth.forget();
  if (multisampled() && !perSample()) recordClear(commands, slot);
  UsedImage& drawn = multisampled() ? slot.multisampled : slot.color;
  // Writer: nobody that matters, the old picture is dropped. Writers after: the clear and the draws.
  drawn.cmdUse(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorBlend);
  if (hasDepth()) slot.depth.cmdUse(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, kDepthWrite);
  VkClearValue behind{};
  std::copy(desc_.behind.begin(), desc_.behind.end(), behind.color.float32);
  VkClearValue farthest{};
  farthest.depthStencil.depth = desc_.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? 0.0F : 1.0F;
  const auto color = attachment(drawn, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR, behind);
  VkRenderingAttachmentInfo depth{};
  if (hasDepth()) {
    depth =
        attachment(slot.depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR, farthest);
  }
  beginScope(commands, slot.extent, &color, hasDepth() ? &depth : nullptr, desc_.stencilMark ? &depth : nullptr);
  const bool differs = !desc_.behindSamples.empty() || !desc_.opaqueDepth.empty();
  for (std::uint32_t s = 0; differs && s < desc_.samples; ++s) {
    OpaqueConstants constants{};
    const FloatColor here = behindAt(desc_, s);
    std::copy(here.begin(), here.end(), constants.color);
    constants.depth = desc_.opaqueDepth.empty() ? farthest.depthStencil.depth : desc_.opaqueDepth.at(s);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines_->opaque(1U << s));
    vkCmdPushConstants(commands, pipelines_->opaqueLayout(), VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
                       0, sizeof(constants), &constants);
    vkCmdDraw(commands, 3, 1, 0, 0);
  }
  vkCmdEndRendering(commands);
}

// Points that follow each other and cover the same samples, strangers or not, are one draw.
void PointHost::recordPoints(VkCommandBuffer commands, Slot& slot, const Vertices& vertices) {
  VkRenderingAttachmentInfo depth{};
  if (hasDepth()) {
    // Writers: the opaque draws. Readers: the depth test; with a stencil, writers too.
    const VkImageLayout layout = desc_.stencilMark ? VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL
                                                   : VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    slot.depth.cmdUse(commands, layout, desc_.stencilMark ? kDepthWrite : kDepthTest);
    depth = attachment(slot.depth, layout, VK_ATTACHMENT_LOAD_OP_LOAD);
    depth.storeOp = VK_ATTACHMENT_STORE_OP_NONE;
  }
  VkRenderingAttachmentInfo stencil = depth;
  stencil.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  beginScope(commands, slot.extent, nullptr, hasDepth() ? &depth : nullptr, desc_.stencilMark ? &stencil : nullptr);
  const VkDescriptorSet set = target_.descriptorSet();
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines_->pointsLayout(), 0, 1, &set, 0,
                          nullptr);
  const VkBuffer buffer = vertices.buffer.get();
  const VkDeviceSize offset = 0;
  vkCmdBindVertexBuffers(commands, 0, 1, &buffer, &offset);
  const std::uint32_t all = (1U << desc_.samples) - 1U;
  const std::span<const Point> points = vertices.points;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t end = first + 1;
    const Point& point = points[first];
    const auto isAlike = [&](const Point& other) {
      return ((other.coverage ^ point.coverage) & all) == 0 && other.stranger == point.stranger;
    };
    while (end < points.size() && isAlike(points[end])) ++end;
    PointPipelines& pipelines = point.stranger ? *strangers_ : *pipelines_;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.points(point.coverage & all));
    vkCmdDraw(commands, static_cast<std::uint32_t>(end - first), 1, static_cast<std::uint32_t>(first), 0);
    first = end;
  }
  vkCmdEndRendering(commands);
}

// Begins the scope that a fragment resolve draws in.
void PointHost::recordResolveScope(VkCommandBuffer commands, Slot& slot) {
  UsedImage& drawn = perSample() ? slot.multisampled : slot.color;
  // Writers: the opaque draws, or the resolve of another area. Reader and writer: the resolve.
  drawn.cmdUse(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorBlend);
  const auto color = attachment(drawn, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD);
  const bool hasStencil = desc_.stencilMark && (!multisampled() || perSample());
  VkRenderingAttachmentInfo stencil{};
  if (hasStencil) {
    stencil = attachment(slot.depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD);
    stencil.storeOp = VK_ATTACHMENT_STORE_OP_NONE;
  }
  beginScope(commands, slot.extent, &color, nullptr, hasStencil ? &stencil : nullptr);
}

void PointHost::recordResolve(VkCommandBuffer commands, Slot& slot, std::uint32_t view) {
  const bool compute = desc_.resolve == VITRAIL_RESOLVE_COMPUTE;
  const VkPipelineStageFlags2 stage =
      compute ? VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT : VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  if (multisampled() && !perSample()) {
    // Writers: the opaque draws. Reader: the resolve.
    slot.multisampled.cmdUse(commands, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                             {stage, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
  }
  if (hasDepth()) {
    // Writers: the opaque draws and the stencil marks. Readers: the resolve and its stencil test.
    slot.depth.cmdUse(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                      {stage | kDepthTest.stages, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | kDepthTest.accesses});
  }
  if (compute) {
    // Writers: the opaque draws, or the resolve of another area. Reader and writer: the resolve.
    slot.color.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kComputeReadWrite);
    target_.resolve(commands, {view});
    return;
  }
  recordResolveScope(commands, slot);
  target_.resolve(commands, {view});
  vkCmdEndRendering(commands);
}

void PointHost::recordRequests(VkCommandBuffer commands) {
  constexpr Access kTransferWrite{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
  // Writer: the library's clear. Writer after: the fill; then the points.
  tool::cmdMemoryBarrier(commands, kTransferWrite, kTransferWrite);
  vkCmdFillBuffer(commands, memory_.get(),
                  guardBytes_ + storage_.control.offset + offsetof(layout::VitrailControl, requested),
                  sizeof(std::uint32_t), desc_.requestedBefore);
  tool::cmdMemoryBarrier(commands, kTransferWrite,
                         {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                          VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT});
}

void PointHost::recordFrame(VkCommandBuffer commands, std::uint64_t frame, Slot& slot, std::uint32_t view,
                            const VkRect2D& area, const Vertices& vertices) {
  target_.begin(commands, {frame, area});
  if (desc_.requestedBefore > 0) recordRequests(commands);
  if (!vertices.points.empty()) recordPoints(commands, slot, vertices);
  target_.collected(commands);
  recordResolve(commands, slot, view);
  target_.end(commands);
}

void PointHost::recordPicture(VkCommandBuffer commands, Slot& slot, bool perSample) {
  const VkImageSubresourceLayers layers{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  if (perSample) {
    // Writer: the resolve of the lists. Reader and writer: the box filter.
    slot.multisampled.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL,
                             {VK_PIPELINE_STAGE_2_RESOLVE_BIT, VK_ACCESS_2_TRANSFER_READ_BIT});
    slot.color.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL,
                      {VK_PIPELINE_STAGE_2_RESOLVE_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT});
    const VkImageResolve region{layers, {}, layers, {}, {slot.extent.width, slot.extent.height, 1}};
    vkCmdResolveImage(commands, slot.multisampled.get().get(), VK_IMAGE_LAYOUT_GENERAL, slot.color.get().get(),
                      VK_IMAGE_LAYOUT_GENERAL, 1, &region);
  }
  // Writer: the resolve. Reader: the copy.
  slot.color.cmdUse(commands, VK_IMAGE_LAYOUT_GENERAL, kCopyRead);
  VkBufferImageCopy copy{};
  copy.imageSubresource = layers;
  copy.imageExtent = {slot.extent.width, slot.extent.height, 1};
  vkCmdCopyImageToBuffer(commands, slot.color.get().get(), VK_IMAGE_LAYOUT_GENERAL, slot.readback.get(), 1, &copy);

  // Writers: the copy, and all shaders of the library, behind whose backs the guards are checked. Reader: the host.
  tool::cmdMemoryBarrier(
      commands,
      {VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
       VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
      {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

PointResult PointHost::read(const Slot& slot, std::uint64_t frame) const {
  PointResult result;
  check(target_.readStats(frame, result.stats), "vitrailReadStats");
  if (desc_.colorFormat == VK_FORMAT_R32G32B32A32_SFLOAT) {
    result.pixels.resize(std::size_t{slot.extent.width} * slot.extent.height);
    std::memcpy(result.pixels.data(), slot.readback.mapped(), result.pixels.size() * sizeof(FloatColor));
  }
  return result;
}

PointResult PointHost::draw(std::span<const Point> points) { return drawTogether({{points.begin(), points.end()}})[0]; }

// Pictures are read after the last frame, so that no barrier of this host stands between two frames.
std::vector<PointResult> PointHost::drawTogether(const std::vector<std::vector<Point>>& frames) {
  std::vector<Vertices> vertices;
  vertices.reserve(frames.size());
  for (const std::vector<Point>& points : frames) vertices.push_back(upload(points));
  const std::uint64_t first = frame_;
  frame_ += frames.size();
  check(target_.update(first), "vitrailUpdateTarget");
  submitter_.run("points", [&](VkCommandBuffer commands) {
    for (std::uint64_t frame = first; frame < frame_; ++frame) {
      recordOpaque(commands, slotOf(frame));
      recordFrame(commands, frame, slotOf(frame), static_cast<std::uint32_t>(frame % kFramesTogether), wholeArea(),
                  vertices[frame - first]);
    }
    for (std::uint64_t frame = first; frame < frame_; ++frame) recordPicture(commands, slotOf(frame), perSample());
  });
  std::vector<PointResult> results;
  for (std::uint64_t frame = first; frame < frame_; ++frame) results.push_back(read(slotOf(frame), frame));
  return results;
}

std::array<PointResult, 2> PointHost::drawAcrossResize(std::span<const Point> first, VkExtent2D extent,
                                                       std::span<const Point> second) {
  const std::uint64_t frame = frame_;
  frame_ += 2;
  const auto view = [](std::uint64_t of) { return static_cast<std::uint32_t>(of % kFramesTogether); };
  const Vertices before = upload(first);
  Vertices after;
  check(target_.update(frame), "vitrailUpdateTarget");
  submitter_.run("points across a resize", [&](VkCommandBuffer commands) {
    recordOpaque(commands, slotOf(frame));
    recordFrame(commands, frame, slotOf(frame), view(frame), wholeArea(), before);
    recordPicture(commands, slotOf(frame), perSample());
    for (Slot& slot : slots_) retired_.push_back(std::move(slot));
    desc_.width = extent.width;
    desc_.height = extent.height;
    makeSlots();
    check(target_.resize({frame + 1, extent, 0, views()}), "vitrailResizeTarget");
    after = upload(second);
    recordOpaque(commands, slotOf(frame + 1));
    recordFrame(commands, frame + 1, slotOf(frame + 1), view(frame + 1), wholeArea(), after);
    recordPicture(commands, slotOf(frame + 1), perSample());
  });
  std::array<PointResult, 2> results = {read(retired_[retired_.size() - kFramesTogether + view(frame)], frame),
                                        read(slotOf(frame + 1), frame + 1)};
  retired_.clear(); // the frames have finished
  return results;
}

PointResult PointHost::drawAreas(std::span<const Point> points, const NextArea& next) {
  const Vertices vertices = upload(points);
  Slot& slot = slots_[0];
  submitter_.run("opaque scene", [&](VkCommandBuffer commands) { recordOpaque(commands, slot); });
  VitrailStats stats{};
  VkRect2D area{};
  for (bool more = next(nullptr, area); more; more = next(&stats, area)) {
    const std::uint64_t frame = frame_++;
    submitter_.run("points of an area",
                   [&](VkCommandBuffer commands) { recordFrame(commands, frame, slot, 0, area, vertices); });
    check(target_.readStats(frame, stats), "vitrailReadStats");
  }
  submitter_.run("picture", [&](VkCommandBuffer commands) { recordPicture(commands, slot, perSample()); });
  return read(slot, stats.frame);
}

void PointHost::scatterNodes() {
  if (storage_.total == 0 || desc_.nodes != VITRAIL_NODE_STANDARD || multisampled()) {
    throw std::logic_error("drawScattered: needs a guarded host of standard nodes and one sample");
  }
  const VkBufferCopy out{guardBytes_, 0, storage_.total};
  const VkBufferCopy back{0, guardBytes_, storage_.total};
  tool::GpuBuffer copy(gpu_, storage_.total, VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                       MemoryKind::Readback, "points: nodes");
  submitter_.run("nodes to the host", [&](VkCommandBuffer commands) {
    vkCmdCopyBuffer(commands, memory_.get(), copy.get(), 1, &out);
    // Writer: the copy. Reader and writer: the host.
    tool::cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                           {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT});
  });

  auto* bytes = static_cast<std::byte*>(copy.mapped());
  const std::uint32_t capacity = desc_.capacity;
  const std::span heads(reinterpret_cast<std::uint32_t*>(bytes + storage_.heads.offset),
                        std::size_t{desc_.width} * desc_.height);
  const std::span nodes(reinterpret_cast<layout::VitrailNodeStandard*>(bytes + storage_.nodes.offset), capacity);
  const std::span links(reinterpret_cast<std::uint32_t*>(nodes.data() + capacity), capacity);
  std::vector<std::uint32_t> place(capacity); // of each node
  std::iota(place.begin(), place.end(), 0U);
  std::shuffle(place.begin(), place.end(), std::mt19937(1));
  const auto moved = [&](std::uint32_t index) { return index < capacity ? place[index] : index; };
  const std::vector<layout::VitrailNodeStandard> oldNodes(nodes.begin(), nodes.end());
  const std::vector<std::uint32_t> oldLinks(links.begin(), links.end());
  const bool linked = desc_.linking == VITRAIL_LINKING_FRAGMENT; // else no node names another one yet
  for (std::uint32_t& head : heads) head = moved(head);
  for (std::uint32_t i = 0; i < capacity; ++i) {
    nodes[place[i]] = oldNodes[i];
    links[place[i]] = linked ? moved(oldLinks[i]) : oldLinks[i];
  }

  submitter_.run("nodes to the device", [&](VkCommandBuffer commands) {
    vkCmdCopyBuffer(commands, copy.get(), memory_.get(), 1, &back);
    // Writer: the copy. Reader and writer: the resolve.
    tool::cmdMemoryBarrier(
        commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
        {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT});
  });
}

PointResult PointHost::drawScattered(std::span<const Point> points) {
  const Vertices vertices = upload(points);
  const std::uint64_t frame = frame_++;
  Slot& slot = slotOf(frame);
  submitter_.run("points", [&](VkCommandBuffer commands) {
    recordOpaque(commands, slot);
    target_.begin(commands, {frame, wholeArea()});
    recordPoints(commands, slot, vertices);
    // Writers: the points. Reader: the copy.
    tool::cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                           {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT});
  });
  scatterNodes();
  submitter_.run("the rest of the frame", [&](VkCommandBuffer commands) {
    target_.collected(commands);
    recordResolve(commands, slot, static_cast<std::uint32_t>(frame % kFramesTogether));
    target_.end(commands);
    recordPicture(commands, slot, perSample());
  });
  return read(slot, frame);
}

void PointHost::drop(std::span<const Point> points) {
  const Vertices vertices = upload(points);
  const std::uint64_t frame = frame_++;
  check(target_.update(frame), "vitrailUpdateTarget");
  VkCommandBuffer commands = submitter_.begin();
  recordOpaque(commands, slotOf(frame));
  recordFrame(commands, frame, slotOf(frame), static_cast<std::uint32_t>(frame % kFramesTogether), wholeArea(),
              vertices);
}

std::vector<std::uint32_t> PointHost::words(StoragePart StorageLayout::*part) {
  const StoragePart from = storage_.*part;
  const tool::GpuBuffer copy(gpu_, from.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::Readback, "points: words");
  submitter_.run("words", [&](VkCommandBuffer commands) {
    const VkBufferCopy region{guardBytes_ + from.offset, 0, from.size};
    vkCmdCopyBuffer(commands, memory_.get(), copy.get(), 1, &region);
    // Writer: the copy. Reader: the host.
    tool::cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                           {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
  });
  const auto* first = static_cast<const std::uint32_t*>(copy.mapped());
  return {first, first + from.size / sizeof(std::uint32_t)};
}

bool PointHost::guardsUntouched() {
  const std::array<VkBufferCopy, 2> regions = {VkBufferCopy{0, 0, guardBytes_},
                                               VkBufferCopy{memory_.size() - guardBytes_, guardBytes_, guardBytes_}};
  submitter_.run("guards", [&](VkCommandBuffer commands) {
    vkCmdCopyBuffer(commands, memory_.get(), guards_.get(), static_cast<std::uint32_t>(regions.size()), regions.data());
    // Writer: the copy. Reader: the host.
    tool::cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                           {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
  });
  const auto* words = static_cast<const std::uint32_t*>(guards_.mapped());
  return std::all_of(words, words + 2 * guardBytes_ / sizeof(std::uint32_t),
                     [](std::uint32_t word) { return word == kGuard; });
}

} // namespace vitrail::tests
