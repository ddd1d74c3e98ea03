// The library's rasteriser for CPUs, as the tool calls it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <vitrail/cpu.h>

namespace vitrail::tool {

// A context with its defaults, but for the number of threads where one is given. Its errors become GpuErrors that say
// the reason.
class Rasterizer {
 public:
  explicit Rasterizer(std::uint32_t threads = 0);
  ~Rasterizer();
  Rasterizer(const Rasterizer&) = delete;
  Rasterizer& operator=(const Rasterizer&) = delete;

  void render(const VitrailCpuFrame& frame, std::span<const VitrailCpuDraw> draws, VitrailStats* stats);

  [[nodiscard]] std::uint32_t threads() const;
  // The most that the fragments of a frame have taken so far.
  [[nodiscard]] std::uint64_t fragmentBytes() const { return fragmentBytes_; }
  // The processor, as the system names it, its vector instructions and the threads: "AMD EPYC (AVX2, 2 threads)".
  [[nodiscard]] std::string name() const;

 private:
  void check(VitrailResult result);

  VitrailCpuContext context_ = nullptr;
  std::string reason_; // of the last error
  std::uint64_t fragmentBytes_ = 0;
};

} // namespace vitrail::tool
