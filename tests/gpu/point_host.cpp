#include "point_host.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include "core/pool.h"
#include "draw/barrier.h"
#include "draw/vk.h"
#include "shaders/points.frag.h"
#include "shaders/points.vert.h"

namespace vitrail::tests {

namespace {

using tool::check;
using tool::MemoryKind;
using tool::vkStruct;

struct PointVertex {
  std::array<float, 3> position;
  std::array<float, 4> color;
};

// The clip-space vertex whose point covers the pixel's centre.
PointVertex toVertex(const Point& point, const PointHostDesc& desc) {
  const auto clip = [](std::uint32_t pixel, std::uint32_t size) {
    return (static_cast<float>(pixel) + 0.5F) * 2.0F / static_cast<float>(size) - 1.0F;
  };
  return {{clip(point.x, desc.width), clip(point.y, desc.height), point.depth}, point.color};
}

void throwReason(VitrailLogSeverity /*severity*/, const char* message, void* /*user*/) {
  throw std::runtime_error(message);
}

tool::Unique<VkShaderModule> makeShader(VkDevice device, std::span<const std::uint32_t> code) {
  auto info = vkStruct<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
  info.codeSize = code.size_bytes();
  info.pCode = code.data();
  VkShaderModule shader = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device, &info, nullptr, &shader), "vkCreateShaderModule");
  return {device, shader, vkDestroyShaderModule};
}

constexpr std::array<VkVertexInputAttributeDescription, 2> kAttributes = {
    VkVertexInputAttributeDescription{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(PointVertex, position)},
    VkVertexInputAttributeDescription{1, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(PointVertex, color)},
};
constexpr VkVertexInputBindingDescription kBinding = {0, sizeof(PointVertex), VK_VERTEX_INPUT_RATE_VERTEX};

} // namespace

PointHost::PointHost(tool::Gpu& gpu, const PointHostDesc& desc) : gpu_(gpu), desc_(desc), submitter_(gpu) {
  for (std::uint32_t i = 0; i < kColorImages; ++i) {
    color_[i] =
        tool::GpuImage(gpu,
                       {{desc.width, desc.height},
                        desc.colorFormat,
                        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                       "points: colour");
    readback_[i] = tool::GpuBuffer(gpu, std::uint64_t{desc.width} * desc.height * 16, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                   MemoryKind::Readback, "points: readback");
  }
  const VkDeviceSize alignment = gpu.properties().limits.minStorageBufferOffsetAlignment;
  guardBytes_ = (kGuardWords * sizeof(std::uint32_t) + alignment - 1) / alignment * alignment;
  nodes_ = tool::GpuBuffer(gpu, nodePoolBytes(desc.capacity) + 2 * guardBytes_, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                           MemoryKind::Readback, "points: nodes");
  auto* words = static_cast<std::uint32_t*>(nodes_.mapped());
  std::fill(words, words + nodes_.size() / sizeof(std::uint32_t), kGuard);

  VitrailContextDesc contextDesc{};
  contextDesc.instance = gpu.instance();
  contextDesc.physicalDevice = gpu.physicalDevice();
  contextDesc.device = gpu.device();
  contextDesc.getInstanceProcAddr = vkGetInstanceProcAddr;
  contextDesc.log = throwReason;
  createTarget(contextDesc);
  createPipeline();
}

void PointHost::createTarget(VitrailContextDesc contextDesc) {
  check(Context::create(contextDesc, context_), "vitrailCreateContext");
  const std::array<VkImageView, kColorImages> views = {color_[0].view(), color_[1].view()};
  VitrailTargetDesc desc{};
  desc.extent = {desc_.width, desc_.height};
  desc.depthOrder = desc_.depthOrder;
  desc.nodeCapacity = desc_.capacity;
  desc.colorFormat = desc_.colorFormat;
  desc.colorViewCount = kColorImages;
  desc.colorViews = views.data();
  desc.nodeBuffer = nodes_.get();
  desc.nodeBufferOffset = guardBytes_;
  desc.debugName = "points";
  check(Target::create(context_, desc, target_), "vitrailCreateTarget");
}

void PointHost::createPipeline() {
  const VkDescriptorSetLayout set = context_.descriptorSetLayout();
  auto layoutInfo = vkStruct<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
  layoutInfo.setLayoutCount = 1;
  layoutInfo.pSetLayouts = &set;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  check(vkCreatePipelineLayout(gpu_.device(), &layoutInfo, nullptr, &layout), "vkCreatePipelineLayout");
  layout_ = {gpu_.device(), layout, vkDestroyPipelineLayout};

  const auto vertexShader = makeShader(gpu_.device(), shaders::points_vert);
  const auto fragmentShader = makeShader(gpu_.device(), shaders::points_frag);
  std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
  for (auto& stage : stages) {
    stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    stage.pName = "main";
  }
  stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  stages[0].module = vertexShader.get();
  stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  stages[1].module = fragmentShader.get();

  auto input =
      vkStruct<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
  input.vertexBindingDescriptionCount = 1;
  input.pVertexBindingDescriptions = &kBinding;
  input.vertexAttributeDescriptionCount = kAttributes.size();
  input.pVertexAttributeDescriptions = kAttributes.data();
  auto assembly =
      vkStruct<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  const VkViewport viewport{0.0F, 0.0F, static_cast<float>(desc_.width), static_cast<float>(desc_.height), 0.0F, 1.0F};
  const VkRect2D scissor{{0, 0}, {desc_.width, desc_.height}};
  auto viewports = vkStruct<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
  viewports.viewportCount = 1;
  viewports.pViewports = &viewport;
  viewports.scissorCount = 1;
  viewports.pScissors = &scissor;
  auto raster =
      vkStruct<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
  raster.lineWidth = 1.0F;
  auto samples =
      vkStruct<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  auto rendering = vkStruct<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);

  auto info = vkStruct<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
  info.pNext = &rendering;
  info.stageCount = stages.size();
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewports;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.layout = layout_.get();
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateGraphicsPipelines(gpu_.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "vkCreateGraphicsPipelines");
  pipeline_ = {gpu_.device(), pipeline, vkDestroyPipeline};
}

