#include "host.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace vitrail::tests::raster {

std::vector<VitrailCpuInstructions> instructionsHere() {
  std::vector<VitrailCpuInstructions> here;
  for (const VitrailCpuInstructions instructions :
       {VITRAIL_CPU_AVX512, VITRAIL_CPU_AVX2, VITRAIL_CPU_SSE4, VITRAIL_CPU_NEON, VITRAIL_CPU_BASELINE}) {
    VitrailCpuContextDesc desc{};
    desc.threads = 1;
    desc.instructions = instructions;
    VitrailCpuContext context = nullptr;
    if (vitrailCpuCreateContext(&desc, &context) == VITRAIL_SUCCESS) here.push_back(instructions);
    vitrailCpuDestroyContext(context);
  }
  return here;
}

Raster::Raster(VitrailCpuContextDesc desc) {
  desc.log = [](VitrailLogSeverity, const char* text, void* user) {
    static_cast<Raster*>(user)->lines_.emplace_back(text);
  };
  desc.logUser = this;
  EXPECT_EQ(vitrailCpuCreateContext(&desc, &context_), VITRAIL_SUCCESS);
}

Raster::Raster(VitrailCpuInstructions instructions, std::uint32_t threads)
    : Raster([&] {
        VitrailCpuContextDesc desc{};
        desc.instructions = instructions;
        desc.threads = threads;
        return desc;
      }()) {}

Raster::~Raster() {
  vitrailCpuDestroyContext(context_);
  for (const std::string& line : lines_) ADD_FAILURE() << "the library said: " << line;
}

VitrailResult Raster::render(const VitrailCpuFrame& frame, std::span<const VitrailCpuDraw> draws, VitrailStats* stats) {
  return vitrailCpuRender(context_, &frame, draws.data(), static_cast<std::uint32_t>(draws.size()), stats);
}

std::vector<std::string> Raster::takeLog() { return std::exchange(lines_, {}); }

Picture::Picture(std::uint32_t pictureWidth, std::uint32_t pictureHeight, std::array<float, 4> background)
    : width(pictureWidth), height(pictureHeight) {
  for (std::size_t i = 0; i < std::size_t{width} * height; ++i) {
    pixels.insert(pixels.end(), background.begin(), background.end());
  }
}

VitrailCpuFrame Picture::frame() {
  VitrailCpuFrame frame{};
  frame.width = width;
  frame.height = height;
  frame.color = pixels.data();
  return frame;
}

std::uint32_t roundsOfTests() {
  const char* rounds = std::getenv("VITRAIL_TEST_FRAMES");
  return rounds == nullptr ? 1 : static_cast<std::uint32_t>(std::max(1, std::atoi(rounds)));
}

VitrailCpuDraw drawOf(const std::vector<Position>& positions) {
  VitrailCpuDraw draw{};
  draw.positions = positions.empty() ? nullptr : positions.front().data();
  draw.vertexCount = static_cast<std::uint32_t>(positions.size());
  return draw;
}

Position inPixels(std::uint32_t width, std::uint32_t height, double x, double y, float depth, float w) {
  return {static_cast<float>((x / width * 2.0 - 1.0) * w), static_cast<float>((y / height * 2.0 - 1.0) * w), depth * w,
          w};
}

} // namespace vitrail::tests::raster
