#include "reference.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "raster/clip.h"

namespace vitrail::tests::raster {

namespace {

using vitrail::raster::ClipVertex;
using vitrail::raster::Edges;
using vitrail::raster::Piece;
using vitrail::raster::Pieces;
using vitrail::raster::Viewport;

// Depths that are nearer to each other are in an order that floats decide.
constexpr double kDepthNoise = 2e-6;

// Pixels that are less certain are not compared.
constexpr double kMostNoise = 1e-3;

struct Part { // of a primitive
  Piece piece;
  Edges edges;
  std::uint32_t draw = 0;
  std::uint32_t primitive = 0;
};

struct Layer {
  double depth = 0.0;
  std::uint32_t samples = 0;
  Blended pair;
};

// Of one sample.
struct Nearest {
  double depth = 1.0; // of the opaque surface, as distances: larger is farther
  Color color{};
};

ClipVertex vertexOf(const VitrailCpuDraw& draw, std::uint32_t corner) {
  const std::uint32_t index = draw.indices != nullptr ? draw.indices[corner] : corner;
  const std::uint32_t components = draw.components == 0 ? 4 : draw.components;
  const std::size_t stride = draw.vertexStride == 0 ? components * sizeof(float) : draw.vertexStride;
  std::array<float, 4> p{0.0F, 0.0F, 0.0F, 1.0F};
  std::memcpy(p.data(), reinterpret_cast<const unsigned char*>(draw.positions) + stride * index,
              components * sizeof(float));
  // Sums from w to x, in floats: corners have to be the same to the bit.
  const auto sum = [](const std::array<float, 4>& m, const std::array<float, 4>& v) {
    return ((m[3] * v[3] + m[2] * v[2]) + m[1] * v[1]) + m[0] * v[0];
  };
  if (const float* m = draw.model) {
    p = {sum({m[0], m[1], m[2], m[3]}, p), sum({m[4], m[5], m[6], m[7]}, p), sum({m[8], m[9], m[10], m[11]}, p), p[3]};
  }
  ClipVertex vertex;
  vertex.position = p;
  for (std::size_t row = 0; draw.transform != nullptr && row < 4; ++row) {
    const float* m = draw.transform + row;
    vertex.position[row] = sum({m[0], m[4], m[8], m[12]}, p);
  }
  for (std::size_t i = 0; i < draw.clipPlaneCount; ++i) {
    const float* plane = draw.clipPlanes + 4 * i;
    vertex.distances[i] = sum({plane[0], plane[1], plane[2], plane[3]}, p);
  }
  return vertex;
}

Pieces piecesOf(const Viewport& viewport, const VitrailCpuDraw& draw, std::uint32_t primitive) {
  const std::uint32_t planes = draw.clipPlaneCount;
  if (draw.topology == VITRAIL_CPU_POINTS) {
    return vitrail::raster::pointOf(viewport, vertexOf(draw, primitive), planes,
                                    draw.pointSize == 0.0F ? 1.0F : draw.pointSize);
  }
  if (draw.topology == VITRAIL_CPU_LINES) {
    std::array<ClipVertex, 2> line{vertexOf(draw, 2 * primitive), vertexOf(draw, 2 * primitive + 1)};
    line[1].second = 1.0F;
    return vitrail::raster::lineOf(viewport, line, planes);
  }
  std::array<ClipVertex, 3> triangle{vertexOf(draw, 3 * primitive), vertexOf(draw, 3 * primitive + 1),
                                     vertexOf(draw, 3 * primitive + 2)};
  triangle[1].second = 1.0F;
  triangle[2].third = 1.0F;
  return vitrail::raster::clipped(viewport, triangle, planes);
}

std::vector<Part> partsOf(const Scene& scene, const Viewport& viewport) {
  std::vector<Part> parts;
  for (std::uint32_t d = 0; d < scene.draws.size(); ++d) {
    const VitrailCpuDraw& draw = scene.draws[d]->desc;
    const std::uint32_t corners = draw.topology == VITRAIL_CPU_POINTS ? 1 : draw.topology == VITRAIL_CPU_LINES ? 2 : 3;
    const std::uint32_t count = (draw.indices != nullptr ? draw.indexCount : draw.vertexCount) / corners;
    for (std::uint32_t primitive = 0; primitive < count; ++primitive) {
      const Pieces pieces = piecesOf(viewport, draw, primitive);
      for (const Piece& piece : pieces.all()) {
        Part part{piece, vitrail::raster::edgesOf(piece.corners[0], piece.corners[1], piece.corners[2]), d, primitive};
        const bool isCulled = draw.topology == VITRAIL_CPU_TRIANGLES &&
                              draw.cull == (part.edges.front ? VITRAIL_CPU_CULL_FRONT : VITRAIL_CPU_CULL_BACK);
        if (part.edges.area > 0 && !isCulled) parts.push_back(part);
      }
    }
  }
  return parts;
}

// The shares of a part's corners at a place in 1/256 of a pixel, straight on the picture.
std::array<double, 3> sharesAt(const Part& part, std::int64_t x, std::int64_t y) {
  std::array<double, 3> shares{};
  for (std::size_t i = 0; i < 3; ++i) {
    shares[i] = static_cast<double>(part.edges.edge[i].at(x, y)) / static_cast<double>(part.edges.area);
  }
  return shares;
}

double depthAt(const Part& part, const std::array<double, 3>& shares) {
  double depth = 0.0;
  for (std::size_t i = 0; i < 3; ++i) depth += shares[i] * double{part.piece.corners[i].depth};
  return std::clamp(depth, 0.0, 1.0);
}

// Colours as hosts may hand them over become those that are blended.
double clampTo(double v, double most) { return v > 0.0 ? std::min(v, most) : 0.0; }

Blended pairOf(const VitrailCpuDraw& draw, const Surface<double>& s) {
  Fragment fragment{};
  for (std::size_t c = 0; c < 3; ++c) fragment.color[c] = clampTo(s.color[c], 65504.0);
  fragment.color[3] = clampTo(s.color[3], 1.0);
  fragment.blend = static_cast<std::uint32_t>(draw.blend);
  Blended pair = blendOf(fragment);
  if ((draw.shadeFlags & VITRAIL_CPU_SHADE_FILTER) != 0) {
    for (std::size_t c = 0; c < 3; ++c) pair.transmittance[c] *= s.filter[c];
  }
  return pair;
}

class PixelReference {
 public:
  PixelReference(const Scene& scene, const std::vector<Part>& parts, std::uint32_t x, std::uint32_t y)
      : scene_(scene), parts_(parts), x_(x), y_(y), samples_(scene.frame.samples), nearest_(samples_) {}

