#include "presenter.h"

#include <algorithm>
#include <cstring>

#include <imgui.h>

#include "../gpu/accesses.h"
#include "../gpu/barrier.h"
#include "../gpu/pipeline.h"
#include "../gpu/vk.h"
#include "shaders/overlay.frag.h"
#include "shaders/overlay.vert.h"

namespace vitrail::tool {

namespace {

constexpr VkFormat kTextureFormat = VK_FORMAT_R8G8B8A8_UNORM;

struct Constants {
  float scale[2];
  float offset[2];
};

// What ImGui knows a texture by: not 0, which stands for none.
void* idOf(std::size_t texture, bool smooth) {
  return reinterpret_cast<void*>(std::uintptr_t{2 * texture + (smooth ? 1U : 0U) + 1});
}

Unique<VkSampler> makeSampler(Gpu& gpu, VkFilter filter) {
  auto info = vkStruct<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
  info.magFilter = filter;
  info.minFilter = filter;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  VkSampler sampler = VK_NULL_HANDLE;
  check(vkCreateSampler(gpu.device(), &info, nullptr, &sampler), "vkCreateSampler (window)");
  return {gpu.device(), sampler, vkDestroySampler};
}

Unique<VkDescriptorSetLayout> makeSetLayout(Gpu& gpu) {
  const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                             VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
  auto info = vkStruct<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
  info.bindingCount = 1;
  info.pBindings = &binding;
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  check(vkCreateDescriptorSetLayout(gpu.device(), &info, nullptr, &layout), "vkCreateDescriptorSetLayout (window)");
  return {gpu.device(), layout, vkDestroyDescriptorSetLayout};
}

Unique<VkDescriptorPool> makePool(Gpu& gpu, std::uint32_t sets) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, sets};
  auto info = vkStruct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
  info.maxSets = sets;
  info.poolSizeCount = 1;
  info.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(gpu.device(), &info, nullptr, &pool), "vkCreateDescriptorPool (window)");
  return {gpu.device(), pool, vkDestroyDescriptorPool};
}

Unique<VkPipeline> makeOverlayPipeline(Gpu& gpu, VkPipelineLayout layout, VkFormat format) {
  const VkVertexInputBindingDescription binding{0, sizeof(ImDrawVert), VK_VERTEX_INPUT_RATE_VERTEX};
  const std::array<VkVertexInputAttributeDescription, 3> attributes = {
      VkVertexInputAttributeDescription{0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, pos)},
      VkVertexInputAttributeDescription{1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, uv)},
      VkVertexInputAttributeDescription{2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(ImDrawVert, col)}};
  GraphicsPipelineInfo info;
  info.layout = layout;
  info.vertexShader = shaders::overlay_vert;
  info.fragmentShader = shaders::overlay_frag;
  info.vertices = {std::span(&binding, 1), attributes};
  info.colors = {{format, blendWith({VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA},
                                    {VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA})}};
  info.name = "window";
  return makeGraphicsPipeline(gpu, info);
}

} // namespace

Presenter::Presenter(Window& window, Gpu* shared, bool validate) : window_(window), gpu_(shared) {
  if (gpu_ == nullptr || !gpu_->presents()) {
    GpuOptions options;
    options.validate = validate;
    options.instanceExtensions = window.instanceExtensions();
    options.presents = Window::presents;
    options.onlyPresenting = true;
    own_ = std::make_unique<Gpu>(options);
    gpu_ = own_.get();
  }
  Gpu& gpu = *gpu_;
  swapchain_ = std::make_unique<Swapchain>(gpu, window.makeSurface(gpu.instance()));
  setLayout_ = makeSetLayout(gpu);
  sets_ = makePool(gpu, static_cast<std::uint32_t>(kFrames * kTextures * 2));
  samplers_ = {makeSampler(gpu, VK_FILTER_NEAREST), makeSampler(gpu, VK_FILTER_LINEAR)};
  layout_ = makePipelineLayout(gpu, {setLayout_.get()}, {VK_SHADER_STAGE_VERTEX_BIT, sizeof(Constants)}, "window");
  pipeline_ = makeOverlayPipeline(gpu, layout_.get(), swapchain_->format());
  for (Slot& slot : slots_) makeSlot(slot);
  makeFont();
  for (const std::size_t side : {0U, 1U}) setTexture(textures_[side], {1, 1}, {0, 0, 0, 0}, "picture");
}

