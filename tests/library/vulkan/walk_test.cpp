// A pixel's fragments in order: a shader of the host's that walks them (vitrail/list.glsl), and lists that the library
// copies out, with the host's words.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"
#include "shaders/walk.comp.h"
#include "shaders/walk_address.comp.h"

namespace vitrail::tests::vulkan {
namespace {

constexpr std::uint32_t kMostLayers = 256; // MOST_LAYERS of walk.comp

// As walk.comp has it.
struct Walked {
  std::uint32_t count;
  std::uint32_t cut;
  std::array<std::uint32_t, 2> unused;
  std::array<VitrailLayer, kMostLayers> layers;
};

using Layers = std::vector<VitrailLayer>;

// A stored fragment, and its place in a list.
struct Keyed {
  std::pair<SortKey, std::uint32_t> key;
  VitrailLayer layer;
};

VitrailLayer layerOf(const Fragment& stored, std::uint32_t word) {
  VitrailLayer layer{};
  for (unsigned c = 0; c < 4; ++c) layer.color[c] = static_cast<float>(stored.color[c]);
  layer.depth = stored.depth;
  layer.blend = stored.blend;
  layer.coverage = stored.coverage;
  layer.word = word;
  return layer;
}

// The points' fragments of each pixel as they are stored, in order.
std::vector<Layers> expectedLists(const HostDesc& desc, std::span<const Point> points) {
  const NodeCoding coding = codingOf(desc);
  std::vector<std::vector<Keyed>> pixels(std::size_t{desc.width} * desc.height);
  for (const Point& point : points) {
    Fragment fragment;
    std::copy(point.color.begin(), point.color.end(), fragment.color.begin());
    fragment.depth = point.depth;
    fragment.blend = point.blend;
    fragment.coverage = point.coverage & ((1U << desc.samples) - 1U);
    const auto node = packNode(coding, fragment);
    if (!node) continue;
    const std::uint32_t word = desc.userWords ? point.word : 0;
    pixels[point.y * desc.width + point.x].push_back(
        {{sortKey(coding, *node), word}, layerOf(unpackNode(coding, *node), word)});
  }
  std::vector<Layers> lists;
  for (std::vector<Keyed>& pixel : pixels) {
    std::sort(pixel.begin(), pixel.end(), [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
    Layers& list = lists.emplace_back();
    for (const Keyed& keyed : pixel) list.push_back(keyed.layer);
  }
  return lists;
}

void expectLayers(std::span<const VitrailLayer> got, std::span<const VitrailLayer> expected) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    for (unsigned c = 0; c < 4; ++c) {
      ASSERT_NEAR(got[i].color[c], expected[i].color[c], kTolerance * std::max(1.0F, expected[i].color[c])) << i;
    }
    ASSERT_EQ(got[i].depth, expected[i].depth) << i;
    ASSERT_EQ(got[i].blend, expected[i].blend) << i;
    ASSERT_EQ(got[i].coverage, expected[i].coverage) << i;
    ASSERT_EQ(got[i].word, expected[i].word) << i;
  }
}

// Every list was copied and is right; no layer is in two of them.
void expectCopied(const CopiedLists& copied, const std::vector<Layers>& expected) {
  std::vector<bool> taken(copied.layers.size());
  ASSERT_EQ(copied.lists.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    SCOPED_TRACE("copied pixel " + std::to_string(i));
    const auto [first, count] = copied.lists[i];
    ASSERT_LE(std::uint64_t{first} + count, copied.layers.size());
    expectLayers(std::span(copied.layers).subspan(first, count), expected[i]);
    for (std::uint32_t k = first; k < first + count; ++k) {
      ASSERT_FALSE(taken[k]);
      taken[k] = true;
    }
  }
}

// Walks the lists of a host's last frame, in a shader of its own.
class Walker {
 public:
  Walker(VulkanBackend& backend, const HostDesc& desc, VulkanHost& host)
      : device_(backend.device()), desc_(desc), size_{desc.width, desc.height} {
    VkDescriptorSetLayoutBinding binding{};
    binding.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    binding.descriptorCount = 1;
    binding.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    auto setInfo = zeroed<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    setInfo.bindingCount = 1;
    setInfo.pBindings = &binding;
    setLayout_ = make(device_, vkCreateDescriptorSetLayout, vkDestroyDescriptorSetLayout, setInfo);
    const std::array layouts = {host.context().descriptorSetLayout(), setLayout_.get()};
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(size_)};
    auto layoutInfo = zeroed<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    layoutInfo.setLayoutCount = static_cast<std::uint32_t>(layouts.size());
    layoutInfo.pSetLayouts = layouts.data();
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &range;
    layout_ = make(device_, vkCreatePipelineLayout, vkDestroyPipelineLayout, layoutInfo);
    makePipeline();
    makeSet();
  }

