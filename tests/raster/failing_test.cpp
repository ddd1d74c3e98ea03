// No memory, no threads, a host that gives up: an error and a line in the log, and the context goes on.
#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>

#include "failing.h"
#include "scene.h"

namespace vitrail::tests::raster {
namespace {

SceneOptions smallScene(std::uint32_t samples) {
  SceneOptions options;
  options.width = 70;
  options.height = 40;
  options.samples = samples;
  options.hasFilters = options.hasOpaque = options.hasDepth = options.isClipped = true;
  return options;
}

// Counts lines without memory of its own.
struct Lines {
  std::atomic<std::uint32_t> count{0};

  static void log(VitrailLogSeverity /*severity*/, const char* /*text*/, void* user) {
    ++static_cast<Lines*>(user)->count;
  }
};

VitrailResult tryDraw(VitrailCpuContext context, const Scene& scene, const std::vector<VitrailCpuDraw>& draws,
                      Drawn& drawn) {
  VitrailCpuFrame frame = scene.frame;
  frame.color = drawn.pixels.data();
  frame.depth = drawn.depth.data();
  return vitrailCpuRender(context, &frame, draws.data(), static_cast<std::uint32_t>(draws.size()), &drawn.stats);
}

// Lets each allocation of a frame fail in turn, until none does.
void expectOutOfMemory(VitrailCpuContextDesc desc, bool allAfter) {
  Random random(50);
  const Scene scene = randomScene(random, smallScene(2));
  const std::vector<VitrailCpuDraw> draws = scene.descs();
  Lines lines;
  desc.log = Lines::log;
  desc.logUser = &lines;
  Raster plain(VITRAIL_CPU_BEST);
  const Drawn expected = draw(plain, scene);
  std::uint32_t failures = 0;
  for (std::uint64_t n = 0;; n += 1 + n / 16) {
    VitrailCpuContext context = nullptr;
    failAllocation(n, allAfter);
    const VitrailResult made = vitrailCpuCreateContext(&desc, &context);
    if (stopFailingAllocations()) {
      EXPECT_EQ(made, VITRAIL_ERROR_OUT_OF_MEMORY);
      EXPECT_EQ(context, nullptr);
      EXPECT_EQ(lines.count.exchange(0), 1U);
      continue;
    }
    Drawn drawn{scene.background, scene.depth, {}};
    failAllocation(n, allAfter);
    const VitrailResult result = tryDraw(context, scene, draws, drawn);
    const bool failed = stopFailingAllocations();
    // Where less memory does as well (std::inplace_merge), the frame is drawn all the same.
    EXPECT_TRUE(result == VITRAIL_SUCCESS ? drawn == expected : failed && result == VITRAIL_ERROR_OUT_OF_MEMORY)
        << "allocation " << n;
    EXPECT_EQ(lines.count.exchange(0), result == VITRAIL_SUCCESS ? 0U : 1U) << "allocation " << n;
    // The same context draws the same frame once there is memory.
    drawn = {scene.background, scene.depth, {}};
    EXPECT_EQ(tryDraw(context, scene, draws, drawn), VITRAIL_SUCCESS);
    EXPECT_TRUE(drawn == expected) << "after allocation " << n << " failed";
    vitrailCpuDestroyContext(context);
    failures += static_cast<std::uint32_t>(result != VITRAIL_SUCCESS);
    if (!failed) break;
  }
  EXPECT_GT(failures, 10U);
}

void inTurn(void* /*user*/, std::uint32_t count, void (*task)(void* data, std::uint32_t i), void* data) {
  for (std::uint32_t i = 0; i < count; ++i) task(data, i);
}

TEST(OutOfMemoryTest, IsAnErrorOnOneThread) {
  VitrailCpuContextDesc desc{};
  desc.threads = 1;
  expectOutOfMemory(desc, false);
  expectOutOfMemory(desc, true);
}
TEST(OutOfMemoryTest, IsAnErrorOnTheHostsThreads) {
  VitrailCpuContextDesc desc{};
  desc.threads = 3;
  desc.parallel = inTurn;
  expectOutOfMemory(desc, false);
  expectOutOfMemory(desc, true);
}
TEST(OutOfMemoryTest, IsAnErrorOnTheContextsThreads) {
  VitrailCpuContextDesc desc{};
  desc.threads = 2;
  expectOutOfMemory(desc, false);
}

#if !defined(VITRAIL_TEST_SANITIZED)

// In a process of its own: draws with `allowed` threads more than there are. Its exit code is 0 if the frame is drawn,
// 1 if that is an error with a line in the log, and another one for anything else.
[[noreturn]] void drawWithFewThreads(std::uint32_t allowed) {
  Random random(51);
  const Scene scene = randomScene(random, smallScene(1));
  Lines lines;
  VitrailCpuContextDesc desc{};
  desc.threads = 16;
  desc.log = Lines::log;
  desc.logUser = &lines;
  failThreads(allowed);
  VitrailCpuContext context = nullptr;
  VitrailResult result = vitrailCpuCreateContext(&desc, &context);
  for (int i = 0; i < 20 && result == VITRAIL_SUCCESS; ++i) {
    Drawn drawn{scene.background, scene.depth, {}};
    result = tryDraw(context, scene, scene.descs(), drawn);
  }
  std::_Exit(result == VITRAIL_SUCCESS && lines.count == 0             ? 0
             : result == VITRAIL_ERROR_UNSUPPORTED && lines.count == 1 ? 1
                                                                       : 2);
}

TEST(RefusedThreadsDeathTest, EndInAPictureOrAnError) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  for (const std::uint32_t allowed : {0U, 1U, 2U, 5U}) {
    EXPECT_EXIT(
        drawWithFewThreads(allowed),
        [](int status) { return WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 1); }, "")
        << allowed << " threads";
  }
}