void Presenter::makeSlot(Slot& slot) {
  const VkDevice device = gpu_->device();
  auto poolInfo = vkStruct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
  poolInfo.queueFamilyIndex = gpu_->queueFamily();
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(device, &poolInfo, nullptr, &pool), "vkCreateCommandPool (window)");
  slot.pool = {device, pool, vkDestroyCommandPool};
  auto bufferInfo = vkStruct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
  bufferInfo.commandPool = pool;
  bufferInfo.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  bufferInfo.commandBufferCount = 1;
  check(vkAllocateCommandBuffers(device, &bufferInfo, &slot.commands), "vkAllocateCommandBuffers (window)");
  auto fenceInfo = vkStruct<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
  fenceInfo.flags = VK_FENCE_CREATE_SIGNALED_BIT;
  VkFence fence = VK_NULL_HANDLE;
  check(vkCreateFence(device, &fenceInfo, nullptr, &fence), "vkCreateFence (window)");
  slot.done = {device, fence, vkDestroyFence};
  const auto semaphoreInfo = vkStruct<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
  VkSemaphore semaphore = VK_NULL_HANDLE;
  check(vkCreateSemaphore(device, &semaphoreInfo, nullptr, &semaphore), "vkCreateSemaphore (window)");
  slot.acquired = {device, semaphore, vkDestroySemaphore};
  const std::array<VkDescriptorSetLayout, 2> layouts = {setLayout_.get(), setLayout_.get()};
  for (std::array<VkDescriptorSet, 2>& sets : slot.sets) {
    auto allocate = vkStruct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = sets_.get();
    allocate.descriptorSetCount = 2;
    allocate.pSetLayouts = layouts.data();
    check(vkAllocateDescriptorSets(device, &allocate, sets.data()), "vkAllocateDescriptorSets (window)");
  }
}

Presenter::~Presenter() { gpu_->waitIdle(); }

std::vector<std::string> Presenter::finish() {
  gpu_->waitIdle();
  for (Slot& slot : slots_) slot = {};
  textures_ = {};
  pipeline_ = {};
  layout_ = {};
  samplers_ = {};
  sets_ = {};
  setLayout_ = {};
  swapchain_.reset();
  if (own_ == nullptr) return {};
  own_->close();
  return own_->validationErrors();
}

void Presenter::makeFont() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  unsigned char* pixels = nullptr;
  int width = 0;
  int height = 0;
  atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
  const PixelSize size{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
  setTexture(textures_[kFont], size, {pixels, pixels + std::size_t{size.width} * size.height * 4}, "font");
  atlas.SetTexID(idOf(kFont, true));
  atlas.ClearTexData();
}

// Gives a texture other pixels, and an image of their size.
void Presenter::setTexture(Texture& texture, PixelSize size, std::vector<std::uint8_t> pixels, const char* name) {
  texture.pixels = std::move(pixels);
  // An image that somebody else has drawn is not written to.
  if (texture.image && texture.isOwn) {
    const VkExtent2D extent = texture.image->info().extent;
    if (extent.width == size.width && extent.height == size.height) return;
  }
  texture.isOwn = true;
  GpuImageInfo info;
  info.extent = {size.width, size.height};
  info.format = kTextureFormat;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  texture.image = std::make_shared<GpuImage>(*gpu_, info, name); // frames in flight hold the one before
}

