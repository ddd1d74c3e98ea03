// Contexts: several that share objects, on several threads, and those that lack something. lost_test.cpp has those that
// are lost.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "../expected.h"
#include "backend.h"
#include "framed.h"
#include "point_host.h"

namespace vitrail::tests::opengl {
namespace {

// ---- Contexts that are older or poorer than the device's

// What poorLoader() leaves out, and the version that it tells.
struct Poor {
  std::string missing;
  GLint major = 4;
  GLint minor = 3;
};
Poor poor;

void APIENTRY poorIntegers(GLenum name, GLint* value) {
  if (name == GL_MAJOR_VERSION) {
    *value = poor.major;
  } else if (name == GL_MINOR_VERSION) {
    *value = poor.minor;
  } else {
    glGetIntegerv(name, value);
  }
}

const GLubyte* APIENTRY poorStrings(GLenum name, GLuint index) {
  const GLubyte* text = glGetStringi(name, index);
  const bool hidden = std::strcmp(reinterpret_cast<const char*>(text), "GL_ARB_buffer_storage") == 0;
  return hidden ? reinterpret_cast<const GLubyte*>("GL_none") : text;
}

void* poorLoader(const char* name, void*) {
  if (poor.missing == name) return nullptr;
  if (std::strcmp(name, "glGetIntegerv") == 0) return reinterpret_cast<void*>(poorIntegers);
  if (std::strcmp(name, "glGetStringi") == 0) return reinterpret_cast<void*>(poorStrings);
  return reinterpret_cast<void*>(eglGetProcAddress(name));
}

class ContextTest : public OpenGlTest {
 protected:
  void SetUp() override {
    OpenGlTest::SetUp();
    poor = {};
  }
  void TearDown() override {
    backend().egl().makeCurrent();
    OpenGlTest::TearDown();
  }

  static HostDesc hostDesc() {
    HostDesc desc;
    desc.capacity = 200;
    desc.behind = {0.25F, 0.5F, 1.0F, 1.0F};
    return desc;
  }
  static void expectPicture(OpenGlHost& host, unsigned seed) {
    const std::vector<Point> points = randomLists(hostDesc(), {0, 1, 5, 17, 33}, seed);
    const PointResult result = host.draw(points);
    EXPECT_EQ(result.stats.complete, 1U);
    EXPECT_LT(largestError(result.pixels, expectedFrame(hostDesc(), points).pixels), kTolerance);
  }

