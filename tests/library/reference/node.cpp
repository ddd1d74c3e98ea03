#include "node.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/pool.h"

namespace vitrail {

namespace {

constexpr std::uint32_t kOneBits = std::bit_cast<std::uint32_t>(1.0F);
constexpr std::uint32_t kDepthMask = 0x3fffffffU; // below the blend mode
constexpr double kHalfLargest = 65504.0;

double clampTo(double value, double largest) { return std::isnan(value) ? 0.0 : std::clamp(value, 0.0, largest); }

// The nearest of the steps 0 to `largest` of [0, 1].
std::uint32_t quantize(double value, std::uint32_t largest) {
  return static_cast<std::uint32_t>(std::lround(clampTo(value, 1.0) * largest));
}

std::uint32_t quantizeCurve(double linear, std::uint32_t largest) {
  return quantize(linearToSrgb(clampTo(linear, 1.0)), largest);
}

// What is left of a linear value that a compute pass puts on the curve: of the float of value + 2^-7 the first 8 bits
// of fraction, of blue 7, and the middle of what they leave open.
double asLooseNode(double value, bool blue) {
  constexpr float kBias = 0x1p-7F;
  const unsigned dropped = blue ? 16 : 15;
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(clampTo(value, 1.0)) + kBias) >> dropped;
  if (bits == std::bit_cast<std::uint32_t>(kBias) >> dropped) return 0.0;
  const auto middle = std::bit_cast<float>((bits << dropped) + (1U << (dropped - 1U)));
  return std::min(middle - kBias, 1.0F);
}

double decodeCurve(std::uint32_t step, std::uint32_t largest) {
  return srgbToLinear(static_cast<double>(step) / largest);
}

std::uint32_t bitsOf(std::uint32_t word, unsigned first, unsigned count) {
  return (word >> first) & ((1U << count) - 1U);
}

float storedDepth(float depth, bool nearestIsOne) {
  if (std::isnan(depth)) return nearestIsOne ? 0.0F : 1.0F;
  return std::abs(std::clamp(depth, 0.0F, 1.0F)); // -0.0 is 0.0
}

std::uint32_t coverageMask(std::uint32_t samples) { return (1U << samples) - 1U; }

// ---- The compact format's parts

// Its depth code is a float of the distance to the far plane without its sign, with the exponents 2^-31 to 2^0.
constexpr std::uint32_t kCodeBase = std::bit_cast<std::uint32_t>(0x1p-31F);

struct CompactBits {
  std::uint32_t red, green, blue, alpha, code;
  [[nodiscard]] std::uint32_t rgb() const { return red + green + blue; }
  [[nodiscard]] std::uint32_t droppedOfFloat() const { return 23 + 5 - code; } // of a float's 23 bits of fraction
  [[nodiscard]] std::uint32_t largestCode() const { return (1U << code) - 1U; }
};

CompactBits compactBits(const NodeCoding& coding) {
  return coding.samples == 1 ? CompactBits{5, 6, 5, 6, 16} : CompactBits{5, 5, 5, 5, 14};
}

std::uint32_t largest(std::uint32_t bits) { return (1U << bits) - 1U; }

std::uint32_t encodeDepth(const NodeCoding& coding, float depth) {
  const CompactBits bits = compactBits(coding);
  const float stored = storedDepth(depth, coding.nearestIsOne);
  const float nearness = coding.nearestIsOne ? stored : 1.0F - stored;
  const auto float32 = std::bit_cast<std::uint32_t>(nearness);
  if (float32 < kCodeBase) return 0;
  const std::uint32_t half = 1U << (bits.droppedOfFloat() - 1U);
  return std::min((float32 - kCodeBase + half) >> bits.droppedOfFloat(), bits.largestCode());
}

float decodeDepth(const NodeCoding& coding, std::uint32_t code) {
  const float nearness =
      code == 0 ? 0.0F : std::bit_cast<float>(kCodeBase + (code << compactBits(coding).droppedOfFloat()));
  return coding.nearestIsOne ? nearness : 1.0F - nearness;
}

// A compact node taken apart.
struct CompactFields {
  std::uint32_t red, green, blue, alpha, code, coverage, blend;
};

CompactFields compactFields(const NodeCoding& coding, const NodeWords& words) {
  const auto [word, next, unused2, unused3] = words;
  const std::uint32_t blend = next >> 30U;
  if (coding.samples == 1) {
    return {bitsOf(word, 0, 5), bitsOf(word, 5, 6), bitsOf(word, 11, 5), bitsOf(next, 24, 6), word >> 16U, 1, blend};
  }
  const std::uint32_t alpha = bitsOf(next, 28, 2) << 3U | bitsOf(word, 15, 3);
  return {bitsOf(word, 0, 5), bitsOf(word, 5, 5), bitsOf(word, 10, 5), alpha, word >> 18U, bitsOf(next, 24, 4), blend};
}

NodeWords packCompact(const NodeCoding& coding, const Fragment& fragment) {
  const CompactBits bits = compactBits(coding);
  const std::uint32_t rgb = quantizeCurve(fragment.color[0], largest(bits.red)) |
                            quantizeCurve(fragment.color[1], largest(bits.green)) << bits.red |
                            quantizeCurve(fragment.color[2], largest(bits.blue)) << (bits.red + bits.green);
  const std::uint32_t alpha = quantize(fragment.color[3], largest(bits.alpha));
  const std::uint32_t code = encodeDepth(coding, fragment.depth);
  const std::uint32_t blend = fragment.blend << 30U;
  if (coding.samples == 1) return {rgb | code << 16U, alpha << 24U | blend};
  return {rgb | (alpha & 7U) << 15U | code << 18U, fragment.coverage << 24U | (alpha >> 3U) << 28U | blend};
}

Fragment unpackCompact(const NodeCoding& coding, const NodeWords& words) {
  const CompactBits bits = compactBits(coding);
  const CompactFields f = compactFields(coding, words);
  Fragment fragment;
  fragment.color = {decodeCurve(f.red, largest(bits.red)), decodeCurve(f.green, largest(bits.green)),
                    decodeCurve(f.blue, largest(bits.blue)), static_cast<double>(f.alpha) / largest(bits.alpha)};
  fragment.depth = decodeDepth(coding, f.code);
  fragment.blend = f.blend;
  fragment.coverage = f.coverage;
  return fragment;
}

// ---- The other two, which share their depth and next words

NodeWords packFull(const NodeCoding& coding, const Fragment& fragment) {
  const std::uint32_t depth =
      std::bit_cast<std::uint32_t>(storedDepth(fragment.depth, coding.nearestIsOne)) | fragment.blend << 30U;
  const std::uint32_t next = coding.samples == 1 ? 0 : fragment.coverage << indexBits(coding.format, coding.samples);
  Color c = fragment.color;
  if (coding.format == layout::VITRAIL_FORMAT_STANDARD) {
    const bool rounded = coding.builtByCompute && coding.samples == 1;
    for (unsigned i = 0; rounded && i < 3; ++i) c[i] = asLooseNode(c[i], i == 2);
    return {quantizeCurve(c[0], 255) | quantizeCurve(c[1], 255) << 8U | quantizeCurve(c[2], 255) << 16U |
                quantize(c[3], 255) << 24U,
            depth, next};
  }
  const auto half = [&](unsigned i) { return toHalf(clampTo(c[i], kHalfLargest)); };
  return {half(0) | half(1) << 16U, half(2) | quantize(std::sqrt(std::clamp(c[3], 0.0, 1.0)), 65535) << 16U, depth,
          next};
}

Fragment unpackFull(const NodeCoding& coding, const NodeWords& words) {
  const bool standard = coding.format == layout::VITRAIL_FORMAT_STANDARD;
  const std::uint32_t depth = words[standard ? 1 : 2];
  const std::uint32_t next = words[standard ? 2 : 3];
  Fragment fragment;
  if (standard) {
    for (unsigned i = 0; i < 3; ++i) fragment.color[i] = decodeCurve(bitsOf(words[0], 8 * i, 8), 255);
    fragment.color[3] = (words[0] >> 24U) / 255.0;
  } else {
    const double root = (words[1] >> 16U) / 65535.0;
    fragment.color = {fromHalf(words[0] & 0xffffU), fromHalf(words[0] >> 16U), fromHalf(words[1] & 0xffffU),
                      root * root};
  }
  fragment.depth = std::bit_cast<float>(depth & kDepthMask);
  fragment.blend = depth >> 30U;
  fragment.coverage = coding.samples == 1 ? 1 : next >> indexBits(coding.format, coding.samples);
  return fragment;
}

bool isCompact(const NodeCoding& coding) { return coding.format == layout::VITRAIL_FORMAT_COMPACT; }

// Whether a stored fragment changes what is behind it.
bool changesSomething(const Fragment& stored) {
  if (stored.color[3] > 0.0) return true;
  return stored.blend == layout::VITRAIL_PREMULTIPLIED &&
         std::max({stored.color[0], stored.color[1], stored.color[2]}) > 0.0;
}

} // namespace

double linearToSrgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double srgbToLinear(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

// A half with exponent e has steps of 2^(e - 10); below 2^-14 all have that of 2^-14. Its bits count the steps from 0.
std::uint32_t toHalf(double value) {
  const int exponent = value < 0x1p-14 ? -14 : std::ilogb(value);
  const auto steps = static_cast<std::uint32_t>(std::nearbyint(std::ldexp(value, 10 - exponent)));
  return static_cast<std::uint32_t>(exponent + 14) * 1024U + steps;
}

double fromHalf(std::uint32_t bits) {
  const std::uint32_t fraction = bits & 0x3ffU;
  const int exponent = static_cast<int>((bits >> 10U) & 0x1fU);
  return exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
}

std::optional<NodeWords> packNode(const NodeCoding& coding, const Fragment& fragment) {
  Fragment covering = fragment;
  covering.coverage &= coverageMask(coding.samples);
  if (covering.coverage == 0) return std::nullopt;
  const NodeWords words = isCompact(coding) ? packCompact(coding, covering) : packFull(coding, covering);
  if (!changesSomething(unpackNode(coding, words))) return std::nullopt;
  return words;
}

Fragment unpackNode(const NodeCoding& coding, const NodeWords& words) {
  return isCompact(coding) ? unpackCompact(coding, words) : unpackFull(coding, words);
}

SortKey sortKey(const NodeCoding& coding, const NodeWords& words) {
  if (isCompact(coding)) {
    const CompactBits bits = compactBits(coding);
    const CompactFields f = compactFields(coding, words);
    const std::uint32_t coverage = coding.samples == 1 ? 0 : f.coverage;
    const std::uint32_t coverageWidth = coverageBits(coding.samples);
    const std::uint32_t rest = ((f.blend << bits.alpha | f.alpha) << coverageWidth | coverage) << bits.rgb() |
                               (words[0] & largest(bits.rgb()));
    return {bits.largestCode() - f.code, rest};
  }
  const bool standard = coding.format == layout::VITRAIL_FORMAT_STANDARD;
  const std::uint32_t depth = words[standard ? 1 : 2];
  const std::uint32_t away = coding.nearestIsOne ? kOneBits - (depth & kDepthMask) : depth & kDepthMask;
  const std::uint32_t first = away << 2U | depth >> 30U;
  const std::uint32_t coverage =
      coding.samples == 1 ? 0 : words[standard ? 2 : 3] >> indexBits(coding.format, coding.samples);
  if (standard) return {first, words[0], coverage};
  return {first, words[0], words[1], coverage};
}

std::uint32_t depthKey(const NodeCoding& coding, float depth) {
  if (isCompact(coding)) return compactBits(coding).largestCode() - encodeDepth(coding, depth);
  const auto bits = std::bit_cast<std::uint32_t>(storedDepth(depth, coding.nearestIsOne));
  return coding.nearestIsOne ? kOneBits - bits : bits;
}

} // namespace vitrail