#endif

// ---- Hosts that give up

struct Told {
  std::uint32_t last = 0;
  std::uint32_t tiles = 0;
  std::uint32_t giveUpAt = ~0U;
  bool isInOrder = true;
};

int onProgress(void* user, std::uint32_t done, std::uint32_t tiles) {
  Told& told = *static_cast<Told*>(user);
  told.isInOrder = told.isInOrder && done == told.last + 1 && (told.tiles == 0 || told.tiles == tiles);
  told.last = done;
  told.tiles = tiles;
  return done >= told.giveUpAt ? 1 : 0;
}

TEST(ProgressTest, IsToldAndMayGiveUp) {
  Random random(52);
  SceneOptions options = smallScene(1);
  options.width = 200;
  options.height = 100;
  const Scene scene = randomScene(random, options);
  for (const std::uint32_t threads : {1U, 4U}) {
    Raster raster(VITRAIL_CPU_BEST, threads);
    const Drawn expected = draw(raster, scene);
    for (const std::uint32_t giveUpAt : {~0U, 1U, 9U, 28U}) {
      Told told;
      told.giveUpAt = giveUpAt;
      Drawn drawn{scene.background, scene.depth, {}};
      VitrailCpuFrame frame = scene.frame;
      frame.color = drawn.pixels.data();
      frame.depth = drawn.depth.data();
      frame.progress = onProgress;
      frame.progressUser = &told;
      const VitrailResult result = raster.render(frame, scene.descs(), &drawn.stats);
      EXPECT_EQ(result, giveUpAt == ~0U ? VITRAIL_SUCCESS : VITRAIL_INCOMPLETE);
      EXPECT_TRUE(told.isInOrder);
      EXPECT_EQ(told.tiles, 28U);
      EXPECT_EQ(told.last, std::min(giveUpAt, 28U)) << "told on after it gave up";
      EXPECT_EQ(drawn.stats.complete, giveUpAt == ~0U ? 1U : 0U);
      EXPECT_TRUE(giveUpAt != ~0U || drawn == expected);
    }
  }
}

// Hosts in C++ may throw where C++ says they should not; whatever it is, it goes no farther than the call.
TEST(HostExceptionTest, IsAnErrorOfTheFrame) {
  std::vector<Position> positions;
  for (const auto& [x, y] : {std::pair{-1.0F, -1.0F}, {3.0F, -1.0F}, {-1.0F, 3.0F}})
    positions.push_back({x, y, 0.5F, 1.0F});
  VitrailCpuDraw throwing = drawOf(positions);
  for (const bool isStandard : {false, true}) {
    throwing.shade = isStandard ? [](void*, VitrailCpuFragments*) { throw std::runtime_error("none"); }
                                : [](void*, VitrailCpuFragments*) { throw 1; };
    for (const std::uint32_t threads : {1U, 2U}) {
      Raster raster(VITRAIL_CPU_BEST, threads);
      Picture picture(64, 64);
      EXPECT_EQ(raster.render(picture.frame(), {&throwing, 1}), VITRAIL_ERROR_UNSUPPORTED);
      EXPECT_EQ(raster.takeLog().size(), 1U);
      const VitrailCpuDraw plain = drawOf(positions);
      EXPECT_EQ(raster.render(picture.frame(), {&plain, 1}), VITRAIL_SUCCESS);
    }
  }
}

} // namespace
} // namespace vitrail::tests::raster
