#include "point_host.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstring>

namespace vitrail::tests::vulkan {

namespace {

// What the library's shaders do to its memory.
constexpr Access kShaders{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                          VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};

// The clip-space vertex whose point covers the pixel's centre.
PointVertex toVertex(const Point& point, const HostDesc& desc) {
  const auto clip = [](std::uint32_t pixel, std::uint32_t size) {
    return (static_cast<float>(pixel) + 0.5F) * 2.0F / static_cast<float>(size) - 1.0F;
  };
  return {{clip(point.x, desc.width), clip(point.y, desc.height), point.depth}, point.color, point.blend, point.word};
}

std::uint32_t featureBits(VulkanBackend& backend, const HostDesc& desc) {
  std::uint32_t features = backend.allFeatures();
  if (desc.addresses) features |= VITRAIL_VK_FEATURE_BUFFER_DEVICE_ADDRESS;
  if (!desc.dualSourceBlending) features &= ~std::uint32_t{VITRAIL_VK_FEATURE_DUAL_SRC_BLEND};
  return features;
}

bool severalSamples(const HostDesc& desc) { return desc.samples > 1; }

bool perPixel(const HostDesc& desc) {
  return severalSamples(desc) && desc.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_PIXEL;
}

// What the library copied out.
void decodeCopy(const Buffer& copy, std::uint32_t pixels, ListsRead& read) {
  const auto* bytes = static_cast<const std::byte*>(copy.mapped());
  VitrailVkCopyHeader header{};
  std::memcpy(&header, bytes, sizeof(header));
  read.layers = header.layers;
  std::vector<VitrailVkCopiedList> lists(pixels);
  std::memcpy(lists.data(), bytes + sizeof(header), pixels * sizeof(VitrailVkCopiedList));
  const std::byte* layers = bytes + sizeof(header) + pixels * sizeof(VitrailVkCopiedList);
  for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const VitrailVkCopiedList& list = lists[pixel];
    if (list.count == 0) read.pixels[pixel].emplace();
    if (list.count == 0 || list.first == 0xffffffffU) continue;
    std::vector<VitrailLayer>& copied = read.pixels[pixel].emplace(list.count);
    std::memcpy(copied.data(), layers + list.first * sizeof(VitrailLayer), list.count * sizeof(VitrailLayer));
  }
}

} // namespace

VulkanHost::VulkanHost(VulkanBackend& backend, const HostDesc& desc, const VulkanOptions& options)
    : backend_(backend),
      device_(backend.device()),
      desc_(desc),
      options_(options),
      postDepthCoverage_(severalSamples(desc) && desc.postDepthCoverage && device_.features().postDepthCoverage),
      context_(&backend.context(featureBits(backend, desc))),
      commands_(device_) {
  makeImages();
  VitrailVkTargetDesc target = targetDesc();
  if (desc.guarded) guard(target);
  const VkResult result = Target::create(*context_, target, target_);
  if (result != VK_SUCCESS) {
    std::string reason = "vitrailVkCreateTarget: VkResult " + std::to_string(result);
    for (const LogLine& line : backend.takeLog()) reason += ": " + line.text;
    throw HostError(reason);
  }
  pipelines_ = &pipelinesFor(target, desc.specialized);
  if (!desc.strangersFor) return;
  target.overflow = *desc.strangersFor;
  strangers_ = &pipelinesFor(target, true);
}

void VulkanHost::makeImages() {
  for (std::size_t i = 0; i < images_.size(); ++i) {
    images_[i] = PointImages(device_, desc_);
    colorViews_[i] = images_[i].color();
    opaqueViews_[i] = images_[i].multisampled();
    depthViews_[i] = images_[i].depth();
  }
}

VitrailVkViews VulkanHost::views() {
  VitrailVkViews views{};
  if (desc_.resolve == VITRAIL_RESOLVE_HOST) return views;
  if (desc_.resolve != VITRAIL_RESOLVE_FRAGMENT) views.color = colorViews_.data();
  if (perPixel(desc_)) views.opaque = opaqueViews_.data();
  if (severalSamples(desc_) && !postDepthCoverage_) views.depth = depthViews_.data();
  const bool any = views.color != nullptr || views.opaque != nullptr || views.depth != nullptr;
  views.count = any ? kFramesTogether : 0;
  return views;
}