// A frame that is not pending takes the textures of now.
void Presenter::holdTextures(Slot& slot) const {
  for (std::size_t t = 0; t < kTextures; ++t) {
    if (slot.images[t] == textures_[t].image) continue;
    slot.images[t] = textures_[t].image;
    for (std::size_t i = 0; i < 2; ++i) {
      const VkDescriptorImageInfo image{samplers_[i].get(), slot.images[t]->view(),
                                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
      auto write = vkStruct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
      write.dstSet = slot.sets[t][i];
      write.descriptorCount = 1;
      write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
      write.pImageInfo = &image;
      vkUpdateDescriptorSets(gpu_->device(), 1, &write, 0, nullptr);
    }
  }
}

void* Presenter::texture(Side side, bool smooth) { return idOf(static_cast<std::size_t>(side), smooth); }

void Presenter::setPicture(Side side, std::shared_ptr<const GpuImage> image) {
  textures_[static_cast<std::size_t>(side)] = {std::move(image), {}, false};
}

void Presenter::setPicture(Side side, const Picture& picture) {
  setTexture(textures_[static_cast<std::size_t>(side)], {picture.width, picture.height}, picture.rgba, "picture");
}

void Presenter::reserve(GpuBuffer& buffer, std::uint64_t bytes, VkBufferUsageFlags usage, const char* name) const {
  if (buffer.get() != VK_NULL_HANDLE && buffer.size() >= bytes) return;
  buffer = {};
  buffer = GpuBuffer(*gpu_, std::max<std::uint64_t>(bytes + bytes / 2, 4096), usage, MemoryKind::Upload, name);
}

// Copies the pixels of textures that have others, behind all frames that sampled them.
void Presenter::fillTextures(Slot& slot) {
  std::uint64_t bytes = 0;
  for (const Texture& texture : textures_) bytes += texture.pixels.size();
  if (bytes == 0) return;
  reserve(slot.pixels, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, "pixels");
  std::uint64_t offset = 0;
  for (Texture& texture : textures_) {
    if (texture.pixels.empty()) continue;
    std::memcpy(static_cast<std::byte*>(slot.pixels.mapped()) + offset, texture.pixels.data(), texture.pixels.size());
    const GpuImage& image = *texture.image;
    cmdImageBarrier(slot.commands, image.get(), image.range(), VK_IMAGE_LAYOUT_UNDEFINED,
                    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_NONE}, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                    kCopyWrite);
    VkBufferImageCopy copy{};
    copy.bufferOffset = offset;
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {image.info().extent.width, image.info().extent.height, 1};
    vkCmdCopyBufferToImage(slot.commands, slot.pixels.get(), image.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &copy);
    cmdImageBarrier(slot.commands, image.get(), image.range(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kCopyWrite,
                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kFragmentSample);
    offset += texture.pixels.size();
    texture.pixels.clear();
  }
}

void Presenter::copyGeometry(Slot& slot, const ImDrawData& data) const {
  const std::uint64_t vertexBytes = static_cast<std::uint64_t>(data.TotalVtxCount) * sizeof(ImDrawVert);
  const std::uint64_t indexBytes = static_cast<std::uint64_t>(data.TotalIdxCount) * sizeof(ImDrawIdx);
  reserve(slot.vertices, vertexBytes, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "window vertices");
  reserve(slot.indices, indexBytes, VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "window indices");
  auto* vertices = static_cast<std::byte*>(slot.vertices.mapped());
  auto* indices = static_cast<std::byte*>(slot.indices.mapped());
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    std::memcpy(vertices, list.VtxBuffer.Data, static_cast<std::size_t>(list.VtxBuffer.size_in_bytes()));
    std::memcpy(indices, list.IdxBuffer.Data, static_cast<std::size_t>(list.IdxBuffer.size_in_bytes()));
    vertices += list.VtxBuffer.size_in_bytes();
    indices += list.IdxBuffer.size_in_bytes();
  }
}

