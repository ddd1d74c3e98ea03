#include "bandwidth.h"

#include <algorithm>
#include <array>
#include <functional>

#include "../gpu/barrier.h"
#include "../gpu/descriptors.h"
#include "../gpu/pipeline.h"
#include "../gpu/resources.h"
#include "../gpu/submit.h"
#include "../gpu/timers.h"
#include "shaders/bandwidth.comp.h"

namespace vitrail::tool {

namespace {

constexpr std::uint64_t kGpuBytes = std::uint64_t{256} << 20U;
constexpr std::uint64_t kCpuBytes = std::uint64_t{64} << 20U;
constexpr std::uint32_t kGroups = 8192; // enough to fill any device, and few enough for any device's limit
constexpr std::uint64_t kStep = 16;     // bytes that the shader copies at once
constexpr int kRepeats = 10;
constexpr std::uint32_t kPattern = 0x2b5d8e71U; // anything but zero: memory that was never written may not be there

// The bytes of each buffer: what one shader can reach bounds them.
std::uint64_t bufferBytes(const Gpu& gpu) {
  const bool isCpu = gpu.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  const std::uint64_t reach = gpu.properties().limits.maxStorageBufferRange / kStep * kStep;
  return std::min(isCpu ? kCpuBytes : kGpuBytes, reach);
}

GpuBuffer makeBuffer(Gpu& gpu, std::uint64_t bytes, const std::string& name) {
  constexpr VkBufferUsageFlags kUsage =
      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  return {gpu, bytes, kUsage, MemoryKind::Device, name};
}

using Record = std::function<void(VkCommandBuffer)>;

// Runs commands and tells how long they took. Throws GpuError without timestamps.
double secondsOf(Submitter& submitter, Timers& timers, const Record& record) {
  timers.startFrame();
  submitter.run("bandwidth", [&](VkCommandBuffer commands) {
    timers.cmdStart(commands);
    record(commands);
    timers.cmdEndPass(commands, "copy");
  });
  timers.addSubmission();
  if (timers.milliseconds().empty()) {
    throw GpuError("this device has no GPU timestamps, without which nothing can be measured: choose another --device");
  }
  return timers.milliseconds()[0].second * 1e-3;
}

double shortestRun(Submitter& submitter, Timers& timers, const Record& record, int repeats) {
  double shortest = secondsOf(submitter, timers, record);
  for (int i = 1; i < repeats; ++i) shortest = std::min(shortest, secondsOf(submitter, timers, record));
  return shortest;
}

} // namespace

double measureBandwidth(Gpu& gpu) {
  const std::uint64_t bytes = bufferBytes(gpu);
  const GpuBuffer source = makeBuffer(gpu, bytes, "bandwidth source");
  const GpuBuffer destination = makeBuffer(gpu, bytes, "bandwidth destination");
  SingleSet set(gpu,
                {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},
                 {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT}},
                "bandwidth");
  set.writeBuffer(0, source.get(), bytes);
  set.writeBuffer(1, destination.get(), bytes);
  const Unique<VkPipelineLayout> layout = makePipelineLayout(gpu, {set.layout()}, {}, "bandwidth");
  const Unique<VkPipeline> pipeline = makeComputePipeline(gpu, layout.get(), shaders::bandwidth_comp, "bandwidth");
  Submitter submitter(gpu);
  Timers timers(gpu, 1);

  secondsOf(submitter, timers, [&](VkCommandBuffer commands) {
    vkCmdFillBuffer(commands, source.get(), 0, bytes, kPattern);
    // The fill writes the source -> the copies of later submissions read it.
    cmdMemoryBarrier(commands, {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                     {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
                      VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_TRANSFER_READ_BIT});
  });
  const auto copyByShader = [&](VkCommandBuffer commands) {
    const VkDescriptorSet bound = set.set();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout.get(), 0, 1, &bound, 0, nullptr);
    vkCmdDispatch(commands, kGroups, 1, 1);
  };
  const auto copy = [&](VkCommandBuffer commands) {
    const VkBufferCopy region{0, 0, bytes};
    vkCmdCopyBuffer(commands, source.get(), destination.get(), 1, &region);
  };
  const bool isCpu = gpu.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  const double byShader = shortestRun(submitter, timers, copyByShader, isCpu ? 1 : kRepeats); // slow, there
  const double byCopy = shortestRun(submitter, timers, copy, kRepeats);
  return 2.0 * static_cast<double>(bytes) / std::min(byShader, byCopy);
}

} // namespace vitrail::tool
