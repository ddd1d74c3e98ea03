#include "expected.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

namespace vitrail::tests {

namespace {

Color doubleColor(const FloatColor& c) { return {c[0], c[1], c[2], c[3]}; }

// The samples at which the depth test lets a point through.
std::uint32_t passingSamples(const HostDesc& desc, float depth) {
  std::uint32_t passing = 0;
  for (std::uint32_t s = 0; s < desc.samples; ++s) {
    const bool passes =
        desc.opaqueDepth.empty() ||
        (desc.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? depth >= desc.opaqueDepth[s] : depth <= desc.opaqueDepth[s]);
    if (passes) passing |= 1U << s;
  }
  return passing;
}

// Random points of one host.
class Dice {
 public:
  Dice(const HostDesc& desc, unsigned seed, const PointVariety& variety)
      : coding_(codingOf(desc)), variety_(variety), random_(seed) {}

  float unit() { return static_cast<float>(random_() >> 8U) / 16777216.0F; }

  Point point(float depth, float largestAlpha) {
    Point point;
    point.depth = depth;
    if (variety_.blendModes && random_() % 5 < 3) point.blend = static_cast<std::uint32_t>(1 + random_() % 3);
    if (variety_.coverage) point.coverage = static_cast<std::uint32_t>(random_() % (1U << coding_.samples));
    for (unsigned i = 0; i < 3; ++i) point.color[i] = unit() * variety_.brightest;
    point.color[3] = unit() * largestAlpha;
    return onSteps(point);
  }

 private:
  // The point as it is once it has been stored.
  [[nodiscard]] Point onSteps(Point point) const {
    Fragment fragment{doubleColor(point.color), point.depth, VITRAIL_BLEND_PREMULTIPLIED, 1};
    fragment.color[3] = std::max(fragment.color[3], smallestAlpha());
    const Fragment stored = unpackNode(coding_, packNode(coding_, fragment).value());
    for (unsigned i = 0; i < 4; ++i) point.color[i] = static_cast<float>(stored.color[i]);
    return point;
  }

  [[nodiscard]] double smallestAlpha() const {
    if (coding_.format == layout::VITRAIL_FORMAT_COMPACT) return coding_.samples == 1 ? 1.0 / 63 : 1.0 / 31;
    return coding_.format == layout::VITRAIL_FORMAT_HDR ? 1.0 / 4096 : 1.0 / 255;
  }

  NodeCoding coding_;
  PointVariety variety_;
  std::mt19937 random_;
};

} // namespace

NodeCoding codingOf(const HostDesc& desc) {
  return {static_cast<std::uint32_t>(desc.nodes), desc.samples, desc.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE,
          desc.listBuild == VITRAIL_LIST_BUILD_COMPUTE};
}

Expected expectedFrame(const HostDesc& desc, std::span<const Point> points, bool hasPostDepthCoverage) {
  const bool postDepth = hasPostDepthCoverage && desc.postDepthCoverage;
  std::vector<PixelList> lists(std::size_t{desc.width} * desc.height);
  Expected expected;
  for (const Point& p : points) {
    const std::uint32_t passing = passingSamples(desc, p.depth) & p.coverage;
    if (passing == 0) continue; // the early depth test ends it
    const Fragment fragment{doubleColor(p.color), p.depth, p.blend, postDepth ? passing : p.coverage};
    const auto node = packNode(codingOf(desc), fragment);
    if (!node) continue;
    lists[std::size_t{p.y} * desc.width + p.x].nodes.push_back(*node);
    ++expected.fragments;
  }
  std::vector<Color> behind(desc.samples);
  for (std::uint32_t s = 0; s < desc.samples; ++s) behind[s] = doubleColor(behindAt(desc, s));
  expected.pixels.reserve(lists.size());
  for (PixelList& list : lists) {
    list.coding = codingOf(desc);
    list.maxLayers = desc.maxLayers;
    if (!postDepth && desc.samples > 1) list.opaqueDepth = desc.opaqueDepth;
    expected.layersMax = std::max(expected.layersMax, static_cast<std::uint32_t>(list.nodes.size()));
    if (!list.nodes.empty()) ++expected.coveredPixels;
    expected.pixels.push_back(resolvePixel(list, behind));
  }
  return expected;
}

std::vector<std::vector<VitrailLayer>> expectedLists(const HostDesc& desc, std::span<const Point> points) {
  struct Stored {
    SortKey key;
    VitrailLayer layer;
  };
  const NodeCoding coding = codingOf(desc);
  std::vector<std::vector<Stored>> stored(std::size_t{desc.width} * desc.height);
  for (const Point& p : points) {
    const auto node = packNode(coding, {doubleColor(p.color), p.depth, p.blend, p.coverage});
    if (!node) continue;
    const Fragment fragment = unpackNode(coding, *node);
    VitrailLayer layer{};
    for (unsigned i = 0; i < 4; ++i) layer.color[i] = static_cast<float>(fragment.color[i]);
    layer.depth = fragment.depth;
    layer.blend = fragment.blend;
    layer.coverage = fragment.coverage;
    layer.word = desc.userWords ? p.word : 0;
    stored[std::size_t{p.y} * desc.width + p.x].push_back({sortKey(coding, *node), layer});
  }
  std::vector<std::vector<VitrailLayer>> lists;
  lists.reserve(stored.size());
  for (std::vector<Stored>& list : stored) {
    std::sort(list.begin(), list.end(), [](const Stored& a, const Stored& b) {
      return std::tie(a.key, a.layer.word) < std::tie(b.key, b.layer.word);
    });
    std::vector<VitrailLayer>& layers = lists.emplace_back();
    for (const Stored& one : list) layers.push_back(one.layer);
  }
  return lists;
}

double largestError(std::span<const FloatColor> got, std::span<const Color> expected) {
  if (got.size() != expected.size()) return std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (unsigned c = 0; c < 4; ++c) {
      const double error = std::abs(double{got[i][c]} - expected[i][c]) / std::max(1.0, std::abs(expected[i][c]));
      if (std::isnan(error)) return std::numeric_limits<double>::infinity();
      worst = std::max(worst, error);
    }
  }
  return worst;
}

