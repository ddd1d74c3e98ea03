// Soups of random triangles, lines and points by the raster, beside a reference in double precision that takes their
// corners as hardware does, rounded to 1/256 pixel; in other orders of draws, bands and extents they are the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>

#include "../../thorough.h"
#include "raster_host.h"

namespace vitrail::tests::vulkan {
namespace {

struct SoupKind {
  std::uint32_t samples = 1;
  VitrailDepthOrder depthOrder = VITRAIL_DEPTH_NEAREST_IS_ZERO;
  bool keepsPositions = true;
  std::uint32_t blendModes = 15;
  bool solids = false;
  bool longEdges = false; // through the middles of pixels, of triangles that are far larger than a picture of 8 x 8
};

// One triangle in subpixels, its corners clockwise in the picture; depths of which 1 is nearest.
struct SoupTriangle {
  std::array<std::array<std::int64_t, 2>, 3> corners;
  std::array<double, 3> plane; // depth at the first corner, and what a pixel to the right and down adds
  double nearest;
  std::uint32_t draw;

  [[nodiscard]] double depthAt(double x, double y) const { // pixels
    return plane[0] + plane[1] * (x - static_cast<double>(corners[0][0]) / 256.0) +
           plane[2] * (y - static_cast<double>(corners[0][1]) / 256.0);
  }
  [[nodiscard]] bool covers(std::int64_t x, std::int64_t y) const { // subpixels
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& p = corners.at((i + 1) % 3);
      const auto& q = corners.at((i + 2) % 3);
      const std::int64_t right = p[1] - q[1];
      const std::int64_t down = q[0] - p[0];
      const std::int64_t edge = right * (x - p[0]) + down * (y - p[1]);
      const bool own = right > 0 || (right == 0 && down > 0);
      if (edge < 0 || (edge == 0 && !own)) return false;
    }
    return true;
  }
};

class Soup {
 public:
  Soup(const SoupKind& kind, VkExtent2D extent, std::uint32_t seed) : kind_(kind), extent_(extent), random_(seed) {}

  RasterScene make(std::uint32_t triangles);
  // The colour of a pixel; nothing where rounding decides which of two surfaces is in front.
  [[nodiscard]] std::optional<std::array<double, 4>> at(std::uint32_t x, std::uint32_t y) const;

 private:
  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }
  void addDraw(std::uint32_t triangles);
  void addPrimitive(std::uint32_t corners);
  void addLongTriangle();
  void addTriangle(const std::array<std::array<float, 2>, 3>& pixels, std::array<double, 3> depths, bool isSolid);
  void addReference(const std::array<Vec4, 3>& clip, std::uint32_t corners);

  SoupKind kind_;
  VkExtent2D extent_;
  std::mt19937 random_;
  RasterScene scene_;
  std::vector<SoupTriangle> triangles_;
};

RasterScene Soup::make(std::uint32_t triangles) {
  scene_ = {};
  triangles_.clear();
  scene_.behind = {0.25F, 0.5F, 0.75F, 1.0F};
  if (below(3) == 0) {
    const float depth = static_cast<float>(unit());
    scene_.opaqueDepth = depth;
  }
  for (std::uint32_t left = triangles; left > 0;) {
    const std::uint32_t some = std::min(left, 1 + below(20));
    addDraw(some);
    left -= some;
  }
  return scene_;
}