  std::vector<Walked> walk(VulkanHost& host) {
    Commands commands(device_);
    commands.run([&](VkCommandBuffer buffer) {
      // Writers: the library's shaders. Reader: the walk.
      cmdBarrier(buffer,
                 {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                  VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                 {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT});
      vkCmdBindPipeline(buffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
      const std::array sets = {host.target().descriptorSet(), set_};
      vkCmdBindDescriptorSets(buffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 2, sets.data(), 0, nullptr);
      vkCmdPushConstants(buffer, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(size_), size_.data());
      vkCmdDispatch(buffer, (desc_.width + 7) / 8, (desc_.height + 7) / 8, 1);
      // Writer: the walk. Reader: the host.
      cmdBarrier(buffer, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT}, kHostAccess);
    });
    const auto* first = static_cast<const Walked*>(walked_.mapped());
    return {first, first + std::size_t{desc_.width} * desc_.height};
  }

 private:
  void makePipeline() {
    const std::span<const std::uint32_t> code =
        desc_.addresses ? std::span<const std::uint32_t>(shaders::walk_address_comp) : shaders::walk_comp;
    auto moduleInfo = zeroed<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    moduleInfo.codeSize = code.size_bytes();
    moduleInfo.pCode = code.data();
    const auto module = make(device_, vkCreateShaderModule, vkDestroyShaderModule, moduleInfo);
    auto info = zeroed<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage = zeroed<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module.get();
    info.stage.pName = "main";
    info.layout = layout_.get();
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(device_.get(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          "vkCreateComputePipelines");
    pipeline_ = Owned<VkPipeline>(pipeline, {device_.get(), vkDestroyPipeline});
  }

  void makeSet() {
    walked_ = Buffer(device_, std::size_t{desc_.width} * desc_.height * sizeof(Walked),
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::Host);
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    auto poolInfo = zeroed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    pool_ = make(device_, vkCreateDescriptorPool, vkDestroyDescriptorPool, poolInfo);
    const VkDescriptorSetLayout setLayout = setLayout_.get();
    auto allocate = zeroed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = pool_.get();
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &setLayout;
    check(vkAllocateDescriptorSets(device_.get(), &allocate, &set_), "vkAllocateDescriptorSets");
    const VkDescriptorBufferInfo buffer{walked_.get(), 0, VK_WHOLE_SIZE};
    auto write = zeroed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set_;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &buffer;
    vkUpdateDescriptorSets(device_.get(), 1, &write, 0, nullptr);
  }

  const Device& device_;
  HostDesc desc_;
  std::array<std::uint32_t, 2> size_;
  Owned<VkDescriptorSetLayout> setLayout_;
  Owned<VkPipelineLayout> layout_;
  Owned<VkPipeline> pipeline_;
  Buffer walked_;
  Owned<VkDescriptorPool> pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

void expectWalked(VulkanBackend& backend, const HostDesc& desc, VulkanHost& host, const std::vector<Layers>& expected) {
  const std::vector<Walked> walked = Walker(backend, desc, host).walk(host);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    SCOPED_TRACE("walked pixel " + std::to_string(i));
    ASSERT_EQ(walked[i].cut, 0U);
    ASSERT_LE(walked[i].count, kMostLayers);
    expectLayers(std::span(walked[i].layers).first(walked[i].count), expected[i]);
  }
}

// Lists of many lengths, whose words are in the order of nothing else. Every eighth point is there three times, with
// three words.
std::vector<Point> listsWithWords(const HostDesc& desc) {
  PointVariety variety;
  variety.blendModes = true;
  variety.coverage = desc.samples > 1;
  std::vector<Point> points =
      randomLists(desc, {0, 1, 2, 5, 16, 17, 30, 33, 60, 70, 128, 130, 200, 4, 3, 2}, 11, variety);
  const std::size_t count = points.size();
  for (std::size_t i = 0; i < count; ++i) {
    points[i].word = static_cast<std::uint32_t>((i * 2654435761U) >> 4U);
    if (i % 8 != 0) continue;
    for (const std::uint32_t word : {0xffffffffU, 3U}) {
      Point same = points[i];
      same.word = word;
      points.push_back(same);
    }
  }
  return points;
}

class WalkTest : public VulkanTest {};

// Every way to build and resolve lists, in every format: what is walked after the resolve and what is copied before it
// is what was collected, in order.
TEST_F(WalkTest, ListsAreWalkedAndCopiedInOrder) {
  for (const std::uint32_t samples : sampleCounts(backend().features())) {
    for (const VitrailNodeFormat nodes : nodeFormats(samples)) {
      std::vector<Way> ways = everyWay(backend().features(), samples);
      if (nodes != VITRAIL_NODE_STANDARD) ways.resize(2);
      for (const Way& way : ways) {
        SCOPED_TRACE(way.name + ", format " + std::to_string(nodes) + ", samples " + std::to_string(samples));
        HostDesc desc;
        apply(way, desc);
        desc.nodes = nodes;
        desc.samples = samples;
        desc.userWords = true;
        const std::vector<Point> points = listsWithWords(desc);
        desc.capacity = static_cast<std::uint32_t>(points.size());
        desc.copyLayers = desc.capacity;
        desc.addresses = backend().features().addresses && nodes == VITRAIL_NODE_HDR;
        VulkanHost host(backend(), desc);
        host.draw(points);
        const std::vector<Layers> expected = expectedLists(desc, points);
        expectCopied(host.copied(), expected);
        expectWalked(backend(), desc, host, expected);
      }
    }
  }
}

// Words are not part of what is drawn, and without them they are 0.
TEST_F(WalkTest, WordsChangeNoPicture) {
  HostDesc desc;
  const std::vector<Point> points = listsWithWords(desc);
  desc.capacity = static_cast<std::uint32_t>(points.size());
  desc.copyLayers = desc.capacity;
  VulkanHost without(backend(), desc);
  const PointResult plain = without.draw(points);
  expectCopied(without.copied(), expectedLists(desc, points));
  desc.userWords = true;
  EXPECT_TRUE(VulkanHost(backend(), desc).draw(points).pixels == plain.pixels);
}

// Where not all layers fit, lists are left out whole; so are those of a frame that overflowed.
TEST_F(WalkTest, ListsThatFindNoRoomAreLeftOutWhole) {
  HostDesc desc;
  const std::vector<Point> points = listsWithWords(desc);
  const std::vector<Layers> expected = expectedLists(desc, points);
  desc.capacity = static_cast<std::uint32_t>(points.size());
  desc.copyLayers = desc.capacity / 2;
  VulkanHost host(backend(), desc);
  host.draw(points);
  const CopiedLists copied = host.copied();
  EXPECT_EQ(copied.header.layers, points.size());
  std::size_t missing = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto [first, count] = copied.lists[i];
    EXPECT_EQ(count, expected[i].size());
    if (first == 0xffffffffU) {
      ++missing;
    } else {
      expectLayers(std::span(copied.layers).subspan(first, count), expected[i]);
    }
  }
  EXPECT_GT(missing, 0U);
  EXPECT_LT(missing, 15U);

  desc.capacity /= 2;
  VulkanHost small(backend(), desc);
  small.draw(points);
  for (const auto [first, count] : small.copied().lists) EXPECT_TRUE(first == 0xffffffffU || count == 0);
}

} // namespace
} // namespace vitrail::tests::vulkan
