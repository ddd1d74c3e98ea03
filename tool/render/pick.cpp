#include "pick.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "../cpu/cpu_scene.h"
#include "../cpu/peel.h"
#include "rasterizer.h"

namespace vitrail::tool {

namespace {

int keepLayers(void* user, std::uint32_t /*x*/, std::uint32_t /*y*/, const VitrailLayer* layers, std::uint32_t count,
               float* /*color*/) {
  static_cast<std::vector<VitrailLayer>*>(user)->assign(layers, layers + count);
  return 1; // nobody looks at the picture
}

std::string blendName(std::uint32_t blend) {
  constexpr std::array<std::string_view, 4> kNames = {"over", "premultiplied", "additive", "multiply"};
  return std::string(kNames.at(blend));
}

// The point of a pixel's middle at a depth, before the camera.
glm::dvec3 unprojected(const View& view, const glm::dvec2& place, double depth, double aspect) {
  const glm::dmat4 fromClip = glm::inverse(glm::dmat4(projectionMatrix(view, static_cast<float>(aspect))));
  const glm::dvec4 point = fromClip * glm::dvec4(place, depth, 1.0);
  return glm::dvec3(point) / point.w;
}

} // namespace

std::vector<DrawFacts> drawFactsOf(const Scene& scene) {
  std::vector<DrawFacts> facts;
  facts.reserve(scene.draws.size());
  for (const Draw& draw : scene.draws) facts.push_back({draw.object, draw.material});
  return facts;
}

std::vector<PickedLayer> pickedOf(std::span<const VitrailLayer> layers, const std::vector<bool>& isOpaque,
                                  const std::vector<DrawFacts>& facts, const PickedPixel& pixel) {
  const glm::dvec2 place(2.0 * (pixel.x + 0.5) / pixel.width - 1.0, 2.0 * (pixel.y + 0.5) / pixel.height - 1.0);
  const double aspect = static_cast<double>(pixel.width) / pixel.height;
  std::vector<PickedLayer> picked;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const VitrailLayer& layer = layers[i];
    if (i > 0 && isFilterOf(layer, layers[i - 1])) {
      picked.back().filter = {layer.color[0], layer.color[1], layer.color[2]};
      continue;
    }
    PickedLayer& found = picked.emplace_back();
    found.draw = layer.word;
    found.object = facts[layer.word].object;
    found.material = facts[layer.word].material;
    const glm::dvec3 seen = unprojected(pixel.view, place, layer.depth, aspect);
    found.distance = -seen.z;
    found.point = glm::dvec3(glm::dmat4(pixel.view.cameraToWorld) * glm::dvec4(seen, 1.0));
    found.color = {layer.color[0], layer.color[1], layer.color[2]};
    found.alpha = isOpaque[i] ? 1.0F : layer.color[3];
    found.blend = isOpaque[i] ? "opaque" : blendName(layer.blend);
    if (isOpaque[i]) break;
  }
  return picked;
}

struct Picker::Impl {
  Rasterizer rasterizer{1};
  CpuScene scene;
  std::vector<DrawFacts> facts; // of the scene's draws

  Impl(const Scene& given, std::optional<float> opacity)
      : scene(given, opacity, DrawOrder::Forward), facts(drawFactsOf(given)) {}
};

Picker::Picker(const Scene& scene, std::optional<float> opacity) : impl_(std::make_unique<Impl>(scene, opacity)) {}
Picker::~Picker() = default;

std::vector<PickedLayer> Picker::at(const View& view, std::uint32_t width, std::uint32_t height, std::uint32_t x,
                                    std::uint32_t y) {
  const std::span<const VitrailCpuDraw> drawn = impl_->scene.draws(view, width, height);
  // Opaque surfaces are listed among the others, so that they are found in their order.
  std::vector<VitrailCpuDraw> draws(drawn.begin(), drawn.end());
  std::vector<bool> isOpaque(impl_->facts.size(), false);
  for (VitrailCpuDraw& draw : draws) {
    if (draw.surface != VITRAIL_CPU_OPAQUE) continue;
    isOpaque[draw.word] = true;
    draw.surface = VITRAIL_CPU_TRANSPARENT;
    draw.blend = VITRAIL_BLEND_OVER;
  }
  std::vector<VitrailLayer> layers;
  std::array<float, 4> color{};
  VitrailCpuFrame frame{};
  frame.width = frame.height = 1;
  frame.pictureWidth = width;
  frame.pictureHeight = height;
  frame.originX = x;
  frame.originY = y;
  frame.clipSpace = VITRAIL_CPU_CLIP_VULKAN;
  frame.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
  frame.colorFormat = VITRAIL_CPU_RGBA32F;
  frame.color = color.data();
  frame.list = keepLayers;
  frame.listUser = &layers;
  impl_->rasterizer.render(frame, draws, nullptr);

  std::vector<bool> opaqueLayers;
  for (const VitrailLayer& layer : layers) opaqueLayers.push_back(isOpaque[layer.word]);
  return pickedOf(layers, opaqueLayers, impl_->facts, {view, width, height, x, y});
}

} // namespace vitrail::tool
