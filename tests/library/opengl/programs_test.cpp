// How programs are made: all that a target lacks are given to the driver before one is asked for, so that a driver with
// several threads compiles them side by side; and one that the driver does not take is told.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "backend.h"
#include "framed.h"
#include "tapped.h"

namespace vitrail::tests::opengl {
namespace {

class ProgramsTest : public OpenGlTest {
 protected:
  void SetUp() override {
    OpenGlTest::SetUp();
    open();
  }
  void TearDown() override {
    vitrailGlDestroyContext(context_);
    tap.reset();
    OpenGlTest::TearDown();
  }

  void open() {
    VitrailGlContextDesc desc = backend().contextDesc();
    tap.real = desc.getProcAddress;
    desc.getProcAddress = tappedLoader;
    ASSERT_EQ(vitrailGlCreateContext(&desc, &context_), VITRAIL_SUCCESS);
    tap.reset();
  }

  static std::ptrdiff_t count(std::string_view name) {
    return std::count_if(tap.calls.begin(), tap.calls.end(), [&](const TappedCall& call) { return call.name == name; });
  }

  VitrailGlContext context_ = nullptr;
};

TEST_F(ProgramsTest, AllAreStartedBeforeOneIsAskedFor) {
  const Framed framed(context_);
  ASSERT_EQ(framed.result, VITRAIL_SUCCESS);
  EXPECT_GE(count("LinkProgram"), 3);
  bool asked = false;
  for (const TappedCall& call : tap.calls) {
    asked = asked || call.name == "GetProgramiv" || call.name == "GetShaderiv" || call.name == "GetProgramInfoLog";
    EXPECT_FALSE(asked && (call.name == "CompileShader" || call.name == "LinkProgram")) << call.name;
  }
  EXPECT_TRUE(asked);
  tap.reset();
  const Framed second(context_); // has them
  EXPECT_EQ(count("LinkProgram"), 0);
  vitrailGlDestroyTarget(framed.target);
  vitrailGlDestroyTarget(second.target);
}

TEST_F(ProgramsTest, TheNumberOfThreadsIsPutBack) {
  if (!epoxy_has_gl_extension("GL_KHR_parallel_shader_compile")) GTEST_SKIP() << "the driver has one thread";
  GLint usual = 0;
  glGetIntegerv(GL_MAX_SHADER_COMPILER_THREADS_KHR, &usual);
  glMaxShaderCompilerThreadsKHR(1);
  const Framed framed(context_);
  GLint after = 0;
  glGetIntegerv(GL_MAX_SHADER_COMPILER_THREADS_KHR, &after);
  EXPECT_EQ(after, 1);
  EXPECT_EQ(count("MaxShaderCompilerThreadsKHR"), 2);
  glMaxShaderCompilerThreadsKHR(static_cast<GLuint>(usual));
  vitrailGlDestroyTarget(framed.target);
}

// The drivers that are given modules take them; here one says that it is such a driver and takes none.
TEST_F(ProgramsTest, WhatIsNoModuleToTheDriverIsCompiledFromItsText) {
  const std::string_view vendor = reinterpret_cast<const char*>(glGetString(GL_VENDOR));
  if (vendor.find("NVIDIA") != std::string_view::npos) GTEST_SKIP() << "the driver takes modules";
  vitrailGlDestroyContext(std::exchange(context_, nullptr));
  tap.vendor = "NVIDIA Corporation";
  open();
  const Framed framed(context_);
  ASSERT_EQ(framed.result, VITRAIL_SUCCESS);
  EXPECT_EQ(count("ShaderBinary"), 1);
  EXPECT_EQ(count("CreateShader"), count("DeleteShader"));
  EXPECT_EQ(count("DeleteProgram"), 1);
  framed.expectFrame();
  tap.reset();
  const Framed fragment(context_, 0, VITRAIL_RESOLVE_FRAGMENT);
  EXPECT_EQ(count("ShaderBinary"), 0);
  fragment.expectFrame();
  vitrailGlDestroyTarget(framed.target);
  vitrailGlDestroyTarget(fragment.target);
  tap.vendor = nullptr;
}

// Each of a target's shaders in turn.
TEST_F(ProgramsTest, AShaderThatTheDriverDoesNotTakeIsTold) {
  for (const VitrailResolve resolve : {VITRAIL_RESOLVE_COMPUTE, VITRAIL_RESOLVE_FRAGMENT}) {
    std::size_t shader = 0;
    for (bool refused = true; refused; ++shader) {
      vitrailGlDestroyContext(std::exchange(context_, nullptr));
      open();
      tap.spoiledShader = shader;
      const Framed framed(context_, 0, resolve);
      refused = tap.shaders > shader; // else it needs no more than those
      EXPECT_EQ(framed.result, refused ? VITRAIL_ERROR_UNSUPPORTED : VITRAIL_SUCCESS);
      EXPECT_EQ(count("CreateShader"), count("DeleteShader"));
      if (refused) {
        EXPECT_EQ(framed.target, nullptr);
        expectOneLine("does not take its shader");
        backend().takeErrors();                   // the driver's own message: some send one
        const Framed again(context_, 0, resolve); // with the programs that were taken, and the one that was not
        ASSERT_EQ(again.result, VITRAIL_SUCCESS);
        again.expectFrame();
        vitrailGlDestroyTarget(again.target);
      }
      vitrailGlDestroyTarget(framed.target);
    }
    EXPECT_GE(shader, 4U);
  }
}

} // namespace
} // namespace vitrail::tests::opengl
