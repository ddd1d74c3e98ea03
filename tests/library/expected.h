// What a point host must draw, in double precision; the points that tests draw, and the ways to draw them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "backend.h"
#include "reference/resolve.h"

namespace vitrail::tests {

NodeCoding codingOf(const HostDesc& desc);

// What a frame must be.
struct Expected {
  std::vector<Color> pixels;
  std::uint64_t fragments = 0;
  std::uint32_t layersMax = 0;
  std::uint32_t coveredPixels = 0;
};

// `hasPostDepthCoverage`: whether the device has it; the host uses it where it may.
Expected expectedFrame(const HostDesc& desc, std::span<const Point> points, bool hasPostDepthCoverage = true);

// The stored fragments of every pixel, in order.
std::vector<std::vector<VitrailLayer>> expectedLists(const HostDesc& desc, std::span<const Point> points);

// Averages are sums of integers in 1/65536, and transmittances sums of logarithms in 1/4096.
inline constexpr double kSumTolerance = 2e-3;

// The largest difference of a channel, relative where the expected value is above 1. A NaN is infinitely far.
double largestError(std::span<const FloatColor> got, std::span<const Color> expected);

// What single-precision blending and a device's pow() may add up to.
inline constexpr double kTolerance = 2e-5;

enum class Order { Forward, Reversed, Shuffled };
std::vector<Point> ordered(std::vector<Point> points, Order order);

// What random points may be.
struct PointVariety {
  bool blendModes = false; // all four, else over
  bool coverage = false;   // any samples, else all
  float brightest = 1.0F;
};

// Points for lists of the given lengths, list i on pixel i: random colours on the node format's own steps, so that
// storing them loses nothing, and random depths, of which each tenth is that of the one before it. Alphas are such that
// the last fragments of a list still show, where the format has such small ones.
std::vector<Point> randomLists(const HostDesc& desc, const std::vector<std::uint32_t>& lengths, unsigned seed,
                               const PointVariety& variety = {});

// The same on a picture of 64x64 pixels (squareHost()): lists of up to `longest` fragments, all lengths mixed.
HostDesc squareHost();
std::vector<Point> manyLists(const HostDesc& desc, std::uint32_t longest, unsigned seed);

// A way to resolve: fields of a host, and their names.
struct Way {
  std::string name;
  VitrailResolve resolve = VITRAIL_RESOLVE_COMPUTE;
  VitrailMsaaResolve msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  bool stencilMark = false;
  VitrailListBuild listBuild = VITRAIL_LIST_BUILD_FRAGMENT;
};
void apply(const Way& way, HostDesc& desc);

// All that there are on a device at a sample count; each list build with each resolve.
std::vector<Way> everyWay(const Features& features, std::uint32_t samples);

// 1 and what the device has of 2, 4 and 8.
std::vector<std::uint32_t> sampleCounts(const Features& features);

// The node formats that go with a sample count.
std::vector<VitrailNodeFormat> nodeFormats(std::uint32_t samples);

} // namespace vitrail::tests
