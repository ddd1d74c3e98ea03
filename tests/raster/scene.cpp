#include "scene.h"

#include <algorithm>
#include <cstring>

namespace vitrail::tests::raster {

void shadeMaterial(void* material, VitrailCpuFragments* f) {
  for (std::uint32_t i = 0; i < VITRAIL_CPU_LANES; ++i) {
    if ((f->mask >> i & 1U) == 0) continue;
    Surface<float> s;
    s.x = f->x + i % 4;
    s.y = f->y + i / 4;
    s.triangle = f->triangle[i];
    s.front = (f->front >> i & 1U) != 0;
    s.depth = f->depth[i];
    s.second = f->second[i];
    s.third = f->third[i];
    static_cast<const Material*>(material)->shade(s);
    for (std::size_t c = 0; c < 4; ++c) f->color[c][i] = s.color[c];
    for (std::size_t c = 0; c < 3; ++c) f->filter[c][i] = s.filter[c];
    if (s.discarded) f->discarded |= 1U << i;
  }
}

namespace {

std::array<float, 4> randomColor(Random& random) {
  const float alpha = random.below(8) == 0 ? 1.0F : random.single(0.05, 0.95);
  return {random.single(0.0, 1.0), random.single(0.0, 1.0), random.single(0.0, 1.0), alpha};
}

// A vertex within the view or near it, as a host of that clip space has it, w in the fourth.
Position randomVertex(Random& random, const SceneOptions& options, const std::array<double, 2>& around) {
  // With near and far planes at w of 0.1 and 1.8, or anywhere between the planes.
  const double w = options.isClipped ? random.real(-0.3, 2.0) : random.real(0.2, 2.0);
  const double z = options.isClipped ? (w - 0.1) * 1.8 / 1.7 : random.real(0.0, 1.0) * w;
  const double x = around[0] + random.real(-0.6, 0.6);
  const double y = around[1] + random.real(-0.6, 0.6);
  const double own = options.clipSpace == VITRAIL_CPU_CLIP_OPENGL ? z * 2.0 - w : z;
  return {static_cast<float>(x * w), static_cast<float>(y * w), static_cast<float>(own), static_cast<float>(w)};
}

void addVertices(Random& random, const SceneOptions& options, SceneDraw& draw) {
  VitrailCpuDraw& desc = draw.desc;
  const std::uint32_t corners = desc.topology == VITRAIL_CPU_POINTS ? 1 : desc.topology == VITRAIL_CPU_LINES ? 2 : 3;
  const std::uint32_t primitives = 1 + random.below(options.primitives);
  const bool isOdd = options.hasOddVertices && random.below(4) != 0;
  desc.components = isOdd && random.below(2) == 0 ? 3 : isOdd && random.below(2) == 0 ? 4 : 0;
  const std::uint32_t components = desc.components == 0 ? 4 : desc.components;
  const std::uint32_t gap = isOdd ? random.below(3) : 0;
  desc.vertexStride = gap == 0 ? 0 : static_cast<std::uint32_t>((components + gap) * sizeof(float));
  const bool isIndexed = isOdd && random.below(2) == 0;
  desc.vertexCount = isIndexed ? corners + random.below(20) : corners * primitives;
  std::array<double, 2> around{};
  for (std::uint32_t v = 0; v < desc.vertexCount; ++v) {
    if (v % corners == 0 || isIndexed) around = {random.real(-1.0, 1.0), random.real(-1.0, 1.0)};
    Position p = randomVertex(random, options, around);
    if (components == 3) { // w is 1
      const float w = p[3] != 0.0F ? p[3] : 1.0F;
      for (float& value : p) value /= w;
    }
    draw.vertices.insert(draw.vertices.end(), p.begin(), p.begin() + components);
    draw.vertices.insert(draw.vertices.end(), gap, 1e9F);
  }
  for (std::uint32_t i = 0; isIndexed && i < corners * primitives; ++i) {
    draw.indices.push_back(random.below(desc.vertexCount));
  }
  if (isOdd && random.below(2) == 0) {
    draw.transform = {0.8F, 0.3F, 0.0F, 0.0F, -0.3F, 0.9F,  0.0F,  0.0F,
                      0.0F, 0.0F, 0.9F, 0.0F, 0.1F,  -0.1F, 0.05F, 1.0F};
    desc.transform = draw.transform.data();
  }
  if (isOdd && random.below(2) == 0) {
    draw.model = {0.9F, 0.2F, 0.0F, 0.05F, -0.2F, 0.7F, 0.0F, 0.0F, 0.0F, 0.0F, 0.95F, 0.02F};
    desc.model = draw.model.data();
  }
}

void addMaterial(Random& random, const SceneOptions& options, SceneDraw& draw) {
  VitrailCpuDraw& desc = draw.desc;
  draw.material.color = randomColor(random);
  draw.material.other = randomColor(random);
  std::copy(draw.material.color.begin(), draw.material.color.end(), desc.color);
  if (desc.blend == VITRAIL_BLEND_PREMULTIPLIED) { // half of it light of its own
    for (std::size_t c = 0; c < 3; ++c) desc.color[c] *= 0.5F * desc.color[3] + 0.1F;
  }
  if (options.isFlat || (!options.isShaded && random.below(2) == 0)) return;
  desc.shade = shadeMaterial;
  desc.shadeUser = &draw.material;
  desc.brightest = 2.0F;
  if (options.hasFilters && desc.blend == VITRAIL_BLEND_PREMULTIPLIED && desc.surface == VITRAIL_CPU_TRANSPARENT) {
    desc.shadeFlags |= VITRAIL_CPU_SHADE_FILTER;
    for (float& f : draw.material.filter) f = random.single(0.2, 1.0);
  }
  if (options.hasDiscards && random.below(2) == 0) {
    desc.shadeFlags |= VITRAIL_CPU_SHADE_DISCARD;
    draw.material.discardEvery = 2 + random.below(3);
  }
  if (random.below(3) == 0) desc.shadeFlags |= VITRAIL_CPU_SHADE_DERIVATIVES; // rows of another shape
}

std::unique_ptr<SceneDraw> randomDraw(Random& random, const SceneOptions& options) {
  auto draw = std::make_unique<SceneDraw>();
  VitrailCpuDraw& desc = draw->desc;
  if (options.hasOpaque && random.below(3) == 0) desc.surface = VITRAIL_CPU_OPAQUE;
  if (options.hasOtherTopologies && random.below(2) == 0) {
    desc.topology = random.below(2) == 0 ? VITRAIL_CPU_LINES : VITRAIL_CPU_POINTS;
    desc.pointSize = random.below(3) == 0 ? 0.0F : random.single(0.5, 20.0);
  }
  if (options.hasCulling) desc.cull = static_cast<VitrailCpuCull>(random.below(3));
  // Filters are few: light passes through them only once in a while.
  desc.blend = static_cast<VitrailBlend>(random.below(options.hasFilters ? 4 : 3));
  addVertices(random, options, *draw);
  addMaterial(random, options, *draw);
  if (options.hasPlanes && random.below(2) == 0) {
    desc.clipPlaneCount = 1 + random.below(random.below(3) == 0 ? VITRAIL_CPU_MAX_CLIP_PLANES : 2);
    for (std::uint32_t i = 0; i < desc.clipPlaneCount; ++i) {
      draw->planes.insert(draw->planes.end(), {random.single(-1.0, 1.0), random.single(-1.0, 1.0),
                                               random.single(-0.5, 0.5), random.single(0.0, 0.8)});
    }
    desc.clipPlanes = draw->planes.data();
  }
  desc.positions = draw->vertices.data();
  if (!draw->indices.empty()) {
    desc.indices = draw->indices.data();
    desc.indexCount = static_cast<std::uint32_t>(draw->indices.size());
  }
  return draw;
}

} // namespace

std::vector<VitrailCpuDraw> Scene::descs() const {
  std::vector<VitrailCpuDraw> made;
  for (const auto& each : draws) made.push_back(each->desc);
  return made;
}

Scene randomScene(Random& random, const SceneOptions& options) {
  Scene scene;
  scene.frame.width = options.width;
  scene.frame.height = options.height;
  scene.frame.samples = options.samples;
  scene.frame.clipSpace = options.clipSpace;
  scene.frame.depthOrder = options.depthOrder;
  const std::size_t pixels = std::size_t{options.width} * options.height;
  for (std::size_t i = 0; i < pixels; ++i) {
    scene.background.insert(scene.background.end(), {random.single(0.0, 1.0), 0.5F, random.single(0.0, 1.0), 1.0F});
  }
  if (options.hasSampleColors) {
    for (std::size_t i = 0; i < pixels * options.samples * 4; ++i)
      scene.sampleColors.push_back(random.single(0.0, 1.0));
  }
  if (options.hasDepth) {
    for (std::size_t i = 0; i < pixels * options.samples; ++i) scene.depth.push_back(random.single(0.0, 1.0));
  }
  for (std::uint32_t i = 0; i < options.draws; ++i) scene.draws.push_back(randomDraw(random, options));
  return scene;
}

bool Drawn::operator==(const Drawn& other) const {
  return pixels.size() == other.pixels.size() && depth.size() == other.depth.size() &&
         std::memcmp(pixels.data(), other.pixels.data(), pixels.size() * sizeof(float)) == 0 &&
         (depth.empty() || std::memcmp(depth.data(), other.depth.data(), depth.size() * sizeof(float)) == 0);
}

Drawn draw(Raster& raster, const Scene& scene, const std::vector<VitrailCpuDraw>& draws, std::uint64_t memoryBudget,
           bool counts) {
  Drawn drawn{scene.background, scene.depth, {}};
  VitrailCpuFrame frame = scene.frame;
  frame.color = drawn.pixels.data();
  frame.depth = drawn.depth.empty() ? nullptr : drawn.depth.data();
  frame.sampleColors = scene.sampleColors.empty() ? nullptr : scene.sampleColors.data();
  frame.memoryBudget = memoryBudget;
  EXPECT_EQ(raster.render(frame, draws, counts ? &drawn.stats : nullptr), VITRAIL_SUCCESS);
  return drawn;
}

Drawn draw(Raster& raster, const Scene& scene, std::uint64_t memoryBudget, bool counts) {
  return draw(raster, scene, scene.descs(), memoryBudget, counts);
}

} // namespace vitrail::tests::raster
