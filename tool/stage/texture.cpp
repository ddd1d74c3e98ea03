#include "texture.h"

#include <algorithm>
#include <bit>
#include <span>

#include <fmt/format.h>

#include "../gpu/vk.h"
#include "material_data.h"

namespace vitrail::tool {

namespace {

constexpr VkImageUsageFlags kTextureUsage =
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

VkSamplerAddressMode addressMode(Wrap wrap) {
  switch (wrap) {
    case Wrap::MirroredRepeat:
      return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    case Wrap::ClampToEdge:
      return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    default:
      return VK_SAMPLER_ADDRESS_MODE_REPEAT;
  }
}

} // namespace

MaterialTextures::MaterialTextures(Gpu& gpu, Uploader& uploader, const Scene& scene, const SceneDraws& draws)
    : gpu_(gpu) {
  GpuImageInfo info;
  info.extent = {1, 1};
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.usage = kTextureUsage;
  white_ = GpuImage(gpu, info, "white texture");
  const std::array<std::uint8_t, 4> white{255, 255, 255, 255};
  uploader.toImage(std::as_bytes(std::span(white)), white_);
  createLayout();

  std::map<TextureSet, std::size_t> known;
  for (const std::uint32_t material : draws.materials()) {
    const Material& source = scene.materials.at(material);
    const auto slots = slotsOf(source);
    TextureSet combination;
    for (std::uint32_t i = 0; i < shaders::SLOT_COUNT; ++i) {
      const Texels texels = texelsOf(source, i, draws.isPremultiplied(material));
      combination.at(i) = slotTexture(uploader, scene, *slots.at(i), texels);
    }
    const auto [found, isNew] = known.try_emplace(combination, combinations_.size());
    if (isNew) combinations_.push_back(combination);
    setOfMaterial_[material] = found->second;
  }
  createSets(combinations_);
}

void MaterialTextures::createLayout() {
  std::array<VkDescriptorSetLayoutBinding, shaders::SLOT_COUNT> bindings{};
  for (std::uint32_t i = 0; i < shaders::SLOT_COUNT; ++i) {
    bindings.at(i).binding = i;
    bindings.at(i).descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    bindings.at(i).descriptorCount = 1;
    bindings.at(i).stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT;
  }
  auto info = vkStruct<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
  info.bindingCount = shaders::SLOT_COUNT;
  info.pBindings = bindings.data();
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  check(vkCreateDescriptorSetLayout(gpu_.device(), &info, nullptr, &layout), "vkCreateDescriptorSetLayout (material)");
  layout_ = {gpu_.device(), layout, vkDestroyDescriptorSetLayout};
  setDebugName(gpu_.device(), VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, layout, "material textures");
}

void MaterialTextures::createSets(const std::vector<TextureSet>& combinations) {
  if (combinations.empty()) return;
  const auto count = static_cast<std::uint32_t>(combinations.size());
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count * shaders::SLOT_COUNT};
  auto poolInfo = vkStruct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
  poolInfo.maxSets = count;
  poolInfo.poolSizeCount = 1;
  poolInfo.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(gpu_.device(), &poolInfo, nullptr, &pool), "vkCreateDescriptorPool (materials)");
  pool_ = {gpu_.device(), pool, vkDestroyDescriptorPool};
  setDebugName(gpu_.device(), VK_OBJECT_TYPE_DESCRIPTOR_POOL, pool, "material textures");

  const std::vector<VkDescriptorSetLayout> layouts(count, layout_.get());
  auto setInfo = vkStruct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
  setInfo.descriptorPool = pool;
  setInfo.descriptorSetCount = count;
  setInfo.pSetLayouts = layouts.data();
  sets_.resize(count);
  check(vkAllocateDescriptorSets(gpu_.device(), &setInfo, sets_.data()), "vkAllocateDescriptorSets (materials)");

  for (std::uint32_t i = 0; i < count; ++i) {
    setDebugName(gpu_.device(), VK_OBJECT_TYPE_DESCRIPTOR_SET, sets_[i], fmt::format("material textures {}", i));
    std::array<VkDescriptorImageInfo, shaders::SLOT_COUNT> images{};
    for (std::uint32_t slot = 0; slot < shaders::SLOT_COUNT; ++slot) {
      const auto [view, sampler] = combinations[i].at(slot);
      images.at(slot) = {sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    }
    auto write = vkStruct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = sets_[i];
    write.descriptorCount = shaders::SLOT_COUNT; // consecutive bindings of one kind
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = images.data();
    vkUpdateDescriptorSets(gpu_.device(), 1, &write, 0, nullptr);
  }
}

std::pair<VkImageView, VkSampler> MaterialTextures::slotTexture(Uploader& uploader, const Scene& scene,
                                                                const TextureSlot& slot, Texels texels) {
  if (!isFilled(scene, slot)) return {white_.view(), sampler(Sampler{})};
  return {view(uploader, scene, static_cast<std::uint32_t>(slot.image), texels), sampler(slot.sampler)};
}

VkImageView MaterialTextures::view(Uploader& uploader, const Scene& scene, std::uint32_t image, Texels texels) {
  const auto found = images_.find({image, texels});
  if (found != images_.end()) return found->second.view();

  const Image& source = scene.images.at(image);
  GpuImageInfo info;
  info.extent = {source.width, source.height};
  info.format = texels == Texels::Premultiplied ? VK_FORMAT_R16G16B16A16_SFLOAT
                : texels == Texels::Srgb        ? VK_FORMAT_R8G8B8A8_SRGB
                                                : VK_FORMAT_R8G8B8A8_UNORM;
  info.usage = kTextureUsage;
  info.mipLevels = static_cast<std::uint32_t>(std::bit_width(std::max(source.width, source.height)));
  const char* kind = texels == Texels::Premultiplied ? " (premultiplied)" : texels == Texels::Srgb ? " (sRGB)" : "";
  GpuImage texture(gpu_, info, fmt::format("texture {}{}", image, kind));
  if (texels == Texels::Premultiplied) {
    const std::vector<std::uint16_t> halves = premultiply(source);
    uploader.toImage(std::as_bytes(std::span(halves)), texture);
  } else {
    uploader.toImage(std::as_bytes(std::span(source.rgba)), texture);
  }
  return images_.emplace(std::pair{image, texels}, std::move(texture)).first->second.view();
}

VkSampler MaterialTextures::sampler(const Sampler& sampler) {
  for (const auto& [known, handle] : samplers_) {
    if (known == sampler) return handle.get();
  }
  auto info = vkStruct<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
  info.magFilter = sampler.magLinear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  info.minFilter = sampler.minLinear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  const bool mipLinear = sampler.mipmaps && sampler.mipLinear;
  info.mipmapMode = mipLinear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.addressModeU = addressMode(sampler.wrapU);
  info.addressModeV = addressMode(sampler.wrapV);
  info.addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT;
  // A quarter level: rounds to the base level and still lets the device tell minification from magnification.
  info.maxLod = sampler.mipmaps ? VK_LOD_CLAMP_NONE : 0.25F;
  VkSampler handle = VK_NULL_HANDLE;
  check(vkCreateSampler(gpu_.device(), &info, nullptr, &handle), "vkCreateSampler");
  samplers_.emplace_back(sampler, Unique<VkSampler>(gpu_.device(), handle, vkDestroySampler));
  setDebugName(gpu_.device(), VK_OBJECT_TYPE_SAMPLER, handle, fmt::format("sampler {}", samplers_.size() - 1));
  return handle;
}

} // namespace vitrail::tool
