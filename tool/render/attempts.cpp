#include "attempts.h"

#include <algorithm>

#include <fmt/format.h>

#include "../gpu/gpu_error.h"

namespace vitrail::tool {

namespace {

// Most frames that count something are followed by one that fits. With tiles each step's room may be known only when
// the one before it had enough, and it may go on in ever smaller bands. More are never needed unless a device counts
// wrong.
constexpr int kMaxAttempts = 24;

} // namespace

FrameStats drawUntilComplete(const std::string& name, const std::function<bool()>& draw,
                             const std::function<FrameStats()>& stats) {
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    const bool complete = draw();
    const FrameStats counted = stats();
    if (counted.fragmentsMissing == 0 && counted.cutPixels > 0) {
      throw GpuError(
          fmt::format("{} pixels have more surfaces, up to {}, than the driver of {} lets a shader sort: use a GPU",
                      counted.cutPixels, counted.layersMax, name));
    }
    if (complete) return counted;
  }
  throw GpuError(fmt::format("{} counts the picture's fragments differently in each of {} frames", name, kMaxAttempts));
}

FrameReport reportOf(const FrameStats& stats, const RenderOptions& picture, const MethodOptions& method,
                     const PassTimes& passes) {
  FrameReport report;
  static_cast<FrameStats&>(report) = stats;
  report.method = method.name;
  report.width = picture.width;
  report.height = picture.height;
  report.samples = method.samples;
  report.peeled = picture.peel;
  if (!report.resolve.empty() && method.samples > 1) report.msaaResolve = nameOf(method.msaaResolve);
  report.passesMs = passes;
  for (const auto& [pass, milliseconds] : passes) report.frameMs += milliseconds;
  return report;
}

bool mayBeBackground(const RenderOptions& picture, const RenderResult& drawn) {
  const auto isPlain = [](const auto& rgba) {
    for (std::size_t i = 4; i < rgba.size(); ++i) {
      if (rgba[i] != rgba[i - 4]) return false;
    }
    return true;
  };
  return picture.background.kind == Background::Kind::Sky || (isPlain(drawn.picture.rgba) && isPlain(drawn.deep.rgba));
}

std::string nothingPeeledWarning() {
  return "nothing was peeled away: every surface that is seen is opaque; --opacity makes all of them translucent";
}

void warnOfPoints(const Scene& scene, float drawn, const std::string& name, std::vector<std::string>& warnings) {
  const bool hasPoints = std::ranges::any_of(
      scene.draws, [&scene](const Draw& draw) { return scene.meshes[draw.mesh].primitive == Primitive::Points; });
  if (!hasPoints || drawn == scene.pointSize) return;
  warnings.push_back(
      fmt::format("points of {} pixels are drawn with {}, the nearest that {} offers", scene.pointSize, drawn, name));
}

} // namespace vitrail::tool