void Presenter::draw(Slot& slot, const Swapchain::Image& image, ImDrawData& data) {
  VkCommandBuffer commands = slot.commands;
  const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  // The stage of the semaphore's wait, so that the layout changes behind it.
  cmdImageBarrier(commands, image.image, range, VK_IMAGE_LAYOUT_UNDEFINED,
                  {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_NONE},
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorBlend);
  auto color = vkStruct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
  color.imageView = image.view;
  color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  color.clearValue.color = {{0.5F, 0.5F, 0.5F, 1.0F}};
  auto rendering = vkStruct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
  rendering.renderArea = {{0, 0}, image.extent};
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachments = &color;
  vkCmdBeginRendering(commands, &rendering);
  if (data.TotalIdxCount > 0) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
    vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
    vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    const VkViewport viewport{
        0.0F, 0.0F, static_cast<float>(image.extent.width), static_cast<float>(image.extent.height), 0.0F, 1.0F};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    const VkBuffer vertices = slot.vertices.get();
    const VkDeviceSize zero = 0;
    const VkDeviceSize stride = sizeof(ImDrawVert);
    vkCmdBindVertexBuffers2(commands, 0, 1, &vertices, &zero, nullptr, &stride);
    vkCmdBindIndexBuffer(commands, slot.indices.get(), 0,
                         sizeof(ImDrawIdx) == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32);
    const Constants constants{
        {2.0F / data.DisplaySize.x, 2.0F / data.DisplaySize.y},
        {-1.0F - 2.0F * data.DisplayPos.x / data.DisplaySize.x, -1.0F - 2.0F * data.DisplayPos.y / data.DisplaySize.y}};
    vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(constants), &constants);
    std::int32_t firstVertex = 0;
    std::uint32_t firstIndex = 0;
    for (int i = 0; i < data.CmdListsCount; ++i) {
      const ImDrawList& list = *data.CmdLists[i];
      for (const ImDrawCmd& command : list.CmdBuffer) {
        // Where the window has just changed its size, the widgets are those of the old one.
        const auto edge = [](float place, float scale, std::uint32_t most) {
          return static_cast<std::int32_t>(std::clamp(place * scale, 0.0F, static_cast<float>(most)));
        };
        const ImVec2 scale = data.FramebufferScale;
        const std::int32_t left = edge(command.ClipRect.x - data.DisplayPos.x, scale.x, image.extent.width);
        const std::int32_t top = edge(command.ClipRect.y - data.DisplayPos.y, scale.y, image.extent.height);
        const std::int32_t right = edge(command.ClipRect.z - data.DisplayPos.x, scale.x, image.extent.width);
        const std::int32_t bottom = edge(command.ClipRect.w - data.DisplayPos.y, scale.y, image.extent.height);
        if (right <= left || bottom <= top) continue;
        const VkRect2D scissor{{left, top},
                               {static_cast<std::uint32_t>(right - left), static_cast<std::uint32_t>(bottom - top)}};
        vkCmdSetScissor(commands, 0, 1, &scissor);
        const auto id = reinterpret_cast<std::uintptr_t>(command.GetTexID()) - 1;
        const VkDescriptorSet set = slot.sets.at(id / 2)[id % 2];
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1, &set, 0, nullptr);
        vkCmdDrawIndexed(commands, command.ElemCount, 1, firstIndex + command.IdxOffset,
                         firstVertex + static_cast<std::int32_t>(command.VtxOffset), 0);
      }
      firstVertex += list.VtxBuffer.Size;
      firstIndex += static_cast<std::uint32_t>(list.IdxBuffer.Size);
    }
  }
  vkCmdEndRendering(commands);
  cmdImageBarrier(commands, image.image, range, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColorReplace,
                  VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, {});
}

bool Presenter::show(ImDrawData& data, bool vsync) {
  if (!swapchain_->fit(window_, vsync)) return false;
  Slot& slot = slots_[next_];
  const VkFence done = slot.done.get();
  const VkResult free = vkWaitForFences(gpu_->device(), 1, &done, VK_TRUE, Swapchain::kPatience);
  check(free, "vkWaitForFences (window)");
  if (free == VK_TIMEOUT) return false;
  const std::optional<Swapchain::Image> image = swapchain_->acquire(slot.acquired.get());
  if (!image) return false;
  check(vkResetFences(gpu_->device(), 1, &done), "vkResetFences");
  next_ = (next_ + 1) % kFrames;
  check(vkResetCommandPool(gpu_->device(), slot.pool.get(), 0), "vkResetCommandPool");
  auto begin = vkStruct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(slot.commands, &begin), "vkBeginCommandBuffer (window)");
  fillTextures(slot);
  holdTextures(slot);
  copyGeometry(slot, data);
  draw(slot, *image, data);
  check(vkEndCommandBuffer(slot.commands), "vkEndCommandBuffer (window)");
  submit(slot, *image);
  swapchain_->present(*image);
  return true;
}

void Presenter::submit(Slot& slot, const Swapchain::Image& image) const {
  auto wait = vkStruct<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
  wait.semaphore = slot.acquired.get();
  wait.stageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  auto signal = vkStruct<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
  signal.semaphore = image.rendered;
  signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  auto commands = vkStruct<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
  commands.commandBuffer = slot.commands;
  auto info = vkStruct<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
  info.waitSemaphoreInfoCount = 1;
  info.pWaitSemaphoreInfos = &wait;
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &commands;
  info.signalSemaphoreInfoCount = 1;
  info.pSignalSemaphoreInfos = &signal;
  check(gpu_->submit(info, slot.done.get()), "vkQueueSubmit2 (window)");
}

} // namespace vitrail::tool
