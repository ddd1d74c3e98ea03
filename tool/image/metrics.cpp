#include "metrics.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "../scene/srgb.h"
#include "ssim.h"

namespace vitrail::tool {

namespace {

constexpr std::array<int, 2> kBackdrops{0, 255};

std::uint8_t encoded(double linear) {
  const double value = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(value * 255.0));
}

// The picture over a grey of that code.
Picture overBackdrop(const Picture& picture, int code) {
  std::array<double, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = linearFromSrgb(static_cast<double>(i) / 255.0);
  Picture result = picture;
  result.hasAlpha = false;
  const double behind = linear[static_cast<std::size_t>(code)];
  for (std::size_t pixel = 0; pixel < picture.rgba.size(); pixel += 4) {
    const double alpha = picture.rgba[pixel + 3] / 255.0;
    result.rgba[pixel + 3] = 255;
    if (picture.rgba[pixel + 3] == 255) continue;
    for (std::size_t c = pixel; c < pixel + 3; ++c) {
      result.rgba[c] = encoded(alpha * linear[picture.rgba[c]] + (1.0 - alpha) * behind);
    }
  }
  return result;
}

// Of opaque pictures: alphas are equal and add nothing.
double psnrOf(const Picture& a, const Picture& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const double difference = static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]);
    squares += difference * difference;
  }
  if (squares == 0.0) return std::numeric_limits<double>::infinity();
  const double values = static_cast<double>(a.rgba.size()) / 4.0 * 3.0;
  return 10.0 * std::log10(255.0 * 255.0 * values / squares);
}

// Fills in the worst pixel and the share that is off.
void addPixels(const Picture& a, const Picture& b, Metrics& metrics) {
  std::size_t off = 0;
  const std::size_t pixels = a.rgba.size() / 4;
  for (std::size_t i = 0; i < pixels; ++i) {
    int difference = 0;
    for (std::size_t c = i * 4; c < i * 4 + 3; ++c) {
      difference = std::max(difference, std::abs(int{a.rgba[c]} - int{b.rgba[c]}));
    }
    if (difference > kOffBound) ++off;
    if (difference <= metrics.worst) continue;
    metrics.worst = difference;
    metrics.worstX = static_cast<std::uint32_t>(i % a.width);
    metrics.worstY = static_cast<std::uint32_t>(i / a.width);
  }
  metrics.offShare = static_cast<double>(off) / static_cast<double>(pixels);
}

double meanOf(const Plane& plane) {
  double sum = 0.0;
  for (const double value : plane.values) sum += value;
  return sum / static_cast<double>(plane.values.size());
}

// Keeps the worse of each measure.
void worsen(Difference& difference, const Difference& other) {
  Metrics& metrics = difference.metrics;
  metrics.psnr = std::min(metrics.psnr, other.metrics.psnr);
  metrics.ssim = std::min(metrics.ssim, other.metrics.ssim);
  metrics.flip = std::max(metrics.flip, other.metrics.flip);
  metrics.offShare = std::max(metrics.offShare, other.metrics.offShare);
  if (other.metrics.worst > metrics.worst) {
    metrics.worst = other.metrics.worst;
    metrics.worstX = other.metrics.worstX;
    metrics.worstY = other.metrics.worstY;
  }
  for (std::size_t i = 0; i < difference.flip.values.size(); ++i) {
    difference.flip.values[i] = std::max(difference.flip.values[i], other.flip.values[i]);
  }
}

} // namespace

struct ComparedPicture::Seen {
  explicit Seen(Picture source) : picture(std::move(source)), flip(flipPicture(picture)) {}
  Picture picture;
  FlipPicture flip;
};

ComparedPicture::ComparedPicture(const Picture& picture) : picture_(picture) {}
ComparedPicture::~ComparedPicture() = default;

const ComparedPicture::Seen& ComparedPicture::over(int backdrop) const {
  std::unique_ptr<Seen>& seen = seen_.at(static_cast<std::size_t>(backdrop));
  if (!seen) {
    seen = std::make_unique<Seen>(overBackdrop(picture_, kBackdrops.at(static_cast<std::size_t>(backdrop))));
  }
  return *seen;
}

Difference ComparedPicture::differenceTo(const Picture& test) const {
  if (test.width != picture_.width || test.height != picture_.height) {
    throw std::invalid_argument(fmt::format("the pictures have different sizes: {}x{} and {}x{}", picture_.width,
                                            picture_.height, test.width, test.height));
  }
  const auto compareOver = [&](int backdrop) {
    const Seen& expected = over(backdrop);
    const Seen seen(overBackdrop(test, kBackdrops.at(static_cast<std::size_t>(backdrop))));
    Difference result;
    result.flip = flipErrors(expected.flip, seen.flip);
    result.metrics.psnr = psnrOf(expected.picture, seen.picture);
    result.metrics.ssim = ssim(expected.picture, seen.picture);
    result.metrics.flip = meanOf(result.flip);
    addPixels(expected.picture, seen.picture, result.metrics);
    return result;
  };
  Difference result = compareOver(0);
  if (picture_.hasAlpha || test.hasAlpha) worsen(result, compareOver(1));
  return result;
}

} // namespace vitrail::tool
