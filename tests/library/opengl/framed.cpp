#include "framed.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

namespace vitrail::tests::opengl {

namespace {

const std::string kVertex = R"(#version 430 core
flat out vec4 color;
void main() {
  bool first = gl_InstanceID == 0; // and the nearer one
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, first ? 0.25 : 0.75, 1.0);
  color = first ? vec4(0.0, 1.0, 0.0, 0.5) : vec4(1.0, 0.0, 0.0, 0.5);
}
)";
const std::string kFragment = R"(
flat in vec4 color;
void main() { vitrailCollect(color); }
)";

} // namespace

Framed::Framed(VitrailGlContext context, std::uint64_t memoryBudget, VitrailResolve resolve) : textures_(HostDesc{}) {
  desc.width = kSide;
  desc.height = kSide;
  desc.nodeCapacity = 2 * kSide * kSide;
  desc.memoryBudget = memoryBudget;
  desc.resolve = resolve;
  if (resolve == VITRAIL_RESOLVE_COMPUTE) {
    desc.colorFormat = GL_RGBA32F;
    desc.textures.count = 1;
    desc.textures.color = &textures_.color;
  }
  desc.copyLayers = kSide * kSide;
  result = vitrailGlCreateTarget(context, &desc, &target);
}

void Framed::drawOpaque() const {
  constexpr FloatColor kBlue = {0.0F, 0.0F, 1.0F, 1.0F};
  glClearTexImage(textures_.color, 0, GL_RGBA, GL_FLOAT, kBlue.data());
}

void Framed::drawPanes() const {
  const GLuint program = backend().program(
      kVertex, std::string("#version 430 core\n") + vitrailGlCollectSource(backend().context()) + kFragment);
  GLuint framebuffer = 0;
  GLuint vertices = 0;
  glGenFramebuffers(1, &framebuffer);
  glGenVertexArrays(1, &vertices);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glFramebufferParameteri(GL_DRAW_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, kSide);
  glFramebufferParameteri(GL_DRAW_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, kSide);
  glBindVertexArray(vertices);
  glViewport(0, 0, kSide, kSide);
  glUseProgram(program);
  glDrawArraysInstanced(GL_TRIANGLES, 0, 3, 2);
  glUseProgram(0);
  glDeleteVertexArrays(1, &vertices);
  glDeleteFramebuffers(1, &framebuffer);
}

void Framed::bindPicture() const {
  if (desc.resolve == VITRAIL_RESOLVE_FRAGMENT) glBindFramebuffer(GL_FRAMEBUFFER, textures_.resolved);
}

void Framed::draw() const {
  drawOpaque();
  vitrailGlBegin(target, nullptr);
  vitrailGlBind(target);
  drawPanes();
  vitrailGlCollected(target);
  bindPicture();
  vitrailGlResolve(target, nullptr);
  vitrailGlEnd(target);
}

bool Framed::pictureIsRight() const {
  std::array<FloatColor, std::size_t{kSide} * kSide> pixels{};
  glBindTexture(GL_TEXTURE_2D, textures_.color);
  glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, pixels.data());
  glBindTexture(GL_TEXTURE_2D, 0);
  constexpr std::array kExpected = {0.25F, 0.5F, 0.25F}; // half of green over half of red over blue
  for (const FloatColor& pixel : pixels) {
    for (std::size_t c = 0; c < kExpected.size(); ++c) {
      if (!(std::abs(pixel[c] - kExpected[c]) < 0.005F)) return false;
    }
  }
  return true;
}

void Framed::expectResult() const {
  glFinish();
  VitrailStats stats{};
  EXPECT_EQ(vitrailGlReadStats(target, 0, &stats), VITRAIL_SUCCESS);
  EXPECT_EQ(stats.complete, 1U);
  EXPECT_EQ(stats.fragmentsStored, 2U * kSide * kSide);
  EXPECT_TRUE(pictureIsRight());
}

void Framed::expectFrame() const {
  draw();
  expectResult();
}

} // namespace vitrail::tests::opengl