void Soup::addDraw(std::uint32_t triangles) {
  VitrailVkRasterDraw draw{};
  const std::uint32_t corners = kind_.solids ? 1 + below(3) : 3;
  constexpr std::uint32_t kKinds[4] = {0, VITRAIL_VK_RASTER_POINTS, VITRAIL_VK_RASTER_LINES, 0};
  draw.flags = kKinds[corners];
  if (below(4) == 0) draw.flags |= VITRAIL_VK_RASTER_CULL_BACK;
  if (below(6) == 0) draw.flags |= VITRAIL_VK_RASTER_CULL_FRONT;
  if (below(2) == 0) draw.flags |= VITRAIL_VK_RASTER_FRONT_CLOCKWISE;
  do {
    draw.blend = below(4);
  } while ((kind_.blendModes >> draw.blend & 1U) == 0);
  draw.word = static_cast<std::uint32_t>(scene_.colors.size());
  const auto channel = [&] { return static_cast<float>(below(17)) / 16.0F; };
  scene_.colors.push_back({channel(), channel(), channel(), static_cast<float>(1 + below(8)) / 8.0F});
  draw.firstIndex = static_cast<std::uint32_t>(scene_.indices.size());
  draw.vertexOffset = static_cast<std::int32_t>(scene_.vertices.size());
  draw.count = corners * triangles;
  draw.instanceCount = 1;
  draw.vertexCount = corners * triangles;
  scene_.draws.push_back(draw);
  for (std::uint32_t i = 0; i < corners * triangles; ++i) scene_.indices.push_back(i);
  for (std::uint32_t i = 0; i < triangles; ++i) addPrimitive(corners);
}

// Edge functions that are 0 at a middle, of products far beyond what floats hold exactly.
void Soup::addLongTriangle() {
  const auto middle = [&](std::uint32_t end) { return 256.0 * below(end) + 128.0; };
  const double through[2] = {middle(extent_.width), middle(extent_.height)};
  const double way[2] = {below(4001) - 2000.0, below(4001) - 2000.0};
  const double steps[3] = {1.0 + below(3000), -1.0 - below(3000), 0.0};
  const double depth = unit() * 0.9 + 0.05;
  std::array<Vec4, 3> clip{};
  for (std::size_t i = 0; i < 3; ++i) {
    double subpixels[2] = {through[0] + steps[i] * way[0], through[1] + steps[i] * way[1]};
    if (i == 2) {
      for (double& at : subpixels) at = below(12'000'001) - 6e6;
    }
    clip.at(i) = {static_cast<float>(subpixels[0] / 128.0 / extent_.width - 1.0),
                  static_cast<float>(subpixels[1] / 128.0 / extent_.height - 1.0), static_cast<float>(depth), 1.0F};
    scene_.vertices.push_back(clip.at(i));
  }
  addReference(clip, 3);
}

void Soup::addPrimitive(std::uint32_t corners) {
  if (kind_.longEdges) return addLongTriangle();
  const double size = std::exp2(unit() * 9.0 - 1.0); // pixels
  const double x = (unit() * 1.4 - 0.2) * extent_.width;
  const double y = (unit() * 1.4 - 0.2) * extent_.height;
  const double depth = unit() * 0.9 + 0.05;
  const bool snaps = below(3) == 0; // to the grid of pixels and their middles
  const bool isFlat = below(2) == 0;
  std::array<Vec4, 3> clip{};
  for (std::uint32_t i = 0; i < corners; ++i) {
    double px = x + (unit() - 0.5) * size;
    double py = y + (unit() - 0.5) * size;
    if (snaps) {
      px = std::round(px * 2.0) / 2.0;
      py = std::round(py * 2.0) / 2.0;
    }
    const double w = isFlat ? 1.0 : std::exp2(unit() * 4.0 - 2.0);
    const double d = std::clamp(depth + (isFlat ? 0.0 : (unit() - 0.5) * 0.2), 0.01, 0.99);
    clip.at(i) = {static_cast<float>((px / extent_.width * 2.0 - 1.0) * w),
                  static_cast<float>((py / extent_.height * 2.0 - 1.0) * w), static_cast<float>(d * w),
                  static_cast<float>(w)};
    scene_.vertices.push_back(clip.at(i));
  }
  addReference(clip, corners);
}

