#include "visibility.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

namespace vitrail::tool {

namespace {

constexpr const char* kAllHidden = "all of its nodes are hidden";

// ---- Alpha

float largestAlpha(const Image& image) {
  std::uint8_t most = 0;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) most = std::max(most, image.rgba[i]);
  return static_cast<float>(most) / 255.0F;
}

float largestAlpha(const Mesh& mesh) {
  if (mesh.colors.empty()) return 1.0F;
  float most = 0.0F;
  for (const std::uint32_t index : mesh.indices) most = std::max(most, unpackColor(mesh.colors[index]).a);
  return most;
}

// The largest alpha of every mesh and image, each worked out once.
class Alphas {
 public:
  explicit Alphas(const Scene& scene) : scene_(scene), meshes_(scene.meshes.size()), images_(scene.images.size()) {}

  // Whether some point of a draw is there at all.
  bool isVisible(const Draw& draw, bool blendsAll) {
    const Material& material = scene_.materials[draw.material];
    if (material.alphaMode == AlphaMode::Opaque) return true;
    float alpha = material.baseColor.a * known(meshes_[draw.mesh], scene_.meshes[draw.mesh]);
    const std::int32_t image = material.baseColorTexture.image;
    if (image >= 0) {
      const auto at = static_cast<std::size_t>(image);
      alpha *= known(images_[at], scene_.images[at]);
    }
    if (material.alphaMode == AlphaMode::Mask) return alpha >= material.alphaCutoff;
    return alpha > 0.0F || (blendsAll && material.alphaMode != AlphaMode::Blend);
  }

 private:
  template <class Source>
  static float known(std::optional<float>& alpha, const Source& source) {
    if (!alpha) alpha = largestAlpha(source);
    return *alpha;
  }

  const Scene& scene_;
  std::vector<std::optional<float>> meshes_;
  std::vector<std::optional<float>> images_;
};

// ---- Where things are in the picture

enum Outside : unsigned { kLeft = 1, kRight = 2, kTop = 4, kBottom = 8, kNear = 16, kFar = 32, kBehind = 64 };

unsigned outsideOf(const glm::dvec4& clip) {
  unsigned sides = 0;
  if (clip.x < -clip.w) sides |= kLeft;
  if (clip.x > clip.w) sides |= kRight;
  if (clip.y < -clip.w) sides |= kTop;
  if (clip.y > clip.w) sides |= kBottom;
  if (clip.z > clip.w) sides |= kNear; // depth is reversed
  if (clip.z < 0.0) sides |= kFar;
  if (clip.w <= 0.0) sides |= kBehind;
  return sides;
}

// What is known of all triangles, lines and points of a scene.
struct Findings {
  bool anyThere = false;                              // has alpha
  bool anyUncut = false;                              // is on the kept side of the clip planes
  bool anyInside = false;                             // is, as far as its corners tell, in the picture
  bool anyFacing = false;                             // shows a side that is drawn
  unsigned outside = ~0U;                             // the sides on which all of it lies
  glm::dvec2 low{std::numeric_limits<double>::max()}; // what is seen covers, from -1 to 1
  glm::dvec2 high{std::numeric_limits<double>::lowest()};
};

class Search {
 public:
  Search(const Scene& scene, const Seen& seen)
      : scene_(scene),
        seen_(seen),
        clip_(
            glm::dmat4(projectionMatrix(seen.view, static_cast<float>(seen.width) / static_cast<float>(seen.height))) *
            glm::inverse(glm::dmat4(seen.view.cameraToWorld))) {}

  Findings findings() {
    Alphas alphas(scene_);
    for (const Draw& draw : scene_.draws) {
      if (!alphas.isVisible(draw, seen_.opacity.has_value())) continue;
      found_.anyThere = true;
      addDraw(draw);
      if (isSeen()) break;
    }
    return found_;
  }

 private:
  // Enough is known: some of it covers a pixel. Most scenes show so with their first triangles.
  bool isSeen() const {
    const glm::dvec2 pixels = 0.5 * (found_.high - found_.low) * glm::dvec2(seen_.width, seen_.height);
    return found_.anyFacing && std::max(pixels.x, pixels.y) >= 1.0;
  }

