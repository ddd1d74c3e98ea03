// What a method tells of a frame that it drew: plain numbers, which drivers pass on and report/ writes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vitrail::tool {

// A part of a picture that was drawn by itself.
struct DrawnTile {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint64_t fragments = 0;
};

// What a method counts that rasterises by itself, tile by tile.
struct RasterCounts {
  std::uint64_t triangles = 0; // that were drawn
  std::uint64_t vertices = 0;  // whose places were worked out once
  std::uint64_t records = 0;   // triangles in tiles
};

struct FrameStats {
  // What was taken of the choices that the method has; empty where it has none.
  std::string nodes{};       // "compact", "standard", "hdr"
  std::string resolve{};     // "compute", "fragment"
  std::string listBuild{};   // the same of who puts fragments on their lists
  std::string stencilMark{}; // "on", "off", of drawn resolves that can have one
  bool complete = false;     // every surface was blended, in order
  // How far a complete picture may be from the real-number answer for how the method stores surfaces, in 1/255 of the
  // sRGB picture.
  double errorBound = 1.0;
  bool counted = false; // whether the method counts fragments: else the counts and layers are 0
  std::uint64_t fragmentsRequested = 0;
  std::uint64_t fragmentsStored = 0;
  std::uint64_t fragmentsMissing = 0;
  std::uint32_t approximatePixels = 0;
  std::uint32_t cutPixels = 0; // pixels that the driver did not let the method finish
  std::uint32_t layersMax = 0;
  double layersMean = 0.0;             // over pixels that hold at least one fragment; 0 where there are none
  std::uint32_t tiles = 1;             // areas that were collected and resolved one after the other
  std::vector<DrawnTile> drawnTiles{}; // these areas, of fragment lists where there are several; else empty
  std::uint32_t nodeCapacity = 0;      // of pictures that were drawn in flight: nodes that there was room for
  std::uint64_t nodesBytes = 0;
  std::uint64_t headsBytes = 0;
  std::uint64_t totalBytes = 0;             // all that the method keeps on the device for its target
  std::optional<RasterCounts> raster{};     // of methods that have them, of pictures that were drawn as a whole
  std::vector<std::uint32_t> pixelLayers{}; // of layer-count alone: the fragments of each pixel, rows top to bottom
};

// Within 1/255 of the real-number answer.
inline bool isExact(const FrameStats& stats) { return stats.complete && stats.errorBound <= 1.0; }

// FrameStats::layersMean of so many pixels that have fragments.
inline double meanLayers(std::uint64_t fragments, std::uint64_t coveredPixels) {
  return coveredPixels > 0 ? static_cast<double>(fragments) / static_cast<double>(coveredPixels) : 0.0;
}

} // namespace vitrail::tool
