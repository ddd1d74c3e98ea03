// Opaque surfaces of a tile: which of them is seen in each sample, and what it looks like.
#if defined(VITRAIL_OPAQUE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_OPAQUE_INL_H
#undef VITRAIL_OPAQUE_INL_H
#else
#define VITRAIL_OPAQUE_INL_H
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "raster/cpu/rasterise-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

// Of what passes the depth test, the pixels in which it does not lie at the depth of something that is drawn later.
// Pieces come when a batch of them is full; all else comes in order.
HWY_INLINE std::uint32_t TileWorker::withoutLater(const Frame& frame, const Work& work, std::uint32_t item,
                                                  std::uint32_t mask, const I* keys) {
  const std::uint32_t block = work.block();
  const auto number =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(batch_.number[work.triangle()]) & ~kFrontBit);
  std::uint32_t any = 0;
  for (std::uint32_t s = 0; s < frame.info.samples; ++s) {
    const I shown = load(opaque_->shown[s].number[block]) & set(static_cast<std::int32_t>(~kFrontBit));
    const std::uint32_t later =
        bitsOf((keys[s] == load(opaque_->depth[s].value[block])) & (shown > set(number + 1))); // plus 1, as below
    if (frame.info.samples == 1) return mask & ~later;
    std::uint16_t& covered = sampleMasks_[s][item];
    covered = static_cast<std::uint16_t>(covered & ~later);
    any |= covered;
  }
  return mask & any;
}

HWY_INLINE void TileWorker::emitOpaque(const Frame& frame, std::uint32_t item) {
  const Work work = work_[item];
  const std::uint32_t t = work.triangle();
  const std::uint32_t block = work.block();
  const F depth = depthOfWork(work);
  I keys[kMaxSamples];
  std::uint32_t mask = testDepth(frame, work, item, depth, keys);
  if (HWY_UNLIKELY(batch_.pieces != nullptr)) mask = withoutLater(frame, work, item, mask, keys);
  if (mask == 0) return;
  F weights[6];
  perspective(work, frame.needs.opaqueDerivatives, weights);
  const I centre = keyOfInner(depth, frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE);
  const VitrailCpuDraw& draw = frame.draws[static_cast<std::uint32_t>(batch_.draw[t])].draw;
  if ((draw.shadeFlags & VITRAIL_CPU_SHADE_DISCARD) != 0) {
    ToShade s;
    s.x = frame.info.originX + blockX(block);
    s.y = frame.info.originY + blockY(block);
    s.numbers = set(batch_.number[t]);
    s.present = maskOf(mask);
    s.depth = depthOf(centre, frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE);
    // Beside the triangle weights may be infinite: there they are 0.
    s.second = keep(s.present, weights[0]);
    s.third = keep(s.present, weights[1]);
    for (std::size_t i = 0; i < 4; ++i) s.derivatives[i] = keep(s.present, weights[2 + i]);
    shadeAll(frame, s, frame.needs.opaqueDerivatives, fragments_,
             [&](const VitrailCpuDraw& /*draw*/, const VitrailCpuFragments& f, std::uint32_t /*mask*/) {
               mask &= ~f.discarded;
             });
    if (mask == 0) return;
  }
  opaque_->drawn |= std::uint64_t{1} << block;
  for (std::uint32_t s = 0; s < frame.info.samples; ++s) {
    const std::uint32_t covered = frame.info.samples == 1 ? mask : mask & sampleMasks_[s][item];
    if (covered == 0) continue;
    const M here = maskOf(covered);
    OpaqueTile::Surface& shown = opaque_->shown[s];
    std::int32_t* nearest = opaque_->depth[s].value[block];
    store(nearest, select(here, keys[s], load(nearest)));
    store(shown.centre[block], select(here, centre, load(shown.centre[block])));
    // The number plus 1, so that 0 is none. It cannot carry into the front bit: kMaxJobs is one short of that.
    store(shown.number[block], select(here, set(batch_.number[t]) + set(1), load(shown.number[block])));
    const std::uint32_t count = frame.needs.opaqueDerivatives ? 6 : 2;
    for (std::uint32_t i = 0; i < count; ++i) {
      store(shown.weights[i][block], select(here, weights[i], load(shown.weights[i][block])));
    }
  }
}