  void addDraw(const Draw& draw) {
    const Mesh& mesh = scene_.meshes[draw.mesh];
    const Material& material = scene_.materials[draw.material];
    const glm::dmat4 model(draw.transform);
    culls_ =
        mesh.primitive == Primitive::Triangles && !material.doubleSided && !isTransparent(material) && !seen_.opacity;
    mirror_ = glm::determinant(glm::dmat3(model)) < 0.0 ? -1.0 : 1.0;
    const std::size_t corners = cornersOf(mesh.primitive);
    std::array<glm::dvec3, 3> places;
    for (std::size_t first = 0; first + corners <= mesh.indices.size() && !isSeen(); first += corners) {
      for (std::size_t i = 0; i < corners; ++i) {
        const glm::vec3& position = mesh.positions[mesh.indices[first + i]];
        places[i] = glm::dvec3(model * glm::dvec4(glm::dvec3(position), 1.0));
      }
      addPrimitive(std::span(places).first(corners));
    }
  }

  void addPrimitive(std::span<const glm::dvec3> places) {
    for (const glm::dvec4& plane : scene_.clipPlanes) {
      const auto isCut = [&](const glm::dvec3& place) { return glm::dot(glm::dvec3(plane), place) < plane.w; };
      if (std::ranges::all_of(places, isCut)) return;
    }
    found_.anyUncut = true;
    unsigned outside = ~0U;
    for (const glm::dvec3& place : places) outside &= outsideOf(clip_ * glm::dvec4(place, 1.0));
    found_.outside &= outside;
    if (outside != 0) return;
    found_.anyInside = true;
    if (culls_ && !facesCamera(places)) return;
    found_.anyFacing = true;
    for (const glm::dvec3& place : places) {
      const glm::dvec4 clip = clip_ * glm::dvec4(place, 1.0);
      // What reaches behind the camera may cover all of the picture, and points and lines are never too small.
      const bool isPlain = clip.w > 0.0 && places.size() == 3;
      const glm::dvec2 low = isPlain ? glm::dvec2(clip) / clip.w : glm::dvec2(-1.0);
      const glm::dvec2 high = isPlain ? low : glm::dvec2(1.0);
      found_.low = glm::min(found_.low, low);
      found_.high = glm::max(found_.high, high);
    }
  }

  bool facesCamera(std::span<const glm::dvec3> places) const {
    const glm::dvec3 outwards = mirror_ * glm::cross(places[1] - places[0], places[2] - places[0]);
    const glm::dmat4 camera(seen_.view.cameraToWorld);
    const glm::dvec3 towards = seen_.view.orthographic ? glm::dvec3(camera[2]) : glm::dvec3(camera[3]) - places[0];
    return glm::dot(outwards, towards) > 0.0;
  }

  const Scene& scene_;
  const Seen& seen_;
  glm::dmat4 clip_;
  bool culls_ = false; // the present draw
  double mirror_ = 1.0;
  Findings found_;
};

std::string whereInstead(unsigned outside) {
  if ((outside & kBehind) != 0) return "it lies behind the camera";
  if ((outside & kNear) != 0) return "it lies nearer than the camera's near plane";
  if ((outside & kFar) != 0) return "it lies beyond the camera's far plane";
  return "the camera looks elsewhere";
}

// What leaves a picture empty whatever is drawn.
std::optional<std::string> sureReason(const Findings& found) {
  if (!found.anyThere) return "all of it is wholly transparent (alpha 0)";
  if (!found.anyUncut) return "the clip planes cut all of it away";
  if (!found.anyInside) return whereInstead(found.outside);
  if (!found.anyFacing) return "its surfaces are single-sided and face away from the camera";
  return {};
}

} // namespace

std::optional<std::string> whyNothingIsSeen(const Scene& scene, const Seen& seen) {
  if (scene.draws.empty()) return kAllHidden;
  return sureReason(Search(scene, seen).findings());
}

std::string nothingDrawnWarning() { return fmt::format("nothing of the model is seen: {}", kAllHidden); }

std::string nothingSeenWarning(const Scene& scene, const Seen& seen) {
  if (scene.draws.empty()) return nothingDrawnWarning();
  const Findings found = Search(scene, seen).findings();
  const glm::dvec2 pixels = 0.5 * (found.high - found.low) * glm::dvec2(seen.width, seen.height);
  const char* const otherwise = std::max(pixels.x, pixels.y) < 1.0
                                    ? "it is smaller than a pixel"
                                    : "it is too faint, too thin or of the background's colour";
  return fmt::format("nothing of the model is seen: {}", sureReason(found).value_or(otherwise));
}

} // namespace vitrail::tool