// As vitrailTriangleOf() and vitrailHalfOf().
void Soup::addReference(const std::array<Vec4, 3>& clip, std::uint32_t corners) {
  std::array<std::array<float, 2>, 3> p{};
  std::array<double, 3> depths{};
  for (std::uint32_t i = 0; i < corners; ++i) {
    const Vec4& c = clip.at(i);
    const float inverse = 1.0F / c[3];
    const float size[2] = {static_cast<float>(extent_.width), static_cast<float>(extent_.height)};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const float one = c.at(axis) * inverse;
      const float scaled = one * (size[axis] * 0.5F);
      p.at(i).at(axis) = scaled + size[axis] * 0.5F;
    }
    const float z = kind_.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ZERO ? c[3] - c[2] : c[2];
    depths.at(i) = z * inverse;
  }
  if (corners == 3) {
    addTriangle(p, depths, false);
    return;
  }
  const auto from = p[0];
  const auto to = corners == 2 ? p[1] : p[0];
  const double depthTo = corners == 2 ? depths[1] : depths[0];
  const bool isSteep = std::abs(to[1] - from[1]) > std::abs(to[0] - from[0]);
  std::array<float, 2> across = isSteep ? std::array<float, 2>{0.5F, 0.0F} : std::array<float, 2>{0.0F, 0.5F};
  std::array<float, 2> along{};
  if (corners == 1) {
    across = {0.0F, 0.5F};
    along = {0.5F, 0.0F};
  }
  for (const bool second : {false, true}) {
    std::array<std::array<float, 2>, 3> half{};
    for (std::size_t a = 0; a < 2; ++a) {
      half[0].at(a) = from.at(a) - along.at(a) - across.at(a);
      half[1].at(a) = to.at(a) + along.at(a) + (second ? across.at(a) : -across.at(a));
      half[2].at(a) = (second ? from.at(a) - along.at(a) : to.at(a) + along.at(a)) + across.at(a);
    }
    addTriangle(half, {depths[0], depthTo, second ? depths[0] : depthTo}, true);
  }
}

void Soup::addTriangle(const std::array<std::array<float, 2>, 3>& pixels, std::array<double, 3> depths, bool isSolid) {
  SoupTriangle t{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      t.corners.at(i).at(axis) = std::llrint(std::nearbyint(static_cast<double>(pixels.at(i).at(axis)) * 256.0));
    }
  }
  const auto way = [&](std::size_t i, std::size_t axis) { return t.corners.at(i).at(axis) - t.corners[0].at(axis); };
  const std::int64_t area = way(1, 0) * way(2, 1) - way(1, 1) * way(2, 0);
  const VitrailVkRasterDraw& draw = scene_.draws.back();
  if (area == 0) return;
  const bool front = (area > 0) == ((draw.flags & VITRAIL_VK_RASTER_FRONT_CLOCKWISE) != 0);
  const std::uint32_t culled = front ? VITRAIL_VK_RASTER_CULL_FRONT : VITRAIL_VK_RASTER_CULL_BACK;
  if (!isSolid && (draw.flags & culled) != 0) return;
  const auto length = [&](std::int64_t x, std::int64_t y) { return std::abs(x) + std::abs(y); };
  const std::int64_t longest = std::max({length(way(1, 0), way(1, 1)), length(way(2, 0), way(2, 1)),
                                         length(way(1, 0) - way(2, 0), way(1, 1) - way(2, 1))});
  if (4 * std::abs(area) < longest) {
    t.plane = {(depths[0] + depths[1] + depths[2]) / 3.0, 0.0, 0.0};
  } else {
    const double inverse = 256.0 / static_cast<double>(area);
    const double rise[2] = {depths[1] - depths[0], depths[2] - depths[0]};
    const auto a = [&](std::size_t axis) { return static_cast<double>(way(1, axis)); };
    const auto b = [&](std::size_t axis) { return static_cast<double>(way(2, axis)); };
    t.plane = {depths[0], (rise[0] * b(1) - rise[1] * a(1)) * inverse, (rise[1] * a(0) - rise[0] * b(0)) * inverse};
  }
  t.nearest = *std::ranges::max_element(depths);
  t.draw = static_cast<std::uint32_t>(scene_.draws.size() - 1);
  if (area < 0) std::swap(t.corners[1], t.corners[2]);
  triangles_.push_back(t);
}

std::vector<std::array<int, 2>> samplePlaces(std::uint32_t samples) { // sixteenths
  if (samples == 2) return {{12, 12}, {4, 4}};
  if (samples == 4) return {{6, 2}, {14, 6}, {2, 10}, {10, 14}};
  if (samples == 8) return {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}};
  return {{8, 8}};
}

