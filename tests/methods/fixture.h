// What the GPU tests share: one device under the validation layer, one OpenGL context with debug output, and the rule
// that an error of either fails a test.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../../tool/gpu/device.h"
#include "../../tool/opengl/gl.h"
#include "../../tool/render/still.h"

namespace vitrail::tool::test {

// A test on the GPU. It runs under the Khronos validation layer with synchronization validation; where that layer is
// missing the test fails.
class GpuTest : public ::testing::Test {
 public:
  // The process's one OpenGL context, made by the first call.
  static Gl& gl();

 protected:
  // The process's one device, made by the first call.
  static Gpu& gpu();

  // Fails the test for every error that the validation layer or OpenGL has reported so far.
  void TearDown() override;
};

// A renderer of a scene: on the processor for the method that is drawn there, by the tests' OpenGL context for
// Api::OpenGl.
std::unique_ptr<Renderer> rendererOf(Gpu& gpu, const Scene& scene, std::optional<float> opacity = {},
                                     DrawOrder order = DrawOrder::Forward, const MethodOptions& method = {});

// Renders once, with a renderer of its own.
RenderResult renderOnce(Gpu& gpu, const Scene& scene, const RenderOptions& options, std::optional<float> opacity = {},
                        DrawOrder order = DrawOrder::Forward, const MethodOptions& method = {});

// Ways to draw fragment lists on this device: every node format, resolve and kind of multisampling, each at least once.
std::vector<MethodOptions> methodVariety(const Gpu& gpu);

// A method's options in a few words.
std::string describe(const MethodOptions& method);

// Options for a picture of a scene as the tool would take it: the scene's first camera where it has one, else framed
// from the three-quarter view; the scene's background where it has one, else white.
RenderOptions usualOptions(const Scene& scene, std::uint32_t width, std::uint32_t height);

// The largest difference of a channel, of 255.
int largestDifference(const Picture& a, const Picture& b);

} // namespace vitrail::tool::test
