// What the suites of the rasteriser share: a context that keeps what it says, pictures, and coordinates in pixels.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <vitrail/cpu.h>

namespace vitrail::tests::raster {

using Position = std::array<float, 4>; // clip space

// The sets of instructions that this processor has.
std::vector<VitrailCpuInstructions> instructionsHere();
inline const char* nameOf(VitrailCpuInstructions instructions) { return vitrailCpuInstructionsName(instructions); }

// A context. What it logs is a failed test unless the test takes it.
class Raster {
 public:
  explicit Raster(VitrailCpuContextDesc desc = {});
  explicit Raster(VitrailCpuInstructions instructions, std::uint32_t threads = 1);
  ~Raster();
  Raster(const Raster&) = delete;
  Raster& operator=(const Raster&) = delete;

  VitrailCpuContext get() const { return context_; }
  VitrailResult render(const VitrailCpuFrame& frame, std::span<const VitrailCpuDraw> draws,
                       VitrailStats* stats = nullptr);
  // The lines since the last call.
  std::vector<std::string> takeLog();

 private:
  VitrailCpuContext context_ = nullptr;
  std::vector<std::string> lines_;
};

// A picture of RGBA32F, and the frame that draws it.
struct Picture {
  Picture(std::uint32_t width, std::uint32_t height, std::array<float, 4> background = {0.0F, 0.0F, 0.0F, 1.0F});

  std::uint32_t width;
  std::uint32_t height;
  std::vector<float> pixels; // 4 a pixel

  VitrailCpuFrame frame();
  const float* at(std::uint32_t x, std::uint32_t y) const { return &pixels[(std::size_t{y} * width + x) * 4]; }
};

// Triangles of vertices one after the other; the vector outlives the draw.
VitrailCpuDraw drawOf(const std::vector<Position>& positions);

// Clip space of a place in pixels of a picture, with y down.
Position inPixels(std::uint32_t width, std::uint32_t height, double x, double y, float depth = 0.5F, float w = 1.0F);

// How often random frames are drawn: VITRAIL_TEST_FRAMES, for long runs by hand.
std::uint32_t roundsOfTests();

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  float single(double low, double high) { return static_cast<float>(real(low, high)); }
  std::uint32_t below(std::uint32_t count) {
    return std::uniform_int_distribution<std::uint32_t>(0, count - 1)(engine_);
  }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  std::mt19937_64& engine() { return engine_; }

 private:
  std::mt19937_64 engine_;
};

} // namespace vitrail::tests::raster