std::optional<std::array<double, 4>> Soup::at(std::uint32_t x, std::uint32_t y) const {
  struct Fragment {
    double depth;
    double blur; // by how much rounding may change it
    const SoupTriangle* triangle;
    std::uint32_t samples;
  };
  const auto places = samplePlaces(kind_.samples);
  double opaque = 0.0;
  if (scene_.opaqueDepth) {
    opaque = kind_.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ZERO ? 1.0 - *scene_.opaqueDepth : *scene_.opaqueDepth;
  }
  std::vector<Fragment> fragments;
  for (const SoupTriangle& t : triangles_) {
    const double slope = std::abs(t.plane[1]) + std::abs(t.plane[2]);
    Fragment f{t.depthAt(x + 0.5, y + 0.5), 4e-6 + slope * 4e-4, &t, 0};
    for (std::uint32_t s = 0; s < places.size(); ++s) {
      if (!t.covers(256LL * x + 16 * places[s][0], 256LL * y + 16 * places[s][1])) continue;
      double there = t.depthAt(x + places[s][0] / 16.0, y + places[s][1] / 16.0);
      if (kind_.samples == 1) there = std::min(there, t.nearest);
      if (scene_.opaqueDepth && std::abs(there - opaque) < 2e-5 + slope / 200.0) return std::nullopt;
      if (there >= opaque || !scene_.opaqueDepth) f.samples |= 1U << s;
    }
    if (kind_.samples == 1) f.depth = std::min(f.depth, t.nearest);
    f.depth = std::clamp(f.depth, 0.0, 1.0);
    if (f.samples != 0) fragments.push_back(f);
  }
  std::ranges::sort(fragments, std::greater{}, &Fragment::depth);
  for (std::size_t i = 0; i + 1 < fragments.size(); ++i) {
    const Fragment& a = fragments[i];
    const Fragment& b = fragments[i + 1];
    if (a.depth - b.depth < a.blur + b.blur && a.triangle->draw != b.triangle->draw) return std::nullopt;
  }
  std::array<double, 4> sum{};
  for (std::uint32_t s = 0; s < places.size(); ++s) {
    std::array<double, 4> through{1.0, 1.0, 1.0, 1.0};
    for (const Fragment& f : fragments) {
      if ((f.samples >> s & 1U) == 0) continue;
      const VitrailVkRasterDraw& draw = scene_.draws[f.triangle->draw];
      const Vec4& color = scene_.colors[draw.word];
      const double alpha = color[3];
      const bool hides = draw.blend == VITRAIL_BLEND_OVER || draw.blend == VITRAIL_BLEND_PREMULTIPLIED;
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = color.at(c);
        if (draw.blend == VITRAIL_BLEND_PREMULTIPLIED) sum.at(c) += through.at(c) * value;
        if (draw.blend == VITRAIL_BLEND_OVER || draw.blend == VITRAIL_BLEND_ADDITIVE) {
          sum.at(c) += through.at(c) * alpha * value;
        }
        if (hides) through.at(c) *= 1.0 - alpha;
        if (draw.blend == VITRAIL_BLEND_MULTIPLY) through.at(c) *= 1.0 - alpha + alpha * value;
      }
      if (hides) through[3] *= 1.0 - alpha;
    }
    for (std::size_t c = 0; c < 3; ++c) sum.at(c) += through.at(c) * scene_.behind.at(c);
    sum[3] += 1.0 - through[3] + through[3] * scene_.behind[3];
  }
  for (double& value : sum) value /= static_cast<double>(places.size());
  return sum;
}

class RasterSoupTest : public VulkanTest {};

constexpr VkExtent2D kMost{200, 104};

