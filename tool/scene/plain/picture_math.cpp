// Makes pictures that a material needs out of those that a file names.
#include "picture_math.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace vitrail::tool {
namespace {

std::uint8_t toByte(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
}

const std::uint8_t* pixel(const Image& image, std::size_t x, std::size_t y) {
  return image.rgba.data() + 4 * (y * image.width + x);
}

std::uint8_t channelOf(const std::uint8_t* rgba, char channel) {
  switch (channel) {
    case 'r':
      return rgba[0];
    case 'g':
      return rgba[1];
    case 'b':
      return rgba[2];
    case 'm':
      return rgba[3];
    default: // the weights of Rec. 709
      return static_cast<std::uint8_t>((54U * rgba[0] + 183U * rgba[1] + 19U * rgba[2] + 128U) / 256U);
  }
}

// The channel at a place of a picture of another size.
std::uint8_t sample(const Image& image, char channel, std::size_t x, std::size_t y, const Image& grid) {
  return channelOf(pixel(image, x * image.width / grid.width, y * image.height / grid.height), channel);
}

Image blank(std::uint32_t width, std::uint32_t height) {
  return {width, height, std::vector<std::uint8_t>(std::size_t{width} * height * 4, 255)};
}

} // namespace

char usedChannel(const Image& image, char channel) {
  if (channel != '\0') return channel;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    if (image.rgba[i] != 255) return 'm';
  return 'l';
}

Image rescaled(Image image, float base, float gain) {
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    if (i % 4 != 3) image.rgba[i] = toByte(base + gain * static_cast<float>(image.rgba[i]) / 255.0F);
  return image;
}

Image withAlpha(const Image* colors, const Image& alpha, char channel) {
  const Image& first = colors == nullptr ? alpha : *colors;
  Image result = blank(std::max(first.width, alpha.width), std::max(first.height, alpha.height));
  std::uint8_t* out = result.rgba.data();
  for (std::size_t y = 0; y < result.height; ++y)
    for (std::size_t x = 0; x < result.width; ++x, out += 4) {
      if (colors != nullptr)
        std::copy_n(pixel(*colors, x * colors->width / result.width, y * colors->height / result.height), 3, out);
      out[3] = sample(alpha, channel, x, y, result);
    }
  return result;
}

Image metallicRoughnessImage(const Image* roughness, char roughnessChannel, const Image* metallic,
                             char metallicChannel) {
  const Image& first = roughness == nullptr ? *metallic : *roughness;
  const Image& second = metallic == nullptr ? first : *metallic;
  Image result = blank(std::max(first.width, second.width), std::max(first.height, second.height));
  std::uint8_t* out = result.rgba.data();
  for (std::size_t y = 0; y < result.height; ++y)
    for (std::size_t x = 0; x < result.width; ++x, out += 4) {
      if (roughness != nullptr) out[1] = sample(*roughness, roughnessChannel, x, y, result);
      if (metallic != nullptr) out[2] = sample(*metallic, metallicChannel, x, y, result);
    }
  return result;
}

bool looksLikeNormals(const Image& image) {
  std::size_t directions = 0;
  std::size_t pixels = 0;
  const std::size_t step = std::max<std::size_t>(image.rgba.size() / 4 / 65536, 1);
  for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4 * step, ++pixels) {
    const glm::vec3 direction = glm::vec3(image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]) / 127.5F - 1.0F;
    const float length = glm::length(direction);
    if (length > 0.8F && length < 1.2F && direction.z > 0.0F) ++directions;
  }
  return directions * 10 > pixels * 8;
}

Image normalsFromHeights(const Image& heights, char channel, float strength) {
  const std::size_t width = heights.width;
  const std::size_t height = heights.height;
  const auto at = [&](std::size_t x, std::size_t y) {
    return static_cast<float>(channelOf(pixel(heights, x % width, y % height), channel)) / 255.0F;
  };
  const float scale = 0.5F * strength * 0.01F * static_cast<float>(width);
  Image normals = blank(heights.width, heights.height);
  std::uint8_t* out = normals.rgba.data();
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x, out += 4) {
      // Rows run downwards, and a normal map's green upwards.
      const glm::vec3 normal = glm::normalize(glm::vec3(scale * (at(x + width - 1, y) - at(x + 1, y)),
                                                        scale * (at(x, y + 1) - at(x, y + height - 1)), 1.0F));
      for (int c = 0; c < 3; ++c) out[c] = toByte(0.5F + 0.5F * normal[c]);
    }
  return normals;
}

} // namespace vitrail::tool