VitrailVkTargetDesc VulkanHost::targetDesc() {
  VitrailVkTargetDesc desc{};
  desc.extent = {desc_.width, desc_.height};
  desc.samples = static_cast<VkSampleCountFlagBits>(desc_.samples);
  desc.nodeFormat = desc_.nodes;
  desc.depthOrder = desc_.depthOrder;
  desc.resolve = desc_.resolve;
  desc.msaaResolve = desc_.msaaResolve;
  desc.postDepthCoverage = postDepthCoverage_ ? VK_TRUE : VK_FALSE;
  desc.maxLayers = desc_.maxLayers;
  desc.overflow = desc_.overflow;
  desc.listBuild = desc_.listBuild;
  desc.nodeCapacity = desc_.capacity;
  desc.memoryBudget = desc_.memoryBudget;
  desc.areaPixels = desc_.areaPixels;
  desc.userWords = desc_.userWords ? VK_TRUE : VK_FALSE;
  desc.copyLayers = desc_.copyLayers;
  desc.colorFormat = PointImages::colorFormat(desc_);
  desc.views = views();
  desc.hostBarriers = options_.hostBarriers ? VK_TRUE : VK_FALSE;
  desc.framesInFlight = options_.framesInFlight;
  desc.debugName = "points";
  if (desc_.stencilMark && !perPixel(desc_)) {
    desc.scope.stencilFormat = PointImages::depthFormat(desc_);
    desc.scope.stencilMark = VK_TRUE;
  }
  return desc;
}

// Makes the target's memory, between guard words and full of them.
void VulkanHost::guard(VitrailVkTargetDesc& desc) {
  VitrailVkRequirements needs{};
  check(context_->targetRequirements(desc, needs), "vitrailVkTargetRequirements");
  guardBytes_ = (kGuardWords * sizeof(std::uint32_t) + needs.alignment - 1) / needs.alignment * needs.alignment;
  // Not in memory that the host can read: shaders do atomics in it, and some machines do not carry those there.
  memory_ = Buffer(device_, needs.size + 2 * guardBytes_, needs.usage, Memory::Device);
  commands_.run([&](VkCommandBuffer commands) {
    vkCmdFillBuffer(commands, memory_.get(), 0, VK_WHOLE_SIZE, kGuard);
    // Writer: the fill. Readers and writers: the library, first its clears.
    cmdBarrier(commands, kTransferWrite, kTransferWrite);
  });
  storage_ = layoutOf(desc_, needs.alignment);
  desc.buffer = memory_.get();
  desc.bufferOffset = guardBytes_;
  desc.bufferSize = needs.size;
}

// The pipelines of points for a target, or for what HostDesc says in its place.
PointPipelines& VulkanHost::pipelinesFor(VitrailVkTargetDesc target, bool specialized) {
  PointPipelinesInfo info;
  info.set = context_->descriptorSetLayout();
  info.samples = static_cast<VkSampleCountFlagBits>(desc_.samples);
  info.colorFormat = PointImages::colorFormat(desc_);
  info.depthFormat = PointImages::depthFormat(desc_);
  info.nearestIsOne = desc_.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
  info.postDepthCoverage = desc_.shaderPostDepth.value_or(postDepthCoverage_);
  info.addresses = desc_.shaderByAddress.value_or(desc_.addresses);
  info.shader = desc_.shader;
  if (specialized) {
    target.nodeFormat = desc_.specializedFor.value_or(target.nodeFormat);
    target.overflow = desc_.specializedForOverflow.value_or(target.overflow);
    target.listBuild = desc_.specializedForListBuild.value_or(target.listBuild);
    const VitrailVkSpecialization constants = context_->collectSpecialization(target);
    info.specialized = true;
    info.firstConstant = constants.entries[0].constantID;
    std::copy_n(std::begin(constants.data), constants.count, info.constants.begin());
  }
  return backend_.pipelines(info);
}

VulkanHost::Vertices VulkanHost::upload(std::span<const Point> points) const {
  Vertices vertices{
      points, Buffer(device_, points.size() * sizeof(PointVertex), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, Memory::Host)};
  auto* written = static_cast<PointVertex*>(vertices.buffer.mapped());
  for (const Point& point : points) *written++ = toVertex(point, desc_);
  return vertices;
}