void drawSoups(const SoupKind& kind, std::uint32_t count) {
  RasterHostDesc desc;
  desc.width = kMost.width;
  desc.height = kMost.height;
  desc.samples = kind.samples;
  desc.depthOrder = kind.depthOrder;
  desc.keepsPositions = kind.keepsPositions;
  desc.blendModes = kind.blendModes;
  desc.solids = kind.solids;
  RasterHost host(desc);
  desc.memoryBudget = 40'000; // many bands
  RasterHost banded(desc);
  std::mt19937 random(11);
  std::uint64_t compared = 0;
  std::uint64_t all = 0;
  std::uint32_t mostBands = 0;
  std::uint32_t deepBands = 0;
  std::uint64_t deep = 0;
  // GPUs may round 1 / w as they like: a corner may be 1/256 pixel elsewhere, and then a pixel or two at its edges.
  // Deep tiles need more layers there.
  const bool isCpu = backend().device().isCpu();
  const int allowed = isCpu ? 0 : 4;
  for (std::uint32_t i = 0; i < count; ++i) {
    const VkExtent2D extent = kind.longEdges ? VkExtent2D{8, 8}
                              : i % 3 == 0   ? kMost
                                             : VkExtent2D{1 + static_cast<std::uint32_t>(random() % kMost.width),
                                                        1 + static_cast<std::uint32_t>(random() % kMost.height)};
    SCOPED_TRACE(testing::Message() << "soup " << i << ", " << extent.width << 'x' << extent.height << ", samples "
                                    << kind.samples);
    const VkExtent2D small{std::min(extent.width, 12U), std::min(extent.height, 9U)};
    const bool isDeep = i % 10 == 9;
    const VkExtent2D used = isDeep ? small : extent;
    Soup soup(kind, used, i);
    RasterScene scene = soup.make(isDeep ? 30000 : 1 + static_cast<std::uint32_t>(random() % 300));
    ASSERT_EQ(host.raster().resize(used), VK_SUCCESS);
    host.setScene(scene);
    const std::vector<float> drawn = host.draw();
    deep += host.stats().deepTiles;
    int wrong = 0;
    for (std::uint32_t y = 0; y < used.height; ++y) {
      for (std::uint32_t x = 0; x < used.width; ++x) {
        ++all;
        const auto expected = soup.at(x, y);
        if (!expected) continue;
        ++compared;
        const Vec4 found = host.at(x, y);
        double worst = 0.0;
        for (std::size_t c = 0; c < 4; ++c) worst = std::max(worst, std::abs(expected->at(c) - found.at(c)));
        if (!(worst < 2e-4) && ++wrong <= allowed) continue;
        if (!(worst < 2e-4) && wrong < allowed + 4) {
          ADD_FAILURE() << "pixel " << x << ' ' << y << ": " << found[0] << ' ' << found[1] << ' ' << found[2] << ' '
                        << found[3] << " in place of " << expected->at(0) << ' ' << expected->at(1) << ' '
                        << expected->at(2) << ' ' << expected->at(3);
        }
      }
    }
    EXPECT_LE(wrong, allowed);
    std::ranges::shuffle(scene.draws, random);
    host.setScene(scene);
    EXPECT_TRUE(host.draw() == drawn) << "shuffled";
    if (i % 5 != 0 && !isDeep) continue;
    std::optional<RasterHost> divided; // of a deep one
    if (isDeep) {
      desc.memoryBudget = host.raster().memory().tileBytes * 4 / 5;
      divided.emplace(desc);
    }
    RasterHost& other = isDeep ? *divided : banded;
    ASSERT_EQ(other.raster().resize(used), VK_SUCCESS);
    other.setScene(scene);
    try {
      other.draw(40);
    } catch (const HostError& error) {
      ASSERT_EQ(std::string(error.what()).find("not exact"), std::string::npos);
      backend().takeLog(); // no room for a row of tiles
      continue;
    }
    (isDeep ? deepBands : mostBands) = std::max(isDeep ? deepBands : mostBands, other.stats().bands);
    bool same = true;
    for (std::uint32_t y = 0; y < used.height; ++y) {
      for (std::uint32_t x = 0; x < used.width; ++x) same = same && other.at(x, y) == host.at(x, y);
    }
    EXPECT_TRUE(same) << "in " << other.stats().bands << " bands";
  }
  if (count >= 10) {
    EXPECT_GT(mostBands, 1U);
    EXPECT_GT(deepBands, 1U);
    if (isCpu) {
      EXPECT_GT(deep, 0U);
    }
  }
  EXPECT_GT(compared, all / 2);
}

