// Per-pixel linked lists: exact transparency through libvitrail, as any host embeds it.
//
// A picture is drawn whole where that fits, into a pool that grows until it does. A picture that does not fit into the
// memory budget, or by default into what the device can hold, is drawn in tiles.
#pragma once

#include <optional>
#include <span>
#include <string>

#include <vitrail/vitrail.hpp>

#include "../draw/device.h"
#include "method.h"

namespace vitrail::tool {

class LinkedList final : public Method {
 public:
  // Throws GpuError.
  LinkedList(const MethodHost& host, const MethodOptions& options);
  ~LinkedList() override;

  std::string_view name() const override { return "linked-list"; }
  std::string_view nodes() const override { return nameOf(options_.nodes); }
  std::string_view resolve() const override { return nameOf(options_.resolve); }
  std::string_view linking() const override { return nameOf(pipelines_.listBuild); }
  MethodNeeds needs() const override { return needs_; }
  void setTarget(const MethodTarget& target) override;
  void releaseTarget() override;
  void draw(Frame& frame) override;
  bool finish() override;
  MethodStats stats() const override;

 private:
  void makeContext();
  void chooseResolve();
  void makeSurfaces();
  VitrailVkTargetDesc targetDesc() const;
  bool createTarget(const VitrailVkTargetDesc& desc);
  bool createWholeTarget(std::uint32_t nodeCapacity);
  void planTiles(std::span<const VitrailBounds> bounds);
  void drawTiles(Frame& frame);
  void drawArea(Frame& frame, const VkRect2D& area);
  VitrailStats readStats() const;
  void grow(std::uint64_t fragments);
  void add(const VitrailStats& stats);
  void check(VkResult result, const char* call) const;

  // What pipelines differ in beside the options.
  struct PipelineKind {
    VitrailListBuild linking = VITRAIL_LIST_BUILD_DEFAULT;
    bool depthFromW = false; // shaders/collect.frag
    bool operator==(const PipelineKind&) const = default;
  };

  Gpu& gpu_;
  const Surfaces& source_;
  MethodOptions options_;
  MethodNeeds needs_;
  std::string reason_; // what the library last logged
  Context context_;
  PipelineKind pipelines_; // of surfaces_
  std::optional<SurfacePipelines> surfaces_;
  Target target_;
  std::uint64_t frame_ = 0;  // of the target: rises with every area
  TilePlan plan_;            // where inTiles_
  VitrailVkTargetDesc made_{}; // what target_ was made for; its pointers are not kept
  MethodTarget wanted_;
  std::uint64_t budget_ = 0;   // bytes for a tile
  bool inTiles_ = false;       // the next picture is
  bool wasInTiles_ = false;    // the present picture is
  std::uint64_t expected_ = 0; // the fragments of the last picture, 0 where that is not known
  std::uint64_t counted_ = 0;  // the target's bytes, as the Gpu counts them
  MethodStats stats_;          // of the present picture's areas so far
  std::uint64_t coveredPixels_ = 0;
};

} // namespace vitrail::tool