// Points that follow each other and cover the same samples, strangers or not, are one draw.
void VulkanHost::recordPoints(VkCommandBuffer commands, PointImages& images, const Vertices& vertices) {
  images.cmdBeginPoints(commands);
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

void VulkanHost::recordRequests(VkCommandBuffer commands) {
  // Writer: the library's clear. Writer after: the fill; then the points.
  cmdBarrier(commands, kTransferWrite, kTransferWrite);
  vkCmdFillBuffer(commands, memory_.get(),
                  guardBytes_ + storage_.control.offset + offsetof(layout::VitrailControl, requested),
                  sizeof(std::uint32_t), desc_.requestedBefore);
  cmdBarrier(commands, kTransferWrite, kShaders);
}

void VulkanHost::recordResolve(VkCommandBuffer commands, PointImages& images, std::uint64_t view) {
  VitrailVkResolveInfo info{};
  if (views().count > 0) info.view = static_cast<std::uint32_t>(view);
  cmdHostBarrier(commands, VITRAIL_VK_BARRIER_RESOLVE);
  images.cmdToResolve(commands);
  target_.resolve(commands, info);
  if (desc_.resolve == VITRAIL_RESOLVE_FRAGMENT) vkCmdEndRendering(commands);
}

// What the target asks its host to wait for at a point.
void VulkanHost::cmdHostBarrier(VkCommandBuffer commands, VitrailVkBarrierPoint point) const {
  if (!options_.hostBarriers || options_.omitted == point) return;
  const VitrailVkBarriers barriers = target_.barriers(point);
  if (barriers.count == 0) return;
  vkCmdPipelineBarrier(commands, barriers.source, barriers.destination, 0, 0, nullptr, barriers.count, barriers.buffers,
                       0, nullptr);
}

void VulkanHost::recordBegin(VkCommandBuffer commands, std::uint64_t frame, const VkRect2D& area) {
  VitrailVkBeginInfo info{};
  info.frame = desc_.numbersFrames ? frame : 0;
  info.area = area;
  cmdHostBarrier(commands, VITRAIL_VK_BARRIER_BEGIN);
  target_.begin(commands, info);
  if (desc_.requestedBefore > 0) recordRequests(commands);
  cmdHostBarrier(commands, VITRAIL_VK_BARRIER_COLLECT);
}

void VulkanHost::recordCollected(VkCommandBuffer commands) {
  cmdHostBarrier(commands, VITRAIL_VK_BARRIER_COLLECTED);
  target_.collected(commands);
}

void VulkanHost::recordEnd(VkCommandBuffer commands) {
  cmdHostBarrier(commands, VITRAIL_VK_BARRIER_END);
  target_.end(commands);
}

void VulkanHost::recordFrame(VkCommandBuffer commands, std::uint64_t frame, PointImages& images, const VkRect2D& area,
                             const Vertices& vertices) {
  recordBegin(commands, frame, area);
  if (!vertices.points.empty()) recordPoints(commands, images, vertices);
  recordCollected(commands);
  recordResolve(commands, images, static_cast<std::uint64_t>(&images - images_.data()));
  recordEnd(commands);
}

PointResult VulkanHost::read(const PointImages& images, std::uint64_t frame) const {
  const std::optional<VitrailStats> counted = stats(frame);
  if (!counted) throw HostError("the statistics of frame " + std::to_string(frame) + " are not there");
  return {images.pixels(), *counted};
}

std::optional<VitrailStats> VulkanHost::stats(std::uint64_t frame) const {
  VitrailStats stats{};
  const VkResult result = target_.readStats(frame, stats);
  check(result, "vitrailVkReadStats");
  if (result == VK_NOT_READY) return {};
  return stats;
}

// Pictures are read after the last frame, so that no barrier of this host stands between two frames.
std::vector<PointResult> VulkanHost::drawTogether(const std::vector<std::vector<Point>>& frames) {
  std::vector<Vertices> vertices;
  vertices.reserve(frames.size());
  for (const std::vector<Point>& points : frames) vertices.push_back(upload(points));
  const std::uint64_t first = frame_;
  frame_ += frames.size();
  update(first);
  commands_.run([&](VkCommandBuffer commands) {
    for (std::uint64_t frame = first; frame < frame_; ++frame) {
      imagesOf(frame).cmdOpaque(commands, *pipelines_);
      recordFrame(commands, frame, imagesOf(frame), wholeArea(), vertices[frame - first]);
    }
    for (std::uint64_t frame = first; frame < frame_; ++frame) imagesOf(frame).cmdPicture(commands);
  });
  std::vector<PointResult> results;
  for (std::uint64_t frame = first; frame < frame_; ++frame) results.push_back(read(imagesOf(frame), frame));
  return results;
}

void VulkanHost::update(std::uint64_t frame) {
  if (options_.update) check(target_.update(desc_.numbersFrames ? frame : 0), "vitrailVkUpdateTarget");
}

void VulkanHost::resize(Extent extent, std::uint32_t capacity) {
  desc_.width = extent.width;
  desc_.height = extent.height;
  makeImages();
  VitrailVkResizeInfo resize{};
  resize.extent = {extent.width, extent.height};
  resize.nodeCapacity = capacity;
  resize.views = views();
  check(target_.resize(resize), "vitrailVkResizeTarget");
}

std::array<PointResult, 2> VulkanHost::drawAcrossResize(std::span<const Point> first, Extent extent,
                                                        std::span<const Point> second, std::uint32_t capacity) {
  const std::uint64_t frame = frame_;
  frame_ += 2;
  std::array<PointImages, kFramesTogether> old;
  const Vertices before = upload(first);
  Vertices after;
  update(frame);
  commands_.run([&](VkCommandBuffer commands) {
    imagesOf(frame).cmdOpaque(commands, *pipelines_);
    recordFrame(commands, frame, imagesOf(frame), wholeArea(), before);
    imagesOf(frame).cmdPicture(commands);
    std::swap(old, images_);
    resize(extent, capacity);
    after = upload(second);
    imagesOf(frame + 1).cmdOpaque(commands, *pipelines_);
    recordFrame(commands, frame + 1, imagesOf(frame + 1), wholeArea(), after);
    imagesOf(frame + 1).cmdPicture(commands);
  });
  return {read(old[frame % kFramesTogether], frame), read(imagesOf(frame + 1), frame + 1)};
}

class VulkanHost::Calls : public FrameCalls {
 public:
  Calls(VulkanHost& host, PointImages& images, VkCommandBuffer commands)
      : host_(host), images_(images), commands_(commands) {}

  void begin(const VitrailRect& area) override {
    begun = host_.frame_++;
    host_.recordBegin(commands_, *begun, toVk(area));
  }
  void draw(std::span<const Point> points) override {
    if (points.empty()) return;
    vertices_.push_back(host_.upload(points));
    host_.recordPoints(commands_, images_, vertices_.back());
  }
  void collected() override { host_.recordCollected(commands_); }
  void copyLists(const CopyAttempt& attempt) override {
    if (copied_.size() == 0) {
      copied_ = Buffer(host_.device_, host_.target_.copySize(4, 4), VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::Host);
      std::memset(copied_.mapped(), kUntouched, copied_.size());
    }
    VitrailVkCopyInfo info{};
    info.area = toVk(attempt.area);
    if (attempt.hasBuffer) info.buffer = copied_.get();
    info.offset = attempt.offset;
    info.size = attempt.size.value_or(copied_.size() - attempt.offset);
    host_.target_.copyLists(commands_, info);
  }
  void resolve(std::optional<std::uint32_t> view) override {
    const auto own = static_cast<std::uint64_t>(&images_ - host_.images_.data());
    host_.recordResolve(commands_, images_, view ? *view : own);
  }
  void end() override { host_.recordEnd(commands_); }
  void resize() override {
    VitrailVkResizeInfo info{};
    info.extent = {host_.desc_.width, host_.desc_.height};
    info.views = host_.views();
    check(host_.target_.resize(info), "vitrailVkResizeTarget");
  }

  [[nodiscard]] bool hasCopied() const {
    const auto* bytes = static_cast<const std::uint8_t*>(copied_.mapped());
    return std::any_of(bytes, bytes + copied_.size(), [](std::uint8_t byte) { return byte != kUntouched; });
  }

  std::optional<std::uint64_t> begun;

 private:
  static constexpr std::uint8_t kUntouched = 0x5a;
  static VkRect2D toVk(const VitrailRect& area) {
    return {{static_cast<std::int32_t>(area.x), static_cast<std::int32_t>(area.y)}, {area.width, area.height}};
  }

  VulkanHost& host_;
  PointImages& images_;
  VkCommandBuffer commands_;
  std::vector<Vertices> vertices_;
  Buffer copied_;
};

CallsResult VulkanHost::drawCalls(const std::function<void(FrameCalls&)>& make) {
  PointImages& images = imagesOf(frame_);
  std::optional<Calls> calls;
  commands_.run([&](VkCommandBuffer commands) {
    images.cmdOpaque(commands, *pipelines_);
    make(calls.emplace(*this, images, commands));
    images.cmdPicture(commands);
  });
  return {images.pixels(), calls->begun ? stats(*calls->begun) : std::nullopt, calls->hasCopied()};
}

double VulkanHost::seconds(std::span<const Point> points) {
  const Vertices vertices = upload(points);
  const std::uint64_t frame = frame_++;
  recordFrame(commands_.begin(), frame, imagesOf(frame), wholeArea(), vertices);
  const auto start = std::chrono::steady_clock::now();
  commands_.execute();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

PointResult VulkanHost::drawAreas(std::span<const Point> points, const NextArea& next) {
  const Vertices vertices = upload(points);
  PointImages& images = images_[0];
  commands_.run([&](VkCommandBuffer commands) { images.cmdOpaque(commands, *pipelines_); });
  VitrailStats stats{};
  VitrailRect area{};
  for (bool more = next(nullptr, area); more; more = next(&stats, area)) {
    const std::uint64_t frame = frame_++;
    const VkRect2D part = {{static_cast<std::int32_t>(area.x), static_cast<std::int32_t>(area.y)},
                           {area.width, area.height}};
    commands_.run([&](VkCommandBuffer commands) { recordFrame(commands, frame, images, part, vertices); });
    stats = read(images, frame).stats;
  }
  commands_.run([&](VkCommandBuffer commands) { images.cmdPicture(commands); });
  return {images.pixels(), stats};
}

void VulkanHost::scatter() {
  const Buffer copy(device_, storage_.total, VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                    Memory::Host);
  commands_.run([&](VkCommandBuffer commands) {
    const VkBufferCopy out{guardBytes_, 0, storage_.total};
    vkCmdCopyBuffer(commands, memory_.get(), copy.get(), 1, &out);
    // Writer: the copy. Reader and writer: the host.
    cmdBarrier(commands, kCopyWrite, kHostAccess);
  });
  scatterNodes(desc_, storage_, {static_cast<std::byte*>(copy.mapped()), storage_.total});
  commands_.run([&](VkCommandBuffer commands) {
    const VkBufferCopy back{0, guardBytes_, storage_.total};
    vkCmdCopyBuffer(commands, copy.get(), memory_.get(), 1, &back);
    // Writer: the copy. Reader and writer: the resolve.
    cmdBarrier(commands, kCopyWrite,
               {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT});
  });
}

PointResult VulkanHost::drawScattered(std::span<const Point> points) {
  const Vertices vertices = upload(points);
  const std::uint64_t frame = frame_++;
  PointImages& images = imagesOf(frame);
  commands_.run([&](VkCommandBuffer commands) {
    images.cmdOpaque(commands, *pipelines_);
    recordBegin(commands, frame, wholeArea());
    recordPoints(commands, images, vertices);
    // Writers: the points. Reader: the copy.
    cmdBarrier(commands, kShaders, kCopyRead);
  });
  scatter();
  commands_.run([&](VkCommandBuffer commands) {
    recordCollected(commands);
    recordResolve(commands, images, frame % kFramesTogether);
    recordEnd(commands);
    images.cmdPicture(commands);
  });
  return read(images, frame);
}

// By the walker where there is one, else by the library's copy.
void VulkanHost::recordRead(VkCommandBuffer commands, const VitrailRect& area, ListWalker* walker, const Buffer& copy) {
  if (walker != nullptr) {
    // Writers: the points, and who builds and sorts lists. Reader: the walk.
    cmdBarrier(commands, {kShaders.stages, VK_ACCESS_2_SHADER_WRITE_BIT},
               {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT});
    walker->cmdWalk(commands, target_.descriptorSet(), area);
    // Reader: the walk. Writer: a resolve, which relinks long lists.
    cmdBarrier(commands, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_NONE},
               {kShaders.stages, VK_ACCESS_2_NONE});
    return;
  }
  VitrailVkCopyInfo info{};
  info.area = {{static_cast<std::int32_t>(area.x), static_cast<std::int32_t>(area.y)}, {area.width, area.height}};
  info.buffer = copy.get();
  info.size = copy.size();
  target_.copyLists(commands, info);
  // Writer: the library's copy. Reader: the host.
  cmdBarrier(commands, kTransferWrite, kHostAccess);
}

ListsRead VulkanHost::drawAndRead(std::span<const Point> points, const VitrailRect& area, ReadBy by,
                                  bool afterResolve) {
  const Vertices vertices = upload(points);
  const std::uint64_t frame = frame_++;
  PointImages& images = imagesOf(frame);
  ListWalker* walker = nullptr;
  Buffer copy;
  if (by == ReadBy::Shader) {
    walker = &backend_.walker(*context_, {desc_.addresses, desc_.resolve == VITRAIL_RESOLVE_HOST});
  } else {
    copy = Buffer(device_, target_.copySize(area.width, area.height), VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::Host);
  }
  const auto read = [&](VkCommandBuffer commands) { recordRead(commands, area, walker, copy); };
  update(frame);
  commands_.run([&](VkCommandBuffer commands) {
    images.cmdOpaque(commands, *pipelines_);
    recordBegin(commands, frame, wholeArea());
    recordPoints(commands, images, vertices);
    recordCollected(commands);
    if (!afterResolve) read(commands);
    recordResolve(commands, images, frame % kFramesTogether);
    if (afterResolve) read(commands);
    recordEnd(commands);
    images.cmdPicture(commands);
  });
  ListsRead result;
  result.frame = VulkanHost::read(images, frame);
  result.pixels.resize(std::size_t{area.width} * area.height);
  if (walker != nullptr) {
    result.pixels = walker->read();
  } else {
    decodeCopy(copy, area.width * area.height, result);
  }
  return result;
}

void VulkanHost::drop(std::span<const Point> points) {
  const Vertices vertices = upload(points);
  const std::uint64_t frame = frame_++;
  update(frame);
  VkCommandBuffer commands = commands_.begin();
  imagesOf(frame).cmdOpaque(commands, *pipelines_);
  recordFrame(commands, frame, imagesOf(frame), wholeArea(), vertices);
}

std::vector<std::uint32_t> VulkanHost::wordsAt(VkDeviceSize offset, VkDeviceSize size) {
  const Buffer copy(device_, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::Host);
  commands_.run([&](VkCommandBuffer commands) {
    // Writers: the library's shaders. Reader: the copy.
    cmdBarrier(commands, kShaders, kCopyRead);
    const VkBufferCopy region{offset, 0, size};
    vkCmdCopyBuffer(commands, memory_.get(), copy.get(), 1, &region);
    // Writer: the copy. Reader: the host.
    cmdBarrier(commands, kCopyWrite, kHostAccess);
  });
  const auto* first = static_cast<const std::uint32_t*>(copy.mapped());
  return {first, first + size / sizeof(std::uint32_t)};
}

std::vector<std::uint32_t> VulkanHost::words(StoragePart StorageLayout::*part) {
  return wordsAt(guardBytes_ + (storage_.*part).offset, (storage_.*part).size);
}

bool VulkanHost::guardsUntouched() {
  std::vector<std::uint32_t> guards = wordsAt(0, guardBytes_);
  const std::vector<std::uint32_t> behind = wordsAt(memory_.size() - guardBytes_, guardBytes_);
  guards.insert(guards.end(), behind.begin(), behind.end());
  return std::all_of(guards.begin(), guards.end(), [](std::uint32_t word) { return word == kGuard; });
}

} // namespace vitrail::tests::vulkan