// ---- Triangles that are clipped

struct ClippedTriangle {
  std::array<Vec4, 3> corners;
  std::uint32_t draw;
};

// Where a pixel's middle meets a triangle: its place in clip space, divided by its w, and how far inside the edges that
// is, in pixels.
struct Meeting {
  std::array<double, 4> place;
  double inside;
  double slope; // of the depth, for a pixel
};

std::optional<Meeting> meet(const ClippedTriangle& t, double ndcX, double ndcY, const VkExtent2D& extent) {
  const auto at = [&](std::size_t i, std::size_t k) { return static_cast<double>(t.corners.at(i).at(k)); };
  // The weights are planes over the picture (Olano and Greer): the cross products of x, y, w of two corners.
  std::array<std::array<double, 3>, 3> planes{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    planes.at(i) = {at(j, 1) * at(k, 3) - at(j, 3) * at(k, 1), at(j, 3) * at(k, 0) - at(j, 0) * at(k, 3),
                    at(j, 0) * at(k, 1) - at(j, 1) * at(k, 0)};
  }
  const double volume = at(0, 0) * planes[0][0] + at(0, 1) * planes[0][1] + at(0, 3) * planes[0][2];
  if (std::abs(volume) < 1e-9) return std::nullopt;
  Meeting m{{}, 1e9, 0.0};
  double right = 0.0;
  double down = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double weight = (planes.at(i)[0] * ndcX + planes.at(i)[1] * ndcY + planes.at(i)[2]) / volume;
    const double stepX = planes.at(i)[0] / volume * 2.0 / extent.width;
    const double stepY = planes.at(i)[1] / volume * 2.0 / extent.height;
    m.inside = std::min(m.inside, weight / std::max(std::hypot(stepX, stepY), 1e-12));
    for (std::size_t k = 0; k < 4; ++k) m.place.at(k) += weight * at(i, k);
    right += stepX * at(i, 2);
    down += stepY * at(i, 2);
  }
  m.slope = std::abs(right) + std::abs(down);
  return m;
}