// Shades what is seen of opaque surfaces, each once in a pixel.
inline void TileWorker::shadeOpaque(const Frame& frame, std::uint32_t block) {
  const std::uint32_t samples = frame.info.samples;
  std::array<std::uint32_t, kMaxSamples> left{}; // pixels whose sample is still to be shaded
  for (std::uint32_t s = 0; s < samples; ++s) {
    left[s] = ~bitsOf(load(opaque_->shown[s].number[block]) == set(0)) & 0xffffU;
  }
  for (std::uint32_t s = 0; s < samples; ++s) {
    if (left[s] == 0) continue;
    const OpaqueTile::Surface& shown = opaque_->shown[s];
    const I number = load(shown.number[block]);
    ToShade job;
    job.x = frame.info.originX + blockX(block);
    job.y = frame.info.originY + blockY(block);
    job.present = maskOf(left[s]);
    // Where there is none, any number that exists.
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left[s]));
    job.numbers = select(job.present, number - set(1), set(shown.number[block][lane] - 1));
    job.depth =
        keep(job.present, depthOf(load(shown.centre[block]), frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE));
    job.second = load(shown.weights[0][block]);
    job.third = load(shown.weights[1][block]);
    for (std::size_t i = 0; i < 4; ++i) job.derivatives[i] = load(shown.weights[2 + i][block]);
    const std::uint32_t shading = left[s];
    shadeAll(frame, job, frame.needs.opaqueDerivatives, fragments_,
             [&](const VitrailCpuDraw& draw, const VitrailCpuFragments& f, std::uint32_t mask) HWY_ATTR {
               F color[4];
               for (std::size_t c = 0; c < 3; ++c) color[c] = clamped(load(f.color[c]), draw.brightest);
               color[3] = set(1.0F);
               for (std::uint32_t other = s; other < samples; ++other) {
                 const std::uint32_t same =
                     bitsOf(load(opaque_->shown[other].number[block]) == number) & mask & left[other];
                 for (std::size_t c = 0; c < 4; ++c) {
                   float* to = opaque_->color[other].value[c][block];
                   store(to, select(maskOf(same), color[c], load(to)));
                 }
                 left[other] &= ~same;
               }
             });
    left[s] &= ~shading;
  }
}

inline void TileWorker::drawOpaque(const Frame& frame, std::uint32_t tile) {
  if (opaque_ == nullptr) return;
  takeNumbers(frame, tile, true);
  merge();
  hasDepth_ = !numbers_.empty() || frame.info.depth != nullptr;
  opaque_->drawn = 0;
  if (!hasDepth_) return;
  const std::uint32_t samples = frame.info.samples;
  for (std::uint32_t s = 0; s < samples; ++s) {
    std::memset(&opaque_->shown[s], 0, sizeof(OpaqueTile::Surface));
    for (auto& block : opaque_->depth[s].value) std::fill(std::begin(block), std::end(block), kFarKey);
  }
  const bool nearestIsOne = frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
  alignas(64) float depths[kLanes];
  for (std::uint32_t s = 0; frame.info.depth != nullptr && s < samples; ++s) {
    for (std::uint32_t block = 0; block < kBlocks; ++block) {
      readDepths(frame, tile_, block, s, depths);
      store(opaque_->depth[s].value[block], keyOf(load(depths), nearestIsOne));
    }
  }
  if (numbers_.empty()) return;
  rasterise(frame, ~std::uint64_t{0}, true, [&](std::uint32_t count) HWY_ATTR {
    for (std::uint32_t i = 0; i < count; ++i) emitOpaque(frame, i);
    return true;
  });
  for (std::uint64_t left = opaque_->drawn; left != 0; left &= left - 1) {
    const auto block = static_cast<std::uint32_t>(std::countr_zero(left));
    F behind[4];
    for (std::uint32_t s = 0; s < samples; ++s) {
      if (s == 0 || frame.info.sampleColors != nullptr) behindAll(frame, block, s, behind);
      for (std::size_t c = 0; c < 4; ++c) store(opaque_->color[s].value[c][block], behind[c]);
    }
    shadeOpaque(frame, block);
    for (std::uint32_t s = 0; frame.info.depth != nullptr && s < samples; ++s) {
      const I keys = load(opaque_->depth[s].value[block]);
      store(depths, depthOf(keys, nearestIsOne));
      const std::uint32_t written = ~bitsOf(load(opaque_->shown[s].number[block]) == set(0)) & 0xffffU;
      writeDepths(frame, tile_, block, s, depths, written);
    }
  }
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
