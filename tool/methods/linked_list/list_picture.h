// How a picture of fragment lists is drawn, whatever the API: whole where that fits, into a pool that grows until it
// does, with a memory budget as the library lets it grow, within the budget; else in tiles. No graphics API.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include <vitrail/vitrail.hpp>

#include "../../stage/surface_list.h"
#include "../frame_stats.h"
#include "../method_options.h"

namespace vitrail::tool {

// What a target is made for.
struct ListPool {
  std::uint32_t nodeCapacity = 0;
  std::uint64_t memoryBudget = 0; // of a target that follows what pictures need
  std::uint32_t areaPixels = 0;   // of one that tiles are drawn with; 0: the whole picture

  bool operator==(const ListPool&) const = default;
};

struct ListPictureInfo {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::optional<std::uint64_t> memoryBudget;
  bool surfaces = true;          // whether there is anything transparent
  bool writesEveryPixel = false; // the resolve makes the picture out of several samples
  bool words = false;            // nodes have words of the tool's
  VitrailListBuild listBuild = VITRAIL_LIST_BUILD_FRAGMENT;
  std::function<void(std::uint32_t tiles)> onTile;
};

class ListPicture {
 public:
  // The surfaces outlive it.
  ListPicture(const SurfaceList& surfaces, const MethodOptions& options) : surfaces_(surfaces), options_(options) {}
  virtual ~ListPicture() = default;
  ListPicture(const ListPicture&) = delete;
  ListPicture& operator=(const ListPicture&) = delete;

 protected:
  // What pictures are like from now on; makes a target for them.
  void start(const ListPictureInfo& info);
  void setOnTile(std::function<void(std::uint32_t tiles)> onTile) { info_.onTile = std::move(onTile); }
  // The same for pictures that are not waited for, each of which is drawn once, into a pool that follows what the last
  // ones needed, up to the budget, else up to `most` bytes. False: there is no room for such a target.
  bool startInFlight(const ListPictureInfo& info, std::uint64_t most);
  bool isEmpty() const { return nothing_; } // there is nothing to draw
  // What was counted of a picture that was drawn so.
  FrameStats totalsOf(const VitrailStats& stats);
  // Draws one. The opaque scene has been drawn.
  void drawPicture();
  // Once it is drawn: false where it must be drawn again, for which there is room now.
  bool finishPicture();
  // What was counted of it, and the memory of the target.
  FrameStats totals() const;

  // What the library last logged as an error.
  std::string& reason() { return reason_; }
  // Throws GpuError where `result` is an error of the call.
  void check(VitrailResult result, const char* call) const;
  std::uint64_t pixels() const { return std::uint64_t{info_.width} * info_.height; }

 private:
  // Makes a target for that, in place of the one there was. False where the device has no memory for it.
  virtual bool makeTarget(const ListPool& pool) = 0;
  // Lets the pool of a target with a memory budget follow what frames needed.
  virtual VitrailResult updateTarget() = 0;
  virtual std::optional<VitrailMemory> memory() const = 0; // nothing: there is no target
  virtual std::uint64_t mostNodes() const = 0;             // of a pool
  virtual VitrailTileLimits tileLimits() const = 0;
  // Collects and resolves an area of the picture, as a frame of the target.
  virtual void drawArea(const VitrailRect& area, std::span<const SurfaceRun> runs) = 0;
  // Waits for what has been drawn.
  virtual void wait() = 0;
  // Of the last area, which has been drawn.
  virtual VitrailStats readStats() const = 0;

  void makeFixedTarget(bool buildsAll);
  bool makeWholeTarget(std::uint64_t nodeCapacity);
  void planTiles();
  void drawTiles();
  std::uint64_t wordsOf(std::uint64_t bytes) const;
  bool grow(std::uint64_t fragments);
  void add(const VitrailStats& stats);

  const SurfaceList& surfaces_;
  const MethodOptions& options_;
  ListPictureInfo info_;
  std::string reason_;
  TilePlan plan_;              // where inTiles_
  std::uint64_t budget_ = 0;   // bytes for a tile
  bool nothing_ = false;       // there is nothing transparent, and nothing that a resolve has to write
  bool inTiles_ = false;       // the next picture is
  bool wasInTiles_ = false;    // the present picture is
  std::uint64_t expected_ = 0; // the fragments of the last picture, 0 where that is not known
  FrameStats stats_;           // of the present picture's areas so far
  std::uint64_t coveredPixels_ = 0;
};

// Throw GpuError for options that do not go with objects that absorb light, whose lists are walked whole; and with a
// resolve that is drawn or is not.
void requireWalk(const MethodOptions& options);
void requireMark(const MethodOptions& options, bool drawn);

} // namespace vitrail::tool