void drawClipped(VitrailDepthOrder order, std::uint32_t count) {
  const VkExtent2D extent{72, 40};
  RasterHostDesc desc;
  desc.width = extent.width;
  desc.height = extent.height;
  desc.depthOrder = order;
  RasterHost host(desc);
  std::uint32_t compared = 0;
  std::uint32_t covered = 0;
  for (std::uint32_t soup = 0; soup < count; ++soup) {
    SCOPED_TRACE(testing::Message() << "soup " << soup);
    std::mt19937 random(soup);
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    RasterScene scene;
    std::vector<ClippedTriangle> triangles;
    scene.behind = {0.25F, 0.5F, 0.75F, 1.0F};
    for (std::uint32_t i = 0; i < 40; ++i) {
      ClippedTriangle t{};
      const double far_ = std::exp2(between(0.0, 12.0)); // out of the picture, up to beyond the guard band
      for (Vec4& corner : t.corners) {
        const double reach = random() % 3 == 0 ? far_ : 1.5;
        corner = {static_cast<float>(between(-reach, reach)), static_cast<float>(between(-reach, reach)),
                  static_cast<float>(between(-0.3, 1.3)), static_cast<float>(between(-0.5, 2.0))};
        scene.vertices.push_back(corner);
      }
      t.draw = i;
      VitrailVkRasterDraw draw{};
      draw.count = draw.vertexCount = 3;
      draw.instanceCount = 1;
      draw.vertexOffset = static_cast<std::int32_t>(3 * i);
      draw.word = i;
      scene.draws.push_back(draw);
      scene.colors.push_back({static_cast<float>(between(0, 1)), static_cast<float>(between(0, 1)),
                              static_cast<float>(between(0, 1)), static_cast<float>(between(0.2, 1))});
      triangles.push_back(t);
    }
    scene.indices = {0, 1, 2};
    const float plane[1][4] = {{static_cast<float>(between(-1, 1)), static_cast<float>(between(-1, 1)),
                                static_cast<float>(between(-1, 1)), static_cast<float>(between(0, 1))}};
    host.info().clipPlaneCount = soup % 2;
    host.info().clipPlanes = plane;
    host.setScene(scene);
    host.draw();
    for (std::uint32_t y = 0; y < extent.height; ++y) {
      for (std::uint32_t x = 0; x < extent.width; ++x) {
        struct Seen {
          double depth;
          double blur;
          std::uint32_t draw;
        };
        std::vector<Seen> seen;
        bool sure = true;
        for (const ClippedTriangle& t : triangles) {
          const auto m = meet(t, (x + 0.5) / extent.width * 2.0 - 1.0, (y + 0.5) / extent.height * 2.0 - 1.0, extent);
          if (!m) continue;
          const double blur = 1e-4 + 0.02 * m->slope;
          const double depth = m->place[2];
          double kept = std::min(depth, 1.0 - depth) / blur;
          if (soup % 2 == 1) {
            double value = 0.0;
            for (std::size_t k = 0; k < 3; ++k) value += static_cast<double>(plane[0][k]) * m->place.at(k);
            value += plane[0][3]; // w is 1
            kept = std::min(kept, value / (blur + 0.02));
          }
          const double all = std::min(kept, m->inside / 0.02);
          if (all <= -1.0) continue;
          if (all < 1.0) sure = false;
          const double nearness = order == VITRAIL_DEPTH_NEAREST_IS_ZERO ? depth : 1.0 - depth;
          seen.push_back({nearness, blur, t.draw});
        }
        std::ranges::sort(seen, {}, &Seen::depth);
        for (std::size_t i = 0; i + 1 < seen.size(); ++i) {
          sure = sure && seen[i + 1].depth - seen[i].depth > seen[i].blur + seen[i + 1].blur;
        }
        if (!sure) continue;
        ++compared;
        covered += seen.empty() ? 0 : 1;
        std::array<double, 3> color{};
        double through = 1.0;
        for (const Seen& one : seen) {
          const Vec4& c = scene.colors[one.draw];
          for (std::size_t k = 0; k < 3; ++k) color.at(k) += through * c[3] * c.at(k);
          through *= 1.0 - c[3];
        }
        const Vec4 found = host.at(x, y);
        for (std::size_t k = 0; k < 3; ++k) {
          ASSERT_NEAR(found.at(k), color.at(k) + through * scene.behind.at(k), 1e-4) << x << ' ' << y;
        }
      }
    }
  }
  EXPECT_GT(compared, count * extent.width * extent.height / 2);
  EXPECT_GT(covered, compared / 2);
}

// More where the environment says so: VITRAIL_SOUPS=1000.
std::uint32_t soups() {
  const char* given = std::getenv("VITRAIL_SOUPS");
  return given != nullptr ? static_cast<std::uint32_t>(std::atoi(given)) : 10U;
}

std::uint32_t fewerSoups() { return isThorough() ? soups() : (soups() + 2) / 3; }

TEST_F(RasterSoupTest, Triangles) { drawSoups({}, soups()); }
TEST_F(RasterSoupTest, ReversedDepth) {
  drawSoups({.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE}, fewerSoups());
  if (!isThorough()) return; // other pipelines
  drawSoups({.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE, .keepsPositions = false, .blendModes = 1}, soups());
}
TEST_F(RasterSoupTest, LinesAndPoints) { drawSoups({.solids = true}, fewerSoups()); }
TEST_F(RasterSoupTest, SeveralSamples) {
  for (const std::uint32_t samples : backend().features().multisampled)
    drawSoups({.samples = samples, .solids = isThorough()}, samples == 4 ? fewerSoups() : (soups() + 2) / 3);
}

TEST_F(RasterSoupTest, EdgesOfVeryLargeTriangles) { drawSoups({.longEdges = true}, 8); }

TEST_F(RasterSoupTest, ClippedTriangles) {
  drawClipped(VITRAIL_DEPTH_NEAREST_IS_ZERO, 2 * soups());
  drawClipped(VITRAIL_DEPTH_NEAREST_IS_ONE, 2 * soups());
}

} // namespace
} // namespace vitrail::tests::vulkan