  void draw(Expected& expected);

 private:
  std::size_t pixel() const { return std::size_t{y_} * scene_.frame.width + x_; }
  // Distances from the viewer, whichever depth is nearest.
  double distanceOf(double depth) const {
    return scene_.frame.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? 1.0 - depth : depth;
  }
  std::array<double, 3> centreShares(const Part& part) const {
    return sharesAt(part, std::int64_t{x_} * 256 + 128, std::int64_t{y_} * 256 + 128);
  }
  Surface<double> surfaceOf(const Part& part) const;
  double sampleDistance(const Part& part, std::uint32_t sample) const;
  void readBehind();
  void addOpaque(const Part& part, std::uint32_t covered);
  void addTransparent(const Part& part, std::uint32_t covered);
  // A centre far out of a sliver, or corners of very different w: what is off by a rounding is off by many times that.
  void judge(const Part& part, const Surface<double>& s) {
    const std::array<double, 3> shares = centreShares(part);
    double share = 1.0;
    double most = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double w = double{part.piece.corners[i].inverseW};
      share = std::max(share, std::fabs(shares[i]));
      most = std::max(most, w);
      sum += shares[i] * w;
    }
    noise_ += 0x1.0p-21 * share * most / std::fabs(sum) * std::max({1.0, std::fabs(s.second), std::fabs(s.third)});
  }
  void compare(double a, double b) { isUndecided_ = isUndecided_ || std::fabs(a - b) < kDepthNoise; }
  Color blend();

