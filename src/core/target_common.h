// What targets of all backends do alike on the host's side: templates over the backends' structures, whose fields
// have the same names.
#pragma once

#include <algorithm>
#include <cstdint>

#include "growth.h"
#include "target_rules.h"

namespace vitrail {

// The fields that descriptors of a target have by the same name and type; those of some backends are taken where they
// are there.
template <class Desc>
TargetInfo infoOf(const Desc& desc) {
  TargetInfo info;
  if constexpr (requires { desc.extent; }) {
    info.width = desc.extent.width;
    info.height = desc.extent.height;
  } else {
    info.width = desc.width;
    info.height = desc.height;
  }
  info.samples = desc.samples;
  info.nodeFormat = desc.nodeFormat;
  info.depthOrder = desc.depthOrder;
  info.resolve = desc.resolve;
  info.msaaResolve = desc.msaaResolve;
  info.maxLayers = desc.maxLayers;
  info.overflow = desc.overflow;
  info.listBuild = desc.listBuild;
  info.userWords = desc.userWords != 0;
  info.nodeCapacity = desc.nodeCapacity;
  info.memoryBudget = desc.memoryBudget;
  info.areaPixels = desc.areaPixels;
  info.copyLayers = desc.copyLayers;
  info.framesInFlight = desc.framesInFlight;
  if constexpr (requires { desc.stencilMark; }) info.stencilMark = desc.stencilMark != 0;
  if constexpr (requires { desc.postDepthCoverage; }) info.postDepthCoverage = desc.postDepthCoverage != 0;
  if constexpr (requires { desc.bufferOffset; }) { // of one buffer
    info.ownBuffer = desc.buffer != decltype(desc.buffer){};
    info.bufferOffset = desc.bufferOffset;
    info.bufferSize = desc.bufferSize;
  }
  return info;
}

// The first of an array that is null: a pointer, a handle or a name.
template <class View>
void findNull(const View* views, std::uint32_t count, const char* what, ViewsInfo& info) {
  if (views == nullptr || info.nullName != nullptr) return;
  const View* found = std::find(views, views + count, View{});
  if (found == views + count) return;
  info.nullName = what;
  info.nullIndex = static_cast<std::uint32_t>(found - views);
}

// What a host gives of the arrays color, opaque and depth.
template <class Views>
ViewsInfo infoOfViews(const Views& views) {
  ViewsInfo info;
  info.count = views.count;
  info.color = views.color != nullptr;
  info.opaque = views.opaque != nullptr;
  info.depth = views.depth != nullptr;
  if (views.count > VITRAIL_MAX_VIEWS) return info; // the arrays are not trusted
  findNull(views.color, views.count, "color", info);
  findNull(views.opaque, views.count, "opaque", info);
  findNull(views.depth, views.count, "depth", info);
  return info;
}

// Copies the views that there are into an array of structures with these fields.
template <class Kept, class Views>
void keepViewsOf(Kept& kept, const Views& views) {
  kept = {};
  for (std::uint32_t i = 0; i < views.count; ++i) {
    if (views.color != nullptr) kept.at(i).color = views.color[i];
    if (views.opaque != nullptr) kept.at(i).opaque = views.opaque[i];
    if (views.depth != nullptr) kept.at(i).depth = views.depth[i];
  }
}

// The target under what the host's budget leaves for its lists, beside `beside` bytes.
inline TargetInfo underBudget(TargetInfo info, std::uint64_t budget, std::uint64_t beside) {
  if (budget != 0) info.memoryBudget = budget - std::min(budget - 1, beside);
  return info;
}

// The statistics of the newest finished frame, of `frame` and those before it that still have one of `slots` slots:
// `read` tells whether a frame has any.
template <class Read>
bool readNewestOf(std::uint64_t frame, std::size_t slots, Read read) {
  for (std::uint64_t back = 0; back < slots && back <= frame; ++back) {
    if (read(frame - back)) return true;
  }
  return false;
}

// The pool that a target with a budget is to have before a frame, whose newest statistics `read` gives, if any.
template <class Read>
std::uint32_t wantedCapacity(Growth& growth, const DeviceLimits& limits, const TargetInfo& info, std::uint32_t present,
                             Read read) {
  VitrailStats stats{};
  if (info.memoryBudget == 0 || !read(stats) || !growth.isNews(stats.frame)) return present;
  return growth.wanted(stats, present, budgetCapacity(limits, info));
}

// vitrail*TargetMemory(): of a target's present memory, of what it has `beside`, and of memory that frames in flight
// still use.
inline void tellMemory(VitrailMemory& memory, const StorageNeeds& needs, const StorageLayout& layout,
                       std::uint64_t beside, std::uint64_t retired) {
  memory.nodeCapacity = needs.nodeCapacity;
  memory.nodeBytes = layout.nodes.size;
  memory.headBytes = layout.heads.size;
  memory.otherBytes = layout.total + beside - memory.nodeBytes - memory.headBytes;
  memory.retiredBytes = retired;
  memory.totalBytes = layout.total + beside + retired;
}

// vitrail*TilePlanTarget().
template <class Desc>
void tilePlanTarget(VitrailTilePlan plan, Desc* desc) {
  if (plan == nullptr || desc == nullptr) return;
  desc->nodeCapacity = vitrailTilePlanNodeCapacity(plan);
  desc->areaPixels = vitrailTilePlanAreaPixels(plan);
  desc->memoryBudget = 0;
  desc->overflow = VITRAIL_OVERFLOW_SKIP;
}

} // namespace vitrail