  static void expectRefused(const std::string& word) {
    VitrailGlContextDesc desc = backend().contextDesc();
    desc.getProcAddress = poorLoader;
    VitrailGlContext context = reinterpret_cast<VitrailGlContext>(&desc);
    EXPECT_EQ(vitrailGlCreateContext(&desc, &context), VITRAIL_ERROR_UNSUPPORTED);
    EXPECT_EQ(context, nullptr);
    expectOneLine(word);
  }
};

// One context of the library, whose programs the first host has compiled.
TEST_F(ContextTest, TargetsTakeTurnsInContextsThatShareObjects) {
  OpenGlHost first(backend(), hostDesc());
  for (const VitrailResolve resolve : {VITRAIL_RESOLVE_COMPUTE, VITRAIL_RESOLVE_FRAGMENT}) {
    SCOPED_TRACE(resolve);
    expectPicture(first, 1);
    const EglContext other(&backend().egl());
    backend().listen();
    HostDesc desc = hostDesc();
    desc.resolve = resolve;
    {
      OpenGlHost second(backend(), desc);
      OpenGlHost third(backend(), desc);
      expectPicture(second, 2);
      expectPicture(third, 3);
      expectPicture(second, 4);
    }
    backend().egl().makeCurrent();
  }
}

// Made in one context, drawn in the other and then in the first again.
TEST_F(ContextTest, ATargetIsDrawnInAnotherContext) {
  const Framed framed(backend().context());
  ASSERT_EQ(framed.result, VITRAIL_SUCCESS);
  framed.expectFrame();
  {
    const EglContext other(&backend().egl());
    backend().listen();
    framed.expectFrame();
  }
  backend().egl().makeCurrent();
  framed.expectFrame();
  vitrailGlDestroyTarget(framed.target);
}

TEST_F(ContextTest, FramesGoOnInAnotherThread) {
  OpenGlHost host(backend(), hostDesc());
  expectPicture(host, 1);
  EglContext::makeNoneCurrent();
  std::thread([&] {
    backend().egl().makeCurrent();
    expectPicture(host, 2);
    EglContext::makeNoneCurrent();
  }).join();
  backend().egl().makeCurrent();
  expectPicture(host, 3);
}

// Of two contexts the one goes in which the target was made and drawn, with a frame that nobody has looked at yet.
TEST_F(ContextTest, ATargetLivesOnInTheContextThatIsLeft) {
  std::unique_ptr<Framed> framed;
  VitrailGlContext context = nullptr;
  {
    const EglContext gone(&backend().egl());
    backend().listen();
    const VitrailGlContextDesc desc = backend().contextDesc();
    ASSERT_EQ(vitrailGlCreateContext(&desc, &context), VITRAIL_SUCCESS);
    framed = std::make_unique<Framed>(context);
    ASSERT_EQ(framed->result, VITRAIL_SUCCESS);
    framed->expectFrame();
    framed->draw();
    glFinish(); // what the other context sees is what this one has done
  }
  backend().egl().makeCurrent();
  framed->expectResult();
  for (int i = 0; i < 4; ++i) framed->expectFrame();
  const Framed later(context); // with the programs that the other context compiled
  ASSERT_EQ(later.result, VITRAIL_SUCCESS);
  later.expectFrame();
  vitrailGlDestroyTarget(later.target);
  vitrailGlDestroyTarget(framed->target);
  vitrailGlDestroyContext(context);
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

// The context goes with the last of its targets, which draw until then, and in what is left of the OpenGL contexts.
TEST_F(ContextTest, AContextMayBeDestroyedBeforeItsTargets) {
  VitrailGlContext context = nullptr;
  std::unique_ptr<Framed> framed;
  VitrailGlTarget other = nullptr;
  {
    const EglContext made(&backend().egl());
    backend().listen();
    const VitrailGlContextDesc desc = backend().contextDesc();
    ASSERT_EQ(vitrailGlCreateContext(&desc, &context), VITRAIL_SUCCESS);
    const Framed gone(context);
    other = gone.target;
    gone.expectFrame();
  }
  backend().egl().makeCurrent();
  framed = std::make_unique<Framed>(context);
  vitrailGlDestroyTarget(other);
  vitrailGlDestroyContext(context);
  expectOneLine("targets are left (1)");
  framed->expectFrame();
  vitrailGlDestroyTarget(framed->target);
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST_F(ContextTest, AnErrorOfTheHostsIsNotTakenForTheLibrarys) {
  glEnable(GL_TEXTURE_2D_ARRAY); // no such switch
  EXPECT_FALSE(backend().takeErrors().empty());
  const Framed framed(backend().context());
  EXPECT_EQ(framed.result, VITRAIL_SUCCESS);
  expectOneLine("error flag");
  vitrailGlDestroyTarget(framed.target);
}

// Statistics come by glGetBufferSubData() then.
TEST_F(ContextTest, WithoutBufferStorage) {
  VitrailGlContextDesc desc = backend().contextDesc();
  desc.getProcAddress = poorLoader;
  VitrailGlContext context = nullptr;
  poor.missing = "glBufferStorage";
  ASSERT_EQ(vitrailGlCreateContext(&desc, &context), VITRAIL_SUCCESS);
  const Framed framed(context);
  ASSERT_EQ(framed.result, VITRAIL_SUCCESS);
  for (int i = 0; i < 5; ++i) framed.expectFrame();
  vitrailGlDestroyTarget(framed.target);
  vitrailGlDestroyContext(context);
}

TEST_F(ContextTest, ThatLackWhatIsNeededAreRefused) {
  poor.missing = "glDispatchComputeIndirect";
  expectRefused("glDispatchComputeIndirect");
  poor = {"", 3, 3};
  expectRefused("version");
  poor = {"", 4, 2};
  expectRefused("version");
  poor = {};
  EglContext::makeNoneCurrent();
  expectRefused("current");
}

} // namespace
} // namespace vitrail::tests::opengl
