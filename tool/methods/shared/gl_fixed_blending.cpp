#include "gl_fixed_blending.h"

#include "files/gl_fixed_blending.frag.h"
#include "files/gl_fixed_blending_transmission.frag.h"

namespace vitrail::tool {

namespace {

bool isTransmissive(std::uint32_t features) { return (features & shaders::FEATURE_TRANSMISSION) != 0; }

} // namespace

GlBlendedSurfaces::GlBlendedSurfaces(const GlMethodHost& host, const char* method)
    : programs_(host.surfaces, host.surfaces.scene().transparentDraws(), method, [](std::uint32_t features) {
        return isTransmissive(features) ? ShaderText{files::gl_fixed_blending_transmission_frag}
                                        : ShaderText{files::gl_fixed_blending_frag};
      }) {}

void GlBlendedSurfaces::draw(GlFrame& frame, std::span<const SurfaceRun> runs) const {
  frame.images().bindDrawn();
  glEnable(GL_BLEND);
  const std::vector<GpuDraw>& draws = frame.surfaces().scene().transparentDraws();
  frame.drawSurfaces(programs_, runs, [&](const SurfaceRun& run) {
    if (isTransmissive(draws[run.draw].features)) {
      // The shader's first output plus what is there times the factor.
      glBlendFuncSeparate(GL_ONE, GL_SRC1_COLOR, GL_ONE, GL_SRC1_ALPHA);
    } else {
      glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
  });
  glDisable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ZERO); // Mesa refuses factors of a second source beside several draw buffers, blended or not
}

} // namespace vitrail::tool
