// A host in C++17 of the rasteriser for CPUs: panes of glass that cut through each other, drawn by one thread, by
// threads of the context's own, by threads of the host's own, and in four parts. Every picture must have the same bits.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#define VITRAIL_NO_VULKAN
#include <vitrail/cpu.h>
#include <vitrail/vitrail.hpp>

namespace {

constexpr uint32_t kWidth = 160;
constexpr uint32_t kHeight = 120;
using Picture = std::vector<float>;

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "cpu_cpp: %s\n", what);
  std::exit(1);
}

struct Destroy {
  void operator()(VitrailCpuContext context) const { vitrailCpuDestroyContext(context); }
};
using Context = std::unique_ptr<VitrailCpuContext_T, Destroy>;

Context createContext(uint32_t threads, VitrailCpuParallel parallel = nullptr) {
  VitrailCpuContextDesc desc{};
  desc.threads = threads;
  desc.parallel = parallel;
  desc.log = [](VitrailLogSeverity, const char* message, void*) { std::fprintf(stderr, "cpu_cpp: %s\n", message); };
  VitrailCpuContext context = nullptr;
  if (vitrailCpuCreateContext(&desc, &context) != VITRAIL_SUCCESS) fail("there is no context");
  return Context(context);
}

void runOnOwnThreads(void* /*user*/, uint32_t count, void (*task)(void* data, uint32_t i), void* data) {
  std::vector<std::thread> threads;
  for (uint32_t i = 0; i < count; ++i) threads.emplace_back([=] { task(data, i); });
  for (std::thread& thread : threads) thread.join();
}

// Eleven panes in a fan, each through all the others.
std::vector<float> panes() {
  std::vector<float> corners;
  for (int i = 0; i < 11; ++i) {
    const float lean = 0.08F * static_cast<float>(i - 5);
    const float places[6][2] = {{-0.9F, -0.9F}, {0.9F, -0.9F}, {-0.9F, 0.9F},
                                {-0.9F, 0.9F},  {0.9F, -0.9F}, {0.9F, 0.9F}};
    for (const auto& place : places) {
      for (const float v : {place[0], place[1], 0.5F + lean * (place[0] + place[1]), 1.0F}) corners.push_back(v);
    }
  }
  return corners;
}

VitrailStats drawPart(VitrailCpuContext context, Picture& picture, const VitrailRect& part) {
  const std::vector<float> corners = panes();
  VitrailCpuDraw draw{};
  draw.positions = corners.data();
  draw.vertexCount = static_cast<uint32_t>(corners.size() / 4);
  draw.brightest = 1.0F;
  draw.shade = [](void* /*user*/, VitrailCpuFragments* f) {
    for (int i = 0; i < VITRAIL_CPU_LANES; ++i) {
      for (uint32_t c = 0; c < 3; ++c) f->color[c][i] = (f->triangle[i] / 2 + c) % 3 == 0 ? 1.0F : f->second[i];
      f->color[3][i] = 0.3F;
    }
  };
  VitrailCpuFrame frame{};
  frame.width = part.width;
  frame.height = part.height;
  frame.pictureWidth = kWidth;
  frame.pictureHeight = kHeight;
  frame.originX = part.x;
  frame.originY = part.y;
  frame.samples = 4;
  frame.color = picture.data() + (std::size_t{part.y} * kWidth + part.x) * 4;
  frame.colorStride = kWidth * 16;
  VitrailStats stats{};
  if (vitrailCpuRender(context, &frame, &draw, 1, &stats) != VITRAIL_SUCCESS) fail("the frame was not drawn");
  if (stats.complete == 0 || stats.exact == 0) fail("the frame is not exact");
  return stats;
}

Picture drawWhole(const Context& context) {
  Picture picture(std::size_t{4} * kWidth * kHeight);
  const VitrailStats stats = drawPart(context.get(), picture, {0, 0, kWidth, kHeight});
  if (stats.layersMax < 11) fail("the deepest pixel has not one layer of each pane");
  return picture;
}

} // namespace

int main() {
  if (vitrailVersion() != VITRAIL_VERSION) fail("the library has not the version of its headers");
  const Context alone = createContext(1);
  const Picture picture = drawWhole(alone);
  if (picture[(60 * kWidth + 80) * 4 + 3] < 0.9F) fail("the middle of the picture is empty");
  if (picture[3] != 0.0F) fail("the corner of the picture is not");
  if (drawWhole(createContext(2)) != picture) fail("two threads draw another picture");
  if (drawWhole(createContext(3, runOnOwnThreads)) != picture) fail("the host's own threads draw another picture");
  Picture parts(picture.size());
  for (const uint32_t x : {0U, 72U}) {
    for (const uint32_t y : {0U, 50U}) {
      drawPart(alone.get(), parts, {x, y, x == 0 ? 72 : kWidth - 72, y == 0 ? 50 : kHeight - 50});
    }
  }
  if (parts != picture) fail("four parts make another picture");
  std::printf("cpu_cpp: all pictures have the same bits\n");
}
