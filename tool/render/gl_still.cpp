#include "gl_still.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "../image/encode.h"
#include "../methods/gl_method.h"
#include "../methods/methods.h"
#include "../methods/shared/host_clock.h"
#include "../opengl/gl_stage.h"
#include "../scene/threads.h"
#include "attempts.h"

namespace vitrail::tool {

namespace {

constexpr std::uint64_t kBandPixels = std::uint64_t{4} << 20U; // read and encoded at once
constexpr std::size_t kRowsOfAThread = 32;

// Reads rows of the picture and encodes them.
void readRows(GLuint color, std::uint32_t width, std::uint32_t first, std::uint32_t rows, RenderResult& result) {
  const auto read = [&](GLenum type, std::size_t bytes, void* to) {
    glGetTextureSubImage(color, 0, 0, static_cast<GLint>(first), 0, static_cast<GLsizei>(width),
                         static_cast<GLsizei>(rows), 1, GL_RGBA, type, static_cast<GLsizei>(bytes), to);
  };
  const std::size_t count = std::size_t{width} * rows * 4;
  const std::size_t to = std::size_t{width} * first * 4;
  std::vector<std::uint16_t>& deep = result.deep.rgba;
  if (!deep.empty() && result.deep.encoding == Encoding::Linear) {
    return read(GL_HALF_FLOAT, count * sizeof(std::uint16_t), &deep[to]); // as it is
  }
  std::vector<float> linear(count);
  read(GL_FLOAT, count * sizeof(float), linear.data());
  const std::size_t parts = partsFor(rows, kRowsOfAThread);
  inParts(parts, [&](std::size_t part) {
    const std::size_t begin = rows * part / parts * width;
    const std::size_t end = rows * (part + 1) / parts * width;
    const float* from = linear.data() + begin * 4;
    const std::size_t place = to + begin * 4;
    deep.empty() ? encodePixels(from, end - begin, &result.picture.rgba[place])
                 : encodePixels(from, end - begin, result.deep.encoding, &deep[place]);
  });
}

} // namespace

struct GlStillRenderer::Impl {
  MethodOptions options;
  std::vector<std::string> warnings; // of what the method, or the device, draws otherwise
  GlTimers timers;
  GlStage stage;                    // the method's target has its images
  std::unique_ptr<GlMethod> method; // draws on it

  Impl(Gl& gl, const Scene& scene, std::optional<float> opacity, DrawOrder order, const MethodOptions& chosen,
       Scene* released);
  void prepare(const RenderOptions& picture);
  bool draw(const Background& background);
  FrameReport drawUntilComplete(const RenderOptions& picture);
  void read(const RenderOptions& picture, RenderResult& result) const;
  bool isBackgroundAlone(const RenderOptions& picture, const RenderResult& drawn);
};

GlStillRenderer::Impl::Impl(Gl& gl, const Scene& scene, std::optional<float> opacity, DrawOrder order,
                            const MethodOptions& chosen, Scene* released)
    : options(chosen),
      warnings(methodWarnings(scene, chosen)),
      timers(gl),
      stage(gl, scene, opacity, order, chosen.samples, released),
      method(makeGlMethod({gl, stage.surfaces(), scene}, chosen)) {
  stage.setNeeds(method->needs());
  warnOfPoints(scene, stage.surfaces().pointSize(), gl.name(), warnings);
}

void GlStillRenderer::Impl::prepare(const RenderOptions& picture) {
  checkPictureOptions(options, picture.memoryBudget.has_value(), picture.peel > 0);
  if (!stage.hasSize(picture.width, picture.height)) {
    method->releaseTarget();
    stage.setSize(picture.width, picture.height);
  }
  stage.setView(picture.view);
  GlMethodTarget target;
  target.images = &stage.images();
  target.memoryBudget = picture.memoryBudget;
  target.onTile = picture.onTile;
  target.surfaces = !stage.surfaces().scene().transparentDraws().empty();
  method->setTarget(target);
}

// Draws a picture. False: the method has made room, and the picture must be drawn again.
bool GlStillRenderer::Impl::draw(const Background& background) {
  GlFrame frame(timers, stage.images(), stage.surfaces());
  stage.drawOpaque(frame, background);
  method->draw(frame);
  stage.finishPicture(frame);
  frame.finish();
  return method->finish();
}

FrameReport GlStillRenderer::Impl::drawUntilComplete(const RenderOptions& picture) {
  prepare(picture);
  Gl& gl = stage.gl();
  const FrameStats stats = tool::drawUntilComplete(
      gl.name(), [&] { return draw(picture.background); }, [&] { return method->stats(); });
  FrameReport report = reportOf(stats, picture, options, timers.milliseconds());
  report.device = gl.name();
  report.api = gl.api();
  report.warnings = warnings;
  report.peakBytes = gl.peakMemory();
  return report;
}

// Fills in the pixels of the picture that was drawn last.
void GlStillRenderer::Impl::read(const RenderOptions& picture, RenderResult& result) const {
  const bool hasAlpha = picture.background.kind == Background::Kind::Transparent;
  const std::size_t count = std::size_t{picture.width} * picture.height * 4;
  if (picture.encoding == Encoding::Srgb8) {
    result.picture = {picture.width, picture.height, hasAlpha, std::vector<std::uint8_t>(count)};
  } else {
    result.deep = {picture.width, picture.height, hasAlpha, picture.encoding, std::vector<std::uint16_t>(count)};
  }
  const auto most = static_cast<std::uint32_t>(std::max<std::uint64_t>(kBandPixels / picture.width, 1));
  for (std::uint32_t first = 0; first < picture.height; first += most) {
    readRows(stage.images().color(), picture.width, first, std::min(most, picture.height - first), result);
  }
}

// Whether the background, drawn in the same way without the scene, is the same picture.
bool GlStillRenderer::Impl::isBackgroundAlone(const RenderOptions& picture, const RenderResult& drawn) {
  if (!mayBeBackground(picture, drawn)) return false;
  GlFrame frame(timers, stage.images(), stage.surfaces());
  stage.drawBackground(frame, picture.background);
  frame.finish();
  RenderResult alone;
  read(picture, alone);
  return alone.picture.rgba == drawn.picture.rgba && alone.deep.rgba == drawn.deep.rgba;
}

GlStillRenderer::GlStillRenderer(Gl& gl, const Scene& scene, std::optional<float> opacity, DrawOrder order,
                                 const MethodOptions& method)
    : impl_(std::make_unique<Impl>(gl, scene, opacity, order, method, nullptr)) {}

GlStillRenderer::GlStillRenderer(Gl& gl, Scene&& scene, std::optional<float> opacity, const MethodOptions& method)
    : impl_(std::make_unique<Impl>(gl, scene, opacity, DrawOrder::Forward, method,
                                   traitsOf(method.name).sortsOnHost ? nullptr : &scene)) {}

GlStillRenderer::~GlStillRenderer() = default;

RenderResult GlStillRenderer::render(const RenderOptions& options) {
  RenderResult result;
  result.report = impl_->drawUntilComplete(options);
  const HostClock clock;
  impl_->read(options, result);
  result.report.passesMs.emplace_back("encode", clock.milliseconds()); // on the host
  result.report.frameMs += result.report.passesMs.back().second;
  result.isEmpty = impl_->isBackgroundAlone(options, result);
  return result;
}

FrameReport GlStillRenderer::measure(const RenderOptions& options) { return impl_->drawUntilComplete(options); }

} // namespace vitrail::tool
