#include "linked_list.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "../draw/vk.h"
#include "shaders/collect.frag.h"

namespace vitrail::tool {

namespace {

constexpr VitrailNodeFormat kFormat = VITRAIL_NODE_STANDARD;

// The first guess where nobody fixed the pool: most models that are looked at have fewer fragments than this a pixel
// of the whole picture.
constexpr std::uint64_t kNodesPerPixel = 4;
constexpr std::uint64_t kLargestGuess = std::uint64_t{1} << 24U;

void remember(VitrailLogSeverity severity, const char* message, void* reason) {
  if (severity == VITRAIL_LOG_ERROR) *static_cast<std::string*>(reason) = message;
}

// A device's name without the parenthesis that drivers append.
std::string shortName(const Gpu& gpu) {
  const std::string name = gpu.properties().deviceName;
  return name.substr(0, name.find(" ("));
}

// In units that a person reads: 950, 13.2 K, 151 M.
std::string shortCount(std::uint64_t count) {
  double value = static_cast<double>(count);
  const char* unit = "";
  for (const char* next : {" K", " M", " G"}) {
    if (value < 1000.0) break;
    value /= 1000.0;
    unit = next;
  }
  return value < 100.0 && *unit != '\0' ? fmt::format("{:.1f}{}", value, unit) : fmt::format("{:.0f}{}", value, unit);
}

std::uint64_t mebibytes(std::uint64_t bytes) { return (bytes + (1U << 19U)) >> 20U; }

} // namespace

LinkedList::LinkedList(Gpu& gpu) : gpu_(gpu) {
  VitrailContextDesc desc{};
  desc.instance = gpu.instance();
  desc.physicalDevice = gpu.physicalDevice();
  desc.device = gpu.device();
  desc.getInstanceProcAddr = vkGetInstanceProcAddr;
  desc.log = remember;
  desc.logUser = &reason_;
  check(Context::create(desc, context_), "vitrailCreateContext");
}

LinkedList::~LinkedList() { gpu_.memoryFreed(counted_); }

std::span<const std::uint32_t> LinkedList::collectShader() const { return shaders::collect_frag; }

void LinkedList::setTarget(const MethodTarget& target) {
  const bool same = target_ && target.color == wanted_.color && target.nodeCapacity == wanted_.nodeCapacity &&
                    target.extent.width == wanted_.extent.width && target.extent.height == wanted_.extent.height;
  if (same) return;
  wanted_ = target;
  const std::uint32_t largest = context_.maxNodeCapacity(kFormat);
  const std::uint64_t pixels = std::uint64_t{target.extent.width} * target.extent.height;
  const std::uint64_t guess = std::min<std::uint64_t>({kNodesPerPixel * pixels, kLargestGuess, largest});
  createTarget(target.nodeCapacity.value_or(static_cast<std::uint32_t>(guess)));
}

void LinkedList::createTarget(std::uint32_t nodeCapacity) {
  releaseTarget(); // first: the old pool and the new one need not fit together
  VitrailTargetDesc desc{};
  desc.extent = wanted_.extent;
  desc.nodeFormat = kFormat;
  desc.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
  desc.nodeCapacity = nodeCapacity;
  desc.colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  desc.colorViewCount = 1;
  desc.colorViews = &wanted_.color;
  desc.framesInFlight = 1;
  check(Target::create(context_, desc, target_), "vitrailCreateTarget");
  const VitrailMemory memory = target_.memory();
  counted_ = memory.nodeBytes + memory.headBytes + memory.otherBytes;
  gpu_.memoryAllocated(counted_);
}

void LinkedList::releaseTarget() {
  target_ = Target();
  gpu_.memoryFreed(std::exchange(counted_, 0));
}

void LinkedList::cmdClear(VkCommandBuffer commands, std::uint64_t frame) { target_.begin(commands, {frame}); }

MethodStats LinkedList::stats(std::uint64_t frame) const {
  VitrailStats stats{};
  check(target_.readStats(frame, stats), "vitrailReadStats");
  const VitrailMemory memory = target_.memory();
  MethodStats result;
  result.exact = stats.exact != 0;
  result.fragmentsRequested = stats.fragmentsRequested;
  result.fragmentsStored = stats.fragmentsStored;
  result.fragmentsMissing = stats.fragmentsMissing;
  result.cutPixels = stats.cutPixels;
  result.layersMax = stats.layersMax;
  result.layersMean = stats.coveredPixels > 0
                          ? static_cast<double>(stats.fragmentsStored) / static_cast<double>(stats.coveredPixels)
                          : 0.0;
  result.nodesBytes = memory.nodeBytes;
  result.headsBytes = memory.headBytes;
  return result;
}

bool LinkedList::grow(const MethodStats& stats) {
  if (wanted_.nodeCapacity) return false;
  const std::uint32_t largest = context_.maxNodeCapacity(kFormat);
  if (stats.fragmentsRequested > largest) {
    const std::uint64_t nodeBytes = vitrailNodePoolSize(kFormat, 1);
    throw GpuError(fmt::format(
        "the picture needs {} fragments ({} MiB of nodes); {} can bind at most {} MiB at once: use a smaller --size",
        shortCount(stats.fragmentsRequested), mebibytes(stats.fragmentsRequested * nodeBytes), shortName(gpu_),
        mebibytes(largest * nodeBytes)));
  }
  createTarget(static_cast<std::uint32_t>(stats.fragmentsRequested));
  return true;
}

void LinkedList::check(VkResult result, const char* call) const {
  if (result == VK_SUCCESS) return;
  const std::string reason = reason_.empty() ? fmt::format("{} failed: {}", call, resultName(result)) : reason_;
  throw GpuError(result == VK_ERROR_OUT_OF_DEVICE_MEMORY ? reason + ": use a smaller --size" : reason);
}

} // namespace vitrail::tool