  const Scene& scene_;
  const std::vector<Part>& parts_;
  std::uint32_t x_;
  std::uint32_t y_;
  std::uint32_t samples_;
  std::vector<Nearest> nearest_;
  std::vector<Layer> layers_;
  bool isUndecided_ = false;
  double noise_ = 0.0;
  std::pair<std::uint32_t, std::uint32_t> lastOpaque_{~0U, 0}; // draw and primitive
};

Surface<double> PixelReference::surfaceOf(const Part& part) const {
  const std::array<double, 3> shares = centreShares(part);
  const Piece& piece = part.piece;
  double sum = 0.0;
  Surface<double> s;
  for (std::size_t i = 0; i < 3; ++i) {
    const double weight = shares[i] * double{piece.corners[i].inverseW};
    sum += weight;
    s.second += weight * double{piece.second[i]};
    s.third += weight * double{piece.third[i]};
  }
  s.second /= sum;
  s.third /= sum;
  s.x = scene_.frame.originX + x_;
  s.y = scene_.frame.originY + y_;
  s.triangle = part.primitive;
  s.front = part.edges.front;
  s.depth = depthAt(part, shares);
  const SceneDraw& draw = *scene_.draws[part.draw];
  if (draw.desc.shade == nullptr) {
    for (std::size_t c = 0; c < 4; ++c) s.color[c] = double{draw.desc.color[c]};
  } else {
    draw.material.shade(s);
    s.discarded = s.discarded && (draw.desc.shadeFlags & VITRAIL_CPU_SHADE_DISCARD) != 0;
  }
  return s;
}

double PixelReference::sampleDistance(const Part& part, std::uint32_t sample) const {
  const auto place = vitrail::raster::samplePlaces(samples_)[sample];
  return distanceOf(
      depthAt(part, sharesAt(part, std::int64_t{x_} * 256 + place.x * 16, std::int64_t{y_} * 256 + place.y * 16)));
}

void PixelReference::readBehind() {
  for (std::uint32_t s = 0; s < samples_; ++s) {
    const float* color = scene_.sampleColors.empty() ? &scene_.background[pixel() * 4]
                                                     : &scene_.sampleColors[(pixel() * samples_ + s) * 4];
    for (std::size_t c = 0; c < 4; ++c) nearest_[s].color[c] = double{color[c]};
    nearest_[s].depth = scene_.depth.empty() ? 2.0 : distanceOf(double{scene_.depth[pixel() * samples_ + s]});
  }
}

void PixelReference::addOpaque(const Part& part, std::uint32_t covered) {
  const Surface<double> surface = surfaceOf(part);
  if (surface.discarded) return;
  judge(part, surface);
  // Of two parts of a primitive in one pixel either may be shaded for both; their corners are rounded.
  if (samples_ > 1 && lastOpaque_ == std::pair(part.draw, part.primitive)) noise_ += 2.0 * kMostNoise;
  lastOpaque_ = {part.draw, part.primitive};
  for (std::uint32_t s = 0; s < samples_; ++s) {
    if ((covered >> s & 1U) == 0) continue;
    const double distance = sampleDistance(part, s);
    compare(distance, nearest_[s].depth);
    if (distance > nearest_[s].depth) continue;
    nearest_[s].depth = distance;
    for (std::size_t c = 0; c < 3; ++c) nearest_[s].color[c] = clampTo(surface.color[c], 65504.0);
    nearest_[s].color[3] = 1.0;
  }
}

void PixelReference::addTransparent(const Part& part, std::uint32_t covered) {
  const Surface<double> surface = surfaceOf(part);
  if (surface.discarded) return;
  judge(part, surface);
  Layer layer;
  layer.depth = distanceOf(surface.depth);
  for (std::uint32_t s = 0; s < samples_; ++s) {
    if ((covered >> s & 1U) == 0) continue;
    const double distance = sampleDistance(part, s);
    compare(distance, nearest_[s].depth);
    if (distance <= nearest_[s].depth) layer.samples |= 1U << s;
  }
  if (layer.samples == 0) return;
  layer.pair = pairOf(scene_.draws[part.draw]->desc, surface);
  layers_.push_back(layer);
}

Color PixelReference::blend() {
  std::stable_sort(layers_.begin(), layers_.end(), [](const Layer& a, const Layer& b) { return a.depth < b.depth; });
  for (std::size_t i = 1; i < layers_.size(); ++i) {
    for (std::size_t j = i; j-- > 0 && layers_[i].depth - layers_[j].depth < kDepthNoise;) {
      isUndecided_ = isUndecided_ || (layers_[i].samples & layers_[j].samples) != 0;
    }
  }
  Color mean{};
  for (std::uint32_t s = 0; s < samples_; ++s) {
    Blended all;
    for (const Layer& layer : layers_) {
      if ((layer.samples >> s & 1U) != 0) all = compose(all, layer.pair);
    }
    const Color color = over(all, nearest_[s].color);
    for (std::size_t c = 0; c < 4; ++c) mean[c] += color[c] / samples_;
  }
  return mean;
}

void PixelReference::draw(Expected& expected) {
  readBehind();
  for (const VitrailCpuSurface surface : {VITRAIL_CPU_OPAQUE, VITRAIL_CPU_TRANSPARENT}) {
    for (const Part& part : parts_) {
      if (scene_.draws[part.draw]->desc.surface != surface) continue;
      const std::uint32_t covered = vitrail::raster::coverage(part.edges, x_, y_, samples_);
      if (covered == 0) continue;
      if (surface == VITRAIL_CPU_OPAQUE) {
        addOpaque(part, covered);
      } else {
        addTransparent(part, covered);
      }
    }
  }
  expected.pixels.push_back(blend());
  for (const Nearest& nearest : nearest_) expected.depth.push_back(distanceOf(nearest.depth));
  expected.isUndecided.push_back(isUndecided_ || noise_ > kMostNoise);
  expected.noise.push_back(noise_);
  expected.layers.push_back(static_cast<std::uint32_t>(layers_.size()));
}

} // namespace

Expected expectedOf(const Scene& scene) {
  const VitrailCpuFrame& frame = scene.frame;
  const Viewport viewport{frame.pictureWidth == 0 ? frame.width : frame.pictureWidth,
                          frame.pictureHeight == 0 ? frame.height : frame.pictureHeight,
                          static_cast<std::int32_t>(frame.originX),
                          static_cast<std::int32_t>(frame.originY),
                          frame.clipSpace != VITRAIL_CPU_CLIP_VULKAN,
                          frame.clipSpace == VITRAIL_CPU_CLIP_OPENGL};
  const std::vector<Part> parts = partsOf(scene, viewport);
  Expected expected;
  for (std::uint32_t y = 0; y < frame.height; ++y) {
    for (std::uint32_t x = 0; x < frame.width; ++x) PixelReference(scene, parts, x, y).draw(expected);
  }
  return expected;
}

} // namespace vitrail::tests::raster
