#include "encode.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace vitrail::tool {

namespace {

// Tables over the floats in [2^-13, 1): their upper bits, exponent and 7 bits of the mantissa, are the index. Below
// 2^-13 every 8-bit code is 0, and the curve is straight.
constexpr std::uint32_t kShift = 16;
constexpr std::uint32_t kFirst = 0x39000000U >> kShift; // 2^-13
constexpr std::uint32_t kEnd = 0x3f800000U >> kShift;   // 1
constexpr std::size_t kCells = kEnd - kFirst;
constexpr float kStraightEnd = 0.0031308F;
constexpr float kLeast = 0x1p-13F;

double curve(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double inverseCurve(double coded) {
  return coded <= 12.92 * 0.0031308 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
}

float startOf(std::size_t cell) { return std::bit_cast<float>(static_cast<std::uint32_t>((kFirst + cell) << kShift)); }

// The 8-bit codes: a cell is narrower than the steps of the codes, so that it has one threshold at most.
struct Codes {
  std::array<float, kCells> next{};         // from here on it is one more
  std::array<std::uint8_t, kCells> first{}; // the code at the cell's start

  Codes() {
    for (std::size_t i = 0; i < kCells; ++i) {
      const double code = std::floor(curve(startOf(i)) * 255.0 + 0.5);
      first[i] = static_cast<std::uint8_t>(code);
      next[i] = threshold(code + 1.0);
    }
  }

  // The smallest float that has a code.
  static float threshold(double code) {
    const double exact = inverseCurve((code - 0.5) / 255.0);
    const auto rounded = static_cast<float>(exact);
    return static_cast<double>(rounded) < exact ? std::nextafter(rounded, 2.0F) : rounded;
  }

  [[nodiscard]] std::uint8_t of(float linear) const {
    if (!(linear >= kLeast)) return 0; // a NaN too
    if (linear >= 1.0F) return 255;
    const std::size_t cell = (std::bit_cast<std::uint32_t>(linear) >> kShift) - kFirst;
    return static_cast<std::uint8_t>(first[cell] + (linear >= next[cell] ? 1 : 0));
  }
};

// The curve in pieces of a parabola through three points of each cell: off by at most 10^-7.
struct Curve {
  struct Piece {
    float start;
    float a, b, c; // a + b * d + c * d * d, d from the start
  };
  std::array<Piece, kCells> pieces{};

  Curve() {
    const auto bent = [](double linear) { return 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055; };
    for (std::size_t i = 0; i < kCells; ++i) {
      const double start = startOf(i);
      const double width = startOf(i + 1) - start;
      const double middle = bent(start + 0.5 * width);
      const double end = bent(start + width);
      const double slope = (4.0 * middle - 3.0 * bent(start) - end) / width;
      const double bend = 2.0 * (end + bent(start) - 2.0 * middle) / (width * width);
      pieces[i] = {startOf(i), static_cast<float>(bent(start)), static_cast<float>(slope), static_cast<float>(bend)};
    }
  }

  [[nodiscard]] float of(float linear) const {
    if (!(linear > 0.0F)) return 0.0F; // a NaN too
    if (linear <= kStraightEnd) return 12.92F * linear;
    if (linear >= 1.0F) return 1.0F;
    const Piece& piece = pieces[(std::bit_cast<std::uint32_t>(linear) >> kShift) - kFirst];
    const float d = linear - piece.start;
    return piece.a + d * (piece.b + d * piece.c);
  }
};

const Codes& codes() {
  static const Codes table;
  return table;
}

const Curve& curves() {
  static const Curve table;
  return table;
}

float saturate(float value) { return value > 0.0F ? std::min(value, 1.0F) : 0.0F; }

template <class Number>
Number quantize(float value) {
  return static_cast<Number>(value * static_cast<float>(static_cast<Number>(~Number{0})) + 0.5F);
}

// A pixel that light may reach through what alpha leaves free: of a reflection on glass, or a flame. What rounding puts
// between the colour and alpha is not beyond it.
template <class Number>
void encodeShining(const float* pixel, float alpha, Number* rgba) {
  constexpr auto kMost = static_cast<float>(static_cast<Number>(~Number{0}));
  std::array<float, 3> coded{};
  std::array<float, 3> light{};
  for (std::size_t i = 0; i < 3; ++i) {
    coded[i] = curves().of(alpha > 0.0F ? pixel[i] / alpha : 0.0F);
    light[i] = curves().of(std::max(pixel[i] - 1.002F * alpha, 0.0F) / std::max(1.0F - alpha, 1.0e-6F));
  }
  const float brightest = std::max({light[0], light[1], light[2]});
  if (brightest > 0.0F) {
    const float raised = std::ceil((alpha + (1.0F - alpha) * brightest) * kMost) / kMost;
    for (std::size_t i = 0; i < 3; ++i) coded[i] = (light[i] + (coded[i] - light[i]) * alpha) / raised;
    alpha = raised;
  }
  for (std::size_t i = 0; i < 3; ++i) rgba[i] = quantize<Number>(coded[i]);
  rgba[3] = quantize<Number>(alpha);
}

// To binary16, to the nearest, ties to even; what is too large becomes infinite.
std::uint16_t toHalf(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>((bits >> 16U) & 0x8000U);
  const std::uint32_t magnitude = bits & 0x7fffffffU;
  if (magnitude > 0x7f800000U) return 0; // a NaN
  if (magnitude >= 0x47800000U) return static_cast<std::uint16_t>(sign | 0x7c00U);
  if (magnitude < 0x38800000U) { // a subnormal: adding 0.5 leaves it in the last bits, rounded
    const float shifted = std::bit_cast<float>(magnitude) + 0.5F;
    return static_cast<std::uint16_t>(sign | (std::bit_cast<std::uint32_t>(shifted) - 0x3f000000U));
  }
  const std::uint32_t odd = (magnitude >> 13U) & 1U;
  return static_cast<std::uint16_t>(sign | ((magnitude - 0x38000000U + 0xfffU + odd) >> 13U));
}

} // namespace

void encodePixels(const float* linear, std::size_t count, std::uint8_t* rgba) {
  const Codes& table = codes();
  for (std::size_t i = 0; i < count; ++i, linear += 4, rgba += 4) {
    if (linear[3] >= 1.0F) { // nearly all pixels
      for (std::size_t channel = 0; channel < 3; ++channel) rgba[channel] = table.of(linear[channel]);
      rgba[3] = 255;
    } else {
      encodeShining(linear, saturate(linear[3]), rgba);
    }
  }
}

void encodePixels(const float* linear, std::size_t count, Encoding encoding, std::uint16_t* rgba) {
  if (encoding == Encoding::Linear) {
    for (std::size_t i = 0; i < 4 * count; ++i) rgba[i] = toHalf(linear[i]);
    return;
  }
  const Curve& curve = curves();
  for (std::size_t i = 0; i < count; ++i, linear += 4, rgba += 4) {
    if (linear[3] >= 1.0F) {
      for (std::size_t channel = 0; channel < 3; ++channel)
        rgba[channel] = quantize<std::uint16_t>(curve.of(linear[channel]));
      rgba[3] = 65535;
    } else {
      encodeShining(linear, saturate(linear[3]), rgba);
    }
  }
}

} // namespace vitrail::tool
