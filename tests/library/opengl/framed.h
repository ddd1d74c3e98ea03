// A target that is drawn in any context that shares objects with its own: two panes, over one colour.
#pragma once

#include <vitrail/gl.h>

#include "point_host.h"

namespace vitrail::tests::opengl {

// 8x8 pixels and a texture for them; with a compute resolve nothing that contexts do not share outlives a call. The
// target is destroyed by the test.
class Framed {
 public:
  // There is room for exactly the two panes.
  explicit Framed(VitrailGlContext context, std::uint64_t memoryBudget = 0,
                  VitrailResolve resolve = VITRAIL_RESOLVE_COMPUTE);

  // One frame.
  void draw() const;
  // What the last frame has left: the statistics, and the picture.
  void expectResult() const;
  void expectFrame() const;

  // The host's parts of draw(), for tests that look at the calls between them.
  void drawOpaque() const;
  void drawPanes() const;   // with the lists bound
  void bindPicture() const; // for a fragment resolve
  [[nodiscard]] bool pictureIsRight() const;

  static constexpr std::uint32_t kSide = 8;
  VitrailGlTargetDesc desc{};
  VitrailGlTarget target = nullptr;
  VitrailResult result = VITRAIL_SUCCESS;

 private:
  PointTextures textures_;
};

} // namespace vitrail::tests::opengl
