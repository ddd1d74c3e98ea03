#include "media.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "../../gpu/pixel_pass_shared.h"
#include "shaders/media_resolve.comp.h"
#include "shaders/media_resolve_address.comp.h"
#include "shaders/media_resolve_samples.comp.h"
#include "shaders/media_resolve_samples_address.comp.h"

namespace vitrail::tool {

namespace {

std::span<const std::uint32_t> resolveCode(bool several, bool byAddress) {
  if (several && byAddress) return shaders::media_resolve_samples_address_comp;
  if (several) return shaders::media_resolve_samples_comp;
  if (byAddress) return shaders::media_resolve_address_comp;
  return shaders::media_resolve_comp;
}

// The corners of the near plane's part that the picture shows, in the GPU's space.
std::array<glm::dvec3, 4> nearCorners(const shaders::FrameData& view) {
  const glm::dmat4 fromClip = glm::inverse(glm::dmat4(view.viewProjection));
  std::array<glm::dvec3, 4> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec4 corner = fromClip * glm::dvec4(i % 2 == 0 ? -1.0 : 1.0, i < 2 ? -1.0 : 1.0, 1.0, 1.0);
    corners[i] = glm::dvec3(corner) / corner.w;
  }
  return corners;
}

// Whether the box around some points of another space meets a box. A little larger: vertices are rounded.
bool meets(const Bounds& box, const glm::dmat4& toBox, const std::array<glm::dvec3, 4>& points) {
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high(-std::numeric_limits<double>::infinity());
  for (const glm::dvec3& point : points) {
    const glm::dvec3 inBox(toBox * glm::dvec4(point, 1.0));
    low = glm::min(low, inBox);
    high = glm::max(high, inBox);
  }
  const glm::dvec3 margin = 1e-3 * (glm::dvec3(box.max) - glm::dvec3(box.min));
  for (int i = 0; i < 3; ++i) {
    if (low[i] > box.max[i] + margin[i] || high[i] < box.min[i] - margin[i]) return false;
  }
  return true;
}

} // namespace

Media::Media(const MethodHost& host, VkDescriptorSetLayout lists, std::uint32_t samples)
    : gpu_(host.gpu),
      samples_(samples),
      objects_(gpu_, host.surfaces.scene().instanceCount() * sizeof(shaders::MediaObject),
               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryKind::Upload, "objects that absorb"),
      set_(gpu_,
           {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},
            {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
            {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
            {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT}},
           "media"),
      layout_(makePipelineLayout(gpu_, {lists, set_.layout()},
                                 {VK_SHADER_STAGE_COMPUTE_BIT, sizeof(shaders::MediaView)}, "media resolve")) {
  const GpuScene& drawn = host.surfaces.scene();
  near_.resize(drawn.instanceCount());
  const Scene& scene = host.scene;
  auto* table = static_cast<shaders::MediaObject*>(objects_.mapped());
  std::fill_n(table, drawn.instanceCount(), shaders::MediaObject{});
  for (const GpuDraw& draw : drawn.transparentDraws()) {
    const std::uint32_t material = scene.draws[drawn.sourceOf(draw.firstInstance)].material;
    const Facing facing = drawn.solids().of(draw.mesh, material);
    if (facing == Facing::Open) continue;
    const Bounds& box = drawn.solids().boxOf(draw.mesh);
    const glm::vec4 object(drawn.opacity() * absorption(scene.materials[material]),
                           static_cast<float>(facing == Facing::Inward ? shaders::MEDIA_INWARD : 0U));
    for (std::uint32_t i = draw.firstInstance; i < draw.firstInstance + draw.instanceCount; ++i) {
      table[i].absorption = object;
      const glm::dmat4 place(drawn.placeOf(scene, i));
      const bool flat = glm::determinant(place) == 0.0;
      placed_.push_back({i, flat ? glm::dmat4(1.0) : glm::inverse(place), flat, box});
    }
  }
  set_.writeBuffer(0, objects_.get(), objects_.size());
}

Unique<VkPipeline> Media::makePipeline(bool anyNear) {
  const bool tested = samples_ == 1 || gpu_.features().postDepthCoverage;
  return makeComputePipeline(gpu_, layout_.get(), resolveCode(samples_ > 1, gpu_.features().poolByAddress),
                             "media resolve",
                             {{0, samples_}, {1, tested ? VK_FALSE : VK_TRUE}, {2, anyNear ? VK_TRUE : VK_FALSE}});
}

void Media::setTarget(const MethodTarget& target) {
  set_.writeImage(1, target.color, VK_IMAGE_LAYOUT_GENERAL);
  set_.writeImage(2, target.depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
  if (samples_ > 1) set_.writeImage(3, target.opaque, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

void Media::setView(const shaders::FrameData& view) {
  const std::array<glm::dvec3, 4> corners = nearCorners(view);
  auto* table = static_cast<shaders::MediaObject*>(objects_.mapped());
  anyNear_ = false;
  for (const Placed& placed : placed_) {
    const bool isNear = placed.flat || meets(placed.box, placed.toBox, corners);
    anyNear_ = anyNear_ || isNear;
    near_[placed.object] = isNear;
    float& flags = table[placed.object].absorption.w;
    const std::uint32_t inward = static_cast<std::uint32_t>(flags) & shaders::MEDIA_INWARD;
    flags = static_cast<float>(inward | (isNear ? shaders::MEDIA_NEAR : 0U));
  }
  view_.ray = view.ray;
  view_.depth = glm::vec4(view.depth.x, view.depth.y, view.eye.w, 0.0F);
  Unique<VkPipeline>& pipeline = pipelines_.at(anyNear_ ? 1 : 0);
  if (pipeline.get() == VK_NULL_HANDLE) pipeline = makePipeline(anyNear_);
}

std::vector<SurfaceRun> Media::part(std::span<const SurfaceRun> runs, bool near) const {
  std::vector<SurfaceRun> result;
  for (const SurfaceRun& run : runs) {
    const std::uint32_t end = run.firstInstance + run.instanceCount;
    for (std::uint32_t first = run.firstInstance; first < end;) {
      std::uint32_t next = first + 1;
      while (next < end && near_[next] == near_[first]) ++next;
      if (near_[first] == near) {
        result.push_back(run);
        result.back().firstInstance = first;
        result.back().instanceCount = next - first;
      }
      first = next;
    }
  }
  return result;
}

void Media::cmdResolve(VkCommandBuffer commands, VkDescriptorSet lists, VkExtent2D area) const {
  const std::array<VkDescriptorSet, 2> sets{lists, set_.set()};
  const auto groups = [](std::uint32_t pixels) {
    return (pixels + shaders::PIXEL_GROUP_SIDE - 1) / shaders::PIXEL_GROUP_SIDE;
  };
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_.at(anyNear_ ? 1 : 0).get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0,
                          static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
  vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(view_), &view_);
  vkCmdDispatch(commands, groups(area.width), groups(area.height), 1);
}

} // namespace vitrail::tool
