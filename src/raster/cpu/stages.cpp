// The stages, compiled once for each set of instructions.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/cpu/stages.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "raster/cpu/frame.h"
#include "raster/cpu/geometry-inl.h"
#include "raster/cpu/tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

std::unique_ptr<TileWorkspace> makeWorkspace(const Frame& frame) { return std::make_unique<TileWorker>(frame); }

void drawTile(const Frame& frame, std::uint32_t tile, TileWorkspace& workspace, TileCounts& counts) {
  static_cast<TileWorker&>(workspace).draw(frame, tile, counts);
}

constexpr VitrailCpuInstructions kInstructions =
#if HWY_TARGET == HWY_AVX3
    VITRAIL_CPU_AVX512;
#elif HWY_TARGET == HWY_AVX2
    VITRAIL_CPU_AVX2;
#elif HWY_TARGET == HWY_SSE4
    VITRAIL_CPU_SSE4;
#elif HWY_TARGET == HWY_NEON
    VITRAIL_CPU_NEON;
#else
    VITRAIL_CPU_BASELINE;
#endif

extern const Stages kStages;
const Stages kStages{kInstructions, placeVertices, binJob, makeWorkspace, drawTile};

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrail::raster {

namespace {

// A target's stages, where the library has them and the processor its instructions.
struct Choice {
  std::int64_t target;
  const Stages* stages;
};

} // namespace

std::span<const Stages* const> stagesHere() {
  static const std::vector<const Stages*> here = [] {
    const std::vector<Choice> choices {
#if HWY_TARGETS & HWY_AVX3
      {HWY_AVX3, &N_AVX3::kStages},
#endif
#if HWY_TARGETS & HWY_AVX2
          {HWY_AVX2, &N_AVX2::kStages},
#endif
#if HWY_TARGETS & HWY_SSE4
          {HWY_SSE4, &N_SSE4::kStages},
#endif
#if HWY_TARGETS & HWY_NEON
          {HWY_NEON, &N_NEON::kStages},
#endif
          {HWY_STATIC_TARGET, &HWY_NAMESPACE::kStages},
    };
    std::vector<const Stages*> found;
    for (const Choice& choice : choices) {
      const bool isThere = (hwy::SupportedTargets() & choice.target) != 0;
      if (isThere && (found.empty() || found.back() != choice.stages)) found.push_back(choice.stages);
    }
    return found;
  }();
  return here;
}

} // namespace vitrail::raster
#endif
