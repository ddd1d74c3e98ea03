// Descriptions that the library refuses: the error, and a line in the log that names the field.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::opengl {
namespace {

class RefusedTest : public OpenGlTest {
 protected:
  void SetUp() override {
    OpenGlTest::SetUp();
    textures_ = std::make_unique<PointTextures>(HostDesc{});
    desc_.width = 8;
    desc_.height = 8;
    desc_.resolve = VITRAIL_RESOLVE_COMPUTE;
    desc_.colorFormat = GL_RGBA32F;
    desc_.nodeCapacity = 1000;
    desc_.textures.count = 1;
    desc_.textures.color = &textures_->color;
  }
  void TearDown() override {
    textures_.reset();
    OpenGlTest::TearDown();
  }

  // Refused with that code and one line that has that word.
  static void expectRefused(const VitrailGlTargetDesc& desc, VitrailResult code, const std::string& word) {
    VitrailGlTarget target = nullptr;
    EXPECT_EQ(vitrailGlCreateTarget(backend().context(), &desc, &target), code) << word;
    EXPECT_EQ(target, nullptr) << word;
    expectOneLine(word);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}) << word;
  }

  // The same with a change to what would be right.
  template <typename Change>
  void expectRefused(const std::string& word, Change change) const {
    VitrailGlTargetDesc desc = desc_;
    change(desc);
    expectRefused(desc, VITRAIL_ERROR_INVALID, word);
  }

  std::unique_ptr<PointTextures> textures_;
  VitrailGlTargetDesc desc_{};
};

TEST_F(RefusedTest, WrongFields) {
  using Desc = VitrailGlTargetDesc;
  expectRefused("extent", [](Desc& desc) { desc.width = 0; });
  expectRefused("samples", [](Desc& desc) { desc.samples = 3; });
  expectRefused("nodeFormat", [](Desc& desc) { desc.nodeFormat = static_cast<VitrailNodeFormat>(7); });
  expectRefused("depthOrder", [](Desc& desc) { desc.depthOrder = static_cast<VitrailDepthOrder>(2); });
  expectRefused("overflow", [](Desc& desc) { desc.overflow = static_cast<VitrailOverflow>(5); });
  expectRefused("listBuild", [](Desc& desc) { desc.listBuild = static_cast<VitrailListBuild>(4); });
  expectRefused("resolve", [](Desc& desc) { desc.resolve = static_cast<VitrailResolve>(9); });
  expectRefused("msaaResolve", [](Desc& desc) { desc.msaaResolve = static_cast<VitrailMsaaResolve>(2); });
  expectRefused("framesInFlight", [](Desc& desc) { desc.framesInFlight = VITRAIL_MAX_FRAMES_IN_FLIGHT + 1; });
  expectRefused("stencilMask", [](Desc& desc) { desc.stencilMask = 0x100; });
  expectRefused("next", [](Desc& desc) { desc.next = &desc; });
  expectRefused("nodeCapacity", [](Desc& desc) { desc.nodeCapacity = 0; });
  VitrailGlTargetDesc desc = desc_;
  desc.colorFormat = GL_RGBA8;
  expectRefused(desc, VITRAIL_ERROR_FORMAT, "colorFormat");
}

TEST_F(RefusedTest, TexturesThatAreMissing) {
  using Desc = VitrailGlTargetDesc;
  const std::array<std::uint32_t, 2> names = {textures_->color, 0};
  expectRefused("color", [](Desc& desc) { desc.textures = {}; });
  expectRefused("count", [](Desc& desc) { desc.textures.count = 0; });
  expectRefused("count", [](Desc& desc) { desc.textures.count = VITRAIL_MAX_VIEWS + 1; });
  expectRefused("color[1]", [&](Desc& desc) {
    desc.textures.color = names.data();
    desc.textures.count = 2;
  });
  expectRefused("depth[0]", [&](Desc& desc) { desc.textures.depth = names.data() + 1; });
  if (backend().features().multisampled.empty()) return;
  expectRefused("opaque", [](Desc& desc) { desc.samples = backend().features().multisampled[0]; });
  expectRefused("depth", [&](Desc& desc) {
    desc.samples = backend().features().multisampled[0];
    desc.textures.opaque = names.data();
  });
}

TEST_F(RefusedTest, MemoryThatIsNotThere) {
  VitrailGlTargetDesc desc = desc_;
  desc.memoryBudget = 1000;
  expectRefused(desc, VITRAIL_ERROR_OUT_OF_MEMORY, "memoryBudget");
  const std::uint32_t most = vitrailGlMaxNodeCapacity(backend().context(), VITRAIL_NODE_STANDARD, 1);
  desc = desc_;
  if (most == std::numeric_limits<std::uint32_t>::max()) return;
  desc.nodeCapacity = most + 1;
  expectRefused(desc, VITRAIL_ERROR_OUT_OF_MEMORY, "nodeCapacity");
}

TEST_F(RefusedTest, BuffersOfTheHostThatDoNotServe) {
  VitrailGlRequirements needs{};
  ASSERT_EQ(vitrailGlTargetRequirements(backend().context(), &desc_, &needs), VITRAIL_SUCCESS);
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(needs.size), nullptr, GL_DYNAMIC_COPY);
  desc_.buffer = buffer;
  expectRefused(desc_, VITRAIL_ERROR_INVALID, "bufferSize");
  desc_.bufferSize = needs.size - 1;
  expectRefused(desc_, VITRAIL_ERROR_INVALID, "bufferSize");
  desc_.bufferSize = needs.size;
  using Desc = VitrailGlTargetDesc;
  expectRefused("bufferOffset", [](Desc& desc) { desc.bufferOffset = 4; });
  expectRefused("memoryBudget", [](Desc& desc) { desc.memoryBudget = 64 << 20; });
  VitrailGlTarget target = nullptr;
  ASSERT_EQ(vitrailGlCreateTarget(backend().context(), &desc_, &target), VITRAIL_SUCCESS);
  VitrailGlResizeInfo resize{};
  resize.width = 4;
  resize.height = 4;
  resize.textures = desc_.textures;
  EXPECT_EQ(vitrailGlResizeTarget(target, &resize), VITRAIL_ERROR_INVALID);
  expectOneLine("host's memory");
  vitrailGlDestroyTarget(target);
  glDeleteBuffers(1, &buffer);
}

TEST_F(RefusedTest, Contexts) {
  VitrailGlContext none = nullptr;
  VitrailGlContextDesc desc = backend().contextDesc();
  desc.getProcAddress = nullptr;
  EXPECT_EQ(vitrailGlCreateContext(&desc, &none), VITRAIL_ERROR_INVALID);
  expectOneLine("getProcAddress");
  desc = backend().contextDesc();
  desc.next = &desc;
  EXPECT_EQ(vitrailGlCreateContext(&desc, &none), VITRAIL_ERROR_INVALID);
  expectOneLine("next");
  desc = backend().contextDesc();
  desc.bindingBase = 1000000;
  EXPECT_EQ(vitrailGlCreateContext(&desc, &none), VITRAIL_ERROR_INVALID);
  expectOneLine("bindingBase");
  EXPECT_EQ(none, nullptr);
}

} // namespace
} // namespace vitrail::tests::opengl
