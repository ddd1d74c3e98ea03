// A context that is lost. No driver loses one at will, so a loader stands in between, whose functions behave from some
// call on as OpenGL says for GL_CONTEXT_LOST (KHR_robustness): no effect, no results, and fences that have failed or
// are passed. The calls that the library makes are written down first; then the context is lost at each of them in
// turn.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "../../thorough.h"
#include "backend.h"
#include "framed.h"
#include "tapped.h"

namespace vitrail::tests::opengl {
namespace {

constexpr VitrailResult kLost = VITRAIL_ERROR_DEVICE_LOST;
constexpr std::uint64_t kBudget = 1 << 20;

class LostTest : public OpenGlTest {
 protected:
  void SetUp() override {
    OpenGlTest::SetUp();
    desc_ = backend().contextDesc();
    tap.real = desc_.getProcAddress;
    desc_.getProcAddress = tappedLoader;
    tap.reset();
  }
  void TearDown() override {
    tap.missing = {};
    tap.reset();
    backend().egl().makeCurrent();
    vitrailGlDestroyContext(context_);
    backend().takeLog(); // calls may say that the context is lost
    OpenGlTest::TearDown();
  }

  void open() { ASSERT_EQ(vitrailGlCreateContext(&desc_, &context_), VITRAIL_SUCCESS); }

  // The calls of a frame. What the host draws it draws where the context is not lost.
  static void frame(const Framed& framed, GLuint copied) {
    framed.drawOpaque();
    vitrailGlUpdateTarget(framed.target, 0);
    vitrailGlBegin(framed.target, nullptr);
    vitrailGlBind(framed.target);
    if (!tap.isLost()) framed.drawPanes();
    vitrailGlCollected(framed.target);
    VitrailGlCopyInfo info{};
    info.area = {0, 0, 4, 4};
    info.buffer = copied;
    info.size = vitrailGlCopySize(framed.target, 4, 4);
    vitrailGlCopyLists(framed.target, &info);
    framed.bindPicture();
    vitrailGlResolve(framed.target, nullptr);
    vitrailGlEnd(framed.target);
  }

  // What no loss changes: calls that read fields, of the context and of a target.
  void expectFields(const Framed& framed) const {
    EXPECT_EQ(vitrailGlDefaultResolve(context_, &framed.desc), VITRAIL_RESOLVE_COMPUTE);
    EXPECT_NE(vitrailGlDefaultListBuild(context_, &framed.desc), VITRAIL_LIST_BUILD_DEFAULT);
    EXPECT_GT(vitrailGlMaxNodeCapacity(context_, VITRAIL_NODE_STANDARD, 1), 0U);
    EXPECT_STRNE(vitrailGlCollectSource(context_), "");
    EXPECT_STRNE(vitrailGlListSource(context_), "");
    VitrailTileLimits limits{};
    EXPECT_EQ(vitrailGlTileLimits(context_, VITRAIL_NODE_STANDARD, 1, &limits), VITRAIL_SUCCESS);
    VitrailGlRequirements needs{};
    EXPECT_EQ(vitrailGlTargetRequirements(context_, &framed.desc, &needs), VITRAIL_SUCCESS);
    VitrailGlSpecialization specialization{};
    vitrailGlCollectSpecialization(context_, &framed.desc, &specialization);
    EXPECT_STRNE(specialization.defines, "");
    EXPECT_GT(vitrailGlCopySize(framed.target, 4, 4), 0U);
    EXPECT_EQ(vitrailGlTargetResolve(framed.target), VITRAIL_RESOLVE_COMPUTE);
    EXPECT_NE(vitrailGlTargetListBuild(framed.target), VITRAIL_LIST_BUILD_DEFAULT);
    EXPECT_NE(vitrailGlBarriers(framed.target, VITRAIL_GL_BARRIER_RESOLVE), 0U);
    VitrailMemory memory{};
    vitrailGlTargetMemory(framed.target, &memory);
    EXPECT_GE(memory.nodeCapacity, framed.desc.nodeCapacity);
  }

