#include "planes.h"

#include <utility>

#include <fmt/format.h>

namespace vitrail::tool {

namespace {

VkClearColorValue cleared(float value) {
  VkClearColorValue clear{};
  for (float& channel : clear.float32) channel = value;
  return clear;
}

} // namespace

PlaneInfo addingPlane(VkFormat format, std::uint32_t bytes) {
  const BlendFactors add{VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE};
  return {format, bytes, blendWith(add, add), cleared(0.0F)};
}

PlaneInfo multiplyingPlane(VkFormat format, std::uint32_t bytes) {
  return {
      format, bytes,
      blendWith({VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_SRC_COLOR}, {VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_SRC_ALPHA}),
      cleared(1.0F)};
}

Planes::Planes(std::vector<PlaneInfo> infos, std::uint32_t samples, std::string name)
    : infos_(std::move(infos)), samples_(samples), name_(std::move(name)), images_(infos_.size()) {}

std::vector<ColorOutput> Planes::outputs(std::size_t first, std::size_t count) const {
  std::vector<ColorOutput> outputs;
  for (std::size_t i = first; i < first + count; ++i) outputs.push_back({infos_[i].format, infos_[i].blend});
  return outputs;
}

void Planes::setTarget(Gpu& gpu, VkExtent2D extent, Composite& composite) {
  extent_ = extent;
  for (std::uint32_t i = 0; i < images_.size(); ++i) {
    images_[i].ensure(gpu, planeInfo(extent, infos_[i].format, samples_), fmt::format("{} plane {}", name_, i));
    composite.setPlane(i, images_[i]);
  }
}

void Planes::releaseTarget() {
  for (UsedImage& image : images_) image = UsedImage();
}

std::uint64_t Planes::bytes() const {
  std::uint64_t bytes = 0;
  for (const PlaneInfo& info : infos_) bytes += info.bytes;
  return bytes * samples_ * extent_.width * extent_.height;
}

void Planes::cmdBegin(Frame& frame, std::size_t first, std::size_t count) {
  Scope scope = frame.images().transparentScope({{0, 0}, extent_});
  for (std::size_t i = first; i < first + count; ++i) {
    images_[i].discard();
    scope.colors.push_back({.image = &images_[i], .clear = infos_[i].clear});
  }
  cmdBeginScope(frame.commands(), scope);
}

std::vector<UsedImage*> Planes::all() {
  std::vector<UsedImage*> images;
  for (UsedImage& image : images_) images.push_back(&image);
  return images;
}

} // namespace vitrail::tool