std::vector<Point> ordered(std::vector<Point> points, Order order) {
  if (order == Order::Reversed) std::reverse(points.begin(), points.end());
  if (order == Order::Shuffled) {
    std::mt19937 random(11);
    std::shuffle(points.begin(), points.end(), random);
  }
  return points;
}

std::vector<Point> randomLists(const HostDesc& desc, const std::vector<std::uint32_t>& lengths, unsigned seed,
                               const PointVariety& variety) {
  Dice dice(desc, seed, variety);
  std::vector<Point> points;
  for (std::uint32_t i = 0; i < lengths.size(); ++i) {
    std::vector<float> depths(lengths[i]);
    for (float& depth : depths) depth = dice.unit();
    std::sort(depths.begin(), depths.end());
    for (std::size_t k = 10; k < depths.size(); k += 10) depths[k] = depths[k - 1];
    const float largestAlpha = lengths[i] > 300 ? 0.0F : lengths[i] > 40 ? 0.06F : 1.0F;
    for (const float depth : depths) {
      Point point = dice.point(depth, largestAlpha);
      point.x = i % desc.width;
      point.y = i / desc.width;
      points.push_back(point);
    }
  }
  return points;
}

HostDesc squareHost() {
  HostDesc desc;
  desc.width = 64;
  desc.height = 64;
  desc.behind = {0.2F, 0.5F, 0.8F, 1.0F};
  return desc;
}

std::vector<Point> manyLists(const HostDesc& desc, std::uint32_t longest, unsigned seed) {
  std::vector<std::uint32_t> lengths(std::size_t{desc.width} * desc.height);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    lengths[i] = static_cast<std::uint32_t>((i * 2654435761U >> 7U) % (longest + 1));
  }
  return randomLists(desc, lengths, seed);
}

void apply(const Way& way, HostDesc& desc) {
  desc.resolve = way.resolve;
  desc.msaaResolve = way.msaaResolve;
  desc.stencilMark = way.stencilMark;
  desc.listBuild = way.listBuild;
}

std::vector<Way> everyWay(const Features& features, std::uint32_t samples) {
  constexpr VitrailMsaaResolve kPerPixel = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  constexpr VitrailMsaaResolve kPerSample = VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  constexpr VitrailListBuild kCompute = VITRAIL_LIST_BUILD_COMPUTE;
  std::vector<Way> ways = {{"compute", VITRAIL_RESOLVE_COMPUTE, kPerPixel, false},
                           {"compute, lists built by compute", VITRAIL_RESOLVE_COMPUTE, kPerPixel, false, kCompute},
                           {"fragment", VITRAIL_RESOLVE_FRAGMENT, kPerPixel, false}};
  if (samples == 1 && features.stencil) {
    ways.push_back(
        {"fragment with stencil mark, lists built by compute", VITRAIL_RESOLVE_FRAGMENT, kPerPixel, true, kCompute});
  }
  if (samples > 1 && features.sampleRateShading) {
    ways.push_back({"per sample", VITRAIL_RESOLVE_FRAGMENT, kPerSample, false});
    if (features.stencil) {
      ways.push_back({"per sample with stencil mark, lists built by compute", VITRAIL_RESOLVE_FRAGMENT, kPerSample,
                      true, kCompute});
    }
  }
  return ways;
}

std::vector<std::uint32_t> sampleCounts(const Features& features) {
  std::vector<std::uint32_t> counts = features.multisampled;
  counts.insert(counts.begin(), 1);
  return counts;
}

std::vector<VitrailNodeFormat> nodeFormats(std::uint32_t samples) {
  std::vector<VitrailNodeFormat> formats;
  for (const VitrailNodeFormat format : {VITRAIL_NODE_STANDARD, VITRAIL_NODE_COMPACT, VITRAIL_NODE_HDR}) {
    if (maxNodeIndexCount(static_cast<std::uint32_t>(format), samples) != 0) formats.push_back(format);
  }
  return formats;
}

} // namespace vitrail::tests