  VitrailGlContextDesc desc_{};
  VitrailGlContext context_ = nullptr;
};

// Each call that returns a result, on what was made before.
TEST_F(LostTest, CallsSayThatTheContextIsLost) {
  open();
  for (const LostFence fence : {LostFence::Failed, LostFence::Signaled}) {
    const Framed framed(context_, kBudget);
    ASSERT_EQ(framed.result, VITRAIL_SUCCESS);
    framed.expectFrame();
    framed.draw(); // its statistics are not read before the loss
    tap.reset();
    tap.lostFrom = 0;
    tap.fence = fence;
    backend().takeLog();
    VitrailGlTarget none = framed.target;
    EXPECT_EQ(vitrailGlCreateTarget(context_, &framed.desc, &none), kLost);
    EXPECT_EQ(none, nullptr);
    expectOneLine("is lost");
    VitrailGlTargetDesc other = framed.desc; // whose programs are not there yet
    other.maxLayers = 3;
    EXPECT_EQ(vitrailGlCreateTarget(context_, &other, &none), kLost);
    expectOneLine("is lost");
    VitrailGlResizeInfo resize{};
    resize.width = 4;
    resize.height = 4;
    resize.textures = framed.desc.textures;
    EXPECT_EQ(vitrailGlResizeTarget(framed.target, &resize), kLost);
    expectOneLine("is lost");
    VitrailGlContext noContext = context_;
    EXPECT_EQ(vitrailGlCreateContext(&desc_, &noContext), kLost);
    EXPECT_EQ(noContext, nullptr);
    expectOneLine("is lost");
    expectFields(framed);
    // Frames that are lost as a whole, more than there are slots for.
    for (int i = 0; i < 4; ++i) {
      frame(framed, 1);
      const std::uint64_t number = vitrailGlTargetFrame(framed.target);
      VitrailStats stats{};
      EXPECT_EQ(vitrailGlReadStats(framed.target, number, &stats), kLost);
      EXPECT_EQ(vitrailGlReadStats(framed.target, number + 1, &stats), kLost);
    }
    EXPECT_EQ(vitrailGlUpdateTarget(framed.target, 0), kLost);
    vitrailGlDestroyTarget(framed.target);
    EXPECT_TRUE(backend().takeLog().empty());
    tap.reset();
  }
}

// Fences that say of commands that never ran that they did: the counters are of an older frame, or of none.
TEST_F(LostTest, AFrameThatNeverRanIsNotComplete) {
  open();
  for (const bool mapped : {true, false}) {
    for (int before = 0; before < 4; ++before) {
      SCOPED_TRACE(std::to_string(before) + (mapped ? " frames before, mapped" : " frames before"));
      const Framed framed(context_);
      ASSERT_EQ(framed.result, VITRAIL_SUCCESS);
      for (int i = 0; i < before; ++i) framed.expectFrame();
      tap.reset();
      tap.lostFrom = 0;
      tap.fence = LostFence::AsEver;
      frame(framed, 1);
      glFinish(); // the test's own call: the fence that was made is passed
      VitrailStats stats{};
      EXPECT_EQ(vitrailGlReadStats(framed.target, 0, &stats), VITRAIL_SUCCESS);
      EXPECT_EQ(stats.complete, 0U);
      EXPECT_EQ(stats.misused, 1U);
      vitrailGlDestroyTarget(framed.target);
      tap.reset();
    }
    // Again with counters that glGetBufferSubData() reads.
    vitrailGlDestroyContext(std::exchange(context_, nullptr));
    tap.missing = "glMapBufferRange";
    open();
  }
}

// Whether losing the context at a call says more than losing it at the one before.
bool isWorthLosing(const std::vector<TappedCall>& calls, std::size_t i) {
  return i == 0 || calls[i].name != calls[i - 1].name;
}

// A frame, its statistics, another size: the context is lost at each of their calls.
TEST_F(LostTest, AnyCallOfAFrameMayBeTheLast) {
  open();
  for (const VitrailResolve resolve : {VITRAIL_RESOLVE_COMPUTE, VITRAIL_RESOLVE_FRAGMENT}) {
    for (const LostFence fence : {LostFence::Failed, LostFence::Signaled, LostFence::AsEver}) {
      // With one resolve every kind of fence, with the other one kind: each call that is lost needs a context of its
      // own.
      if (resolve == VITRAIL_RESOLVE_FRAGMENT && fence != LostFence::AsEver) continue;
      std::vector<TappedCall> calls; // of a frame that is not lost
      for (std::size_t last = 0; last == 0 || last <= calls.size(); ++last) {
        if (last != 0 && !isWorthLosing(calls, last - 1)) continue;
        if (last % 2 == 1 && !isThorough()) continue;
        const EglContext egl(&backend().egl()); // whose state stays as the loss has left it
        GLuint copied = 0;
        glGenBuffers(1, &copied);
        glBindBuffer(GL_COPY_WRITE_BUFFER, copied);
        glBufferData(GL_COPY_WRITE_BUFFER, 1 << 16, nullptr, GL_DYNAMIC_READ);
        const Framed framed(context_, kBudget, resolve);
        ASSERT_EQ(framed.result, VITRAIL_SUCCESS);
        tap.reset();
        tap.fence = fence;
        if (last != 0) tap.lostFrom = last - 1;
        frame(framed, copied);
        glFinish();
        VitrailStats stats{};
        const VitrailResult read = vitrailGlReadStats(framed.target, 0, &stats);
        EXPECT_TRUE(read == VITRAIL_SUCCESS || (read == kLost && last != 0)) << read;
        EXPECT_TRUE(stats.complete == 0 || framed.pictureIsRight());
        VitrailGlResizeInfo resize{};
        resize.width = 4;
        resize.height = 4;
        resize.textures = framed.desc.textures;
        const VitrailResult resized = vitrailGlResizeTarget(framed.target, &resize);
        EXPECT_TRUE(resized == VITRAIL_SUCCESS || (resized == kLost && last != 0)) << resized;
        vitrailGlDestroyTarget(framed.target);
        if (last == 0) calls = tap.calls;
        if (::testing::Test::HasFailure()) {
          FAIL() << "lost at call " << last << ", " << (last == 0 ? "none" : calls[last - 1].name);
        }
        tap.reset();
        glDeleteBuffers(1, &copied);
      }
      backend().egl().makeCurrent();
      const Framed after(context_);
      after.expectFrame();
      vitrailGlDestroyTarget(after.target);
    }
  }
}

// The library's context and its first target, whose programs are compiled: lost at each of their calls.
TEST_F(LostTest, AnyCallOfCreationMayBeTheLast) {
  std::vector<TappedCall> calls;
  for (std::size_t last = 0; last == 0 || last <= calls.size(); ++last) {
    if (last != 0 && !isWorthLosing(calls, last - 1)) continue;
    tap.reset();
    if (last != 0) tap.lostFrom = last - 1;
    const VitrailResult made = vitrailGlCreateContext(&desc_, &context_);
    EXPECT_EQ(made == VITRAIL_SUCCESS, context_ != nullptr);
    if (made == VITRAIL_SUCCESS) {
      const Framed framed(context_);
      EXPECT_EQ(framed.result == VITRAIL_SUCCESS, framed.target != nullptr);
      EXPECT_TRUE(framed.result == VITRAIL_SUCCESS || last != 0);
      vitrailGlDestroyTarget(framed.target);
    }
    vitrailGlDestroyContext(std::exchange(context_, nullptr));
    if (last == 0) calls = tap.calls;
    if (::testing::Test::HasFailure()) {
      FAIL() << "lost at call " << last << ", " << (last == 0 ? "none" : calls[last - 1].name);
    }
  }
}

} // namespace
} // namespace vitrail::tests::opengl