void PointHost::recordDraw(VkCommandBuffer commands, VkBuffer vertices, std::uint32_t count) const {
  auto rendering = vkStruct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
  rendering.renderArea = {{0, 0}, {desc_.width, desc_.height}};
  rendering.layerCount = 1;
  vkCmdBeginRendering(commands, &rendering);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
  const VkDescriptorSet set = target_.descriptorSet();
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1, &set, 0, nullptr);
  const VkDeviceSize offset = 0;
  vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &offset);
  vkCmdDraw(commands, count, 1, 0, 0);
  vkCmdEndRendering(commands);
}

void PointHost::record(VkCommandBuffer commands, std::uint64_t frame, VkBuffer vertices, std::uint32_t count) const {
  const auto image = static_cast<std::uint32_t>(frame % kColorImages);
  const VkImage color = color_[image].get();
  const VkImageSubresourceRange range = color_[image].range();
  // Writer: nobody that matters, the old picture is dropped. Writer after: the clear.
  tool::cmdImageBarrier(commands, color, range, VK_IMAGE_LAYOUT_UNDEFINED,
                        {VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_NONE}, VK_IMAGE_LAYOUT_GENERAL,
                        {VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT});
  VkClearColorValue behind{};
  std::copy(desc_.behind.begin(), desc_.behind.end(), behind.float32);
  vkCmdClearColorImage(commands, color, VK_IMAGE_LAYOUT_GENERAL, &behind, 1, &range);

  target_.begin(commands, {frame});
  if (count > 0) recordDraw(commands, vertices, count);
  target_.collected(commands);

  // Writer: the clear. Reader and writer: the resolve.
  tool::cmdImageBarrier(commands, color, range, VK_IMAGE_LAYOUT_GENERAL,
                        {VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT}, VK_IMAGE_LAYOUT_GENERAL,
                        {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                         VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT});
  target_.resolve(commands, {image});
}

// After the last frame, so that no barrier of this host stands between two frames.
void PointHost::recordPicture(VkCommandBuffer commands, std::uint32_t image) const {
  // Writer: the resolve. Reader: the copy.
  tool::cmdImageBarrier(commands, color_[image].get(), color_[image].range(), VK_IMAGE_LAYOUT_GENERAL,
                        {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                        VK_IMAGE_LAYOUT_GENERAL, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT});
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {desc_.width, desc_.height, 1};
  vkCmdCopyImageToBuffer(commands, color_[image].get(), VK_IMAGE_LAYOUT_GENERAL, readback_[image].get(), 1, &copy);

  // Writers: the copy, and the fragment shaders behind whose backs the guards are checked. Reader: the host.
  tool::cmdMemoryBarrier(commands,
                         {VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                          VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                         {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

PointResult PointHost::read(std::uint64_t frame) const {
  PointResult result;
  check(target_.readStats(frame, result.stats), "vitrailReadStats");
  if (desc_.colorFormat == VK_FORMAT_R32G32B32A32_SFLOAT) {
    result.pixels.resize(std::size_t{desc_.width} * desc_.height);
    std::memcpy(result.pixels.data(), readback_[frame % kColorImages].mapped(),
                result.pixels.size() * sizeof(result.pixels[0]));
  }
  return result;
}

PointResult PointHost::draw(std::span<const Point> points) { return drawTogether({{points.begin(), points.end()}})[0]; }

std::vector<PointResult> PointHost::drawTogether(const std::vector<std::vector<Point>>& frames) {
  std::vector<tool::GpuBuffer> vertices;
  for (const std::vector<Point>& points : frames) {
    vertices.emplace_back(gpu_, points.size() * sizeof(PointVertex), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                          MemoryKind::Upload, "points: vertices");
    auto* written = static_cast<PointVertex*>(vertices.back().mapped());
    for (const Point& point : points) *written++ = toVertex(point, desc_);
  }
  const std::uint64_t first = frame_;
  frame_ += frames.size();
  submitter_.run("points", [&](VkCommandBuffer commands) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      record(commands, first + i, vertices[i].get(), static_cast<std::uint32_t>(frames[i].size()));
    }
    for (std::uint64_t frame = first; frame < frame_; ++frame) {
      recordPicture(commands, static_cast<std::uint32_t>(frame % kColorImages));
    }
  });
  std::vector<PointResult> results;
  for (std::uint64_t frame = first; frame < frame_; ++frame) results.push_back(read(frame));
  return results;
}

bool PointHost::guardsUntouched() const {
  const auto* words = static_cast<const std::uint32_t*>(nodes_.mapped());
  const std::size_t total = nodes_.size() / sizeof(std::uint32_t);
  const std::size_t guard = guardBytes_ / sizeof(std::uint32_t);
  const auto untouched = [](std::uint32_t word) { return word == kGuard; };
  const bool pool = desc_.capacity == 0; // a pool without nodes is guard as a whole
  return pool ? std::all_of(words, words + total, untouched)
              : std::all_of(words, words + guard, untouched) &&
                    std::all_of(words + total - guard, words + total, untouched);
}

} // namespace vitrail::tests
