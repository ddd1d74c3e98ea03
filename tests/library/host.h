// The smallest host of the library, whatever the graphics API: it draws points, so that a test decides every fragment
// of every list, over an opaque scene whose every sample it decides too, and gives back the picture, the statistics and
// the words around the memory. Tests are written against PointHost; backend.h says where one comes from.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include <vitrail/types.h>

#include "core/pool.h"

namespace vitrail::tests {

// A device, a driver or the library could not do what a test asked for.
struct HostError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// One fragment: pixel, depth in [0, 1], linear colour, blend mode, the samples that it covers.
struct Point {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  float depth = 0.5F;
  std::array<float, 4> color{};
  std::uint32_t blend = VITRAIL_BLEND_OVER;
  std::uint32_t coverage = 0xff;
  bool stranger = false;  // drawn by HostDesc::strangersFor
  std::uint32_t word = 0; // for nodes that carry one
};

using FloatColor = std::array<float, 4>;

struct Extent {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

enum class ColorFormat { Float32, Float16 }; // of the picture; results of Float16 are not read back

// How the collecting shader is compiled: as most hosts do; for CPU drivers (VITRAIL_CPU_DRIVER); or for one kind of
// target and no other (VITRAIL_ONLY_*): `standard` nodes without words at 1 sample, lists built as collected, overflow
// skipped; or, for Vulkan, from HLSL.
enum class ShaderKind { Usual, ForCpu, Narrow, Hlsl };

struct HostDesc {
  std::uint32_t width = 8;
  std::uint32_t height = 8;
  std::uint32_t capacity = 0;
  VitrailNodeFormat nodes = VITRAIL_NODE_STANDARD;
  std::uint32_t samples = 1;
  VitrailDepthOrder depthOrder = VITRAIL_DEPTH_NEAREST_IS_ZERO;
  VitrailResolve resolve = VITRAIL_RESOLVE_COMPUTE;
  VitrailMsaaResolve msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  ColorFormat colorFormat = ColorFormat::Float32;
  std::uint32_t maxLayers = 0;
  VitrailOverflow overflow = VITRAIL_OVERFLOW_APPROXIMATE;
  VitrailListBuild listBuild = VITRAIL_LIST_BUILD_FRAGMENT;
  std::uint64_t memoryBudget = 0; // the pool follows it: every draw updates the target first
  std::uint32_t areaPixels = 0;
  bool userWords = false;
  std::uint32_t copyLayers = 0;
  bool postDepthCoverage = true;       // where there are several samples and the device has it
  bool dualSourceBlending = true;      // where the device has it
  bool addresses = false;              // the pool is reached by its address
  std::optional<bool> shaderPostDepth; // whether the collecting shader's coverage has; default: as the target takes it
  std::optional<bool> shaderByAddress; // whether the collecting shader does, too; default: it suits the pool
  bool stencilMark = false;
  bool specialized = false; // the collecting shader is, for this target or, if given, for one that differs in these
  std::optional<VitrailNodeFormat> specializedFor;
  std::optional<VitrailOverflow> specializedForOverflow;
  std::optional<VitrailListBuild> specializedForListBuild;
  // Strangers among the points are drawn by a shader that is specialized for a target that differs in this.
  std::optional<VitrailOverflow> strangersFor;
  ShaderKind shader = ShaderKind::Usual;
  bool guarded = false;      // the memory is this host's, between guard words
  bool numbersFrames = true; // else the library does
  // The fragments that are taken to have asked for a node before the first point. `guarded` only.
  std::uint32_t requestedBefore = 0;

  FloatColor behind = {0.0F, 0.0F, 0.0F, 1.0F}; // the opaque colour
  std::vector<FloatColor> behindSamples;        // the same sample by sample, if it differs
  // What the image that a per-pixel resolve of several samples writes holds before.
  FloatColor beforeResolve = {};
  std::vector<float> opaqueDepth; // by sample; default: nothing is hidden
};

// The opaque colour at a sample.
FloatColor behindAt(const HostDesc& desc, std::uint32_t sample);

struct PointResult {
  std::vector<FloatColor> pixels; // rows top to bottom; the mean of the samples
  VitrailStats stats{};
};

// A copy of lists that need not be right: to this host's buffer, which has room for the lists of 4x4 pixels.
struct CopyAttempt {
  VitrailRect area{};
  bool hasBuffer = true;
  std::uint64_t offset = 0;
  std::optional<std::uint64_t> size = {}; // default: what the buffer has from the offset on
};

// The library's calls, for tests that make them in any order and ask for anything.
class FrameCalls {
 public:
  FrameCalls() = default;
  FrameCalls(const FrameCalls&) = delete;
  FrameCalls& operator=(const FrameCalls&) = delete;
  virtual ~FrameCalls() = default;

  virtual void begin(const VitrailRect& area) = 0; // of the next frame; an extent of 0: everything
  virtual void draw(std::span<const Point> points) = 0;
  virtual void collected() = 0;
  virtual void copyLists(const CopyAttempt& attempt) = 0;
  virtual void resolve(std::optional<std::uint32_t> view) = 0; // default: the one whose picture is looked at
  virtual void end() = 0;
  virtual void resize() = 0; // to the size that the target has
};

struct CallsResult {
  std::vector<FloatColor> pixels;
  std::optional<VitrailStats> stats; // of the frame that was begun last, where there are any
  bool copied = false;               // something was written to the buffer of copyLists()
};

// How a host reads lists: the library copies them out, or a shader of the host's walks them (vitrail/list.glsl).
enum class ReadBy { Copy, Shader };

struct ListsRead {
  PointResult frame;
  // Of every pixel of the area, row by row, front to back; nothing where a list was left out.
  std::vector<std::optional<std::vector<VitrailLayer>>> pixels;
  std::uint32_t layers = 0; // that the pixels have; by Copy only
};

class PointHost {
 public:
  // What the words before and behind the library's memory hold, as long as nobody writes there.
  static constexpr std::uint32_t kGuard = 0xa5000023U; // as a node, of pixel 35
  static constexpr std::uint32_t kGuardWords = 1024;

  static constexpr std::uint32_t kFramesTogether = 2;

  PointHost() = default;
  PointHost(const PointHost&) = delete;
  PointHost& operator=(const PointHost&) = delete;
  virtual ~PointHost() = default;

  // Draws the points as one frame and waits for it. The first frame of a host is frame 0.
  PointResult draw(std::span<const Point> points) { return drawTogether({{points.begin(), points.end()}})[0]; }

  // Draws frames, all submitted at once, so that nothing but the library's own barriers keeps them apart. At most
  // kFramesTogether of them.
  virtual std::vector<PointResult> drawTogether(const std::vector<std::vector<Point>>& frames) = 0;

  // Records a frame, gives the target another size, records a second frame, and submits both at once. With a capacity
  // the pool has that from then on.
  virtual std::array<PointResult, 2> drawAcrossResize(std::span<const Point> first, Extent extent,
                                                      std::span<const Point> second, std::uint32_t capacity = 0) = 0;

  // Draws the opaque scene once and the points over it, area by area, each a frame of its own, as `next` gives them; it
  // is told what became of the last one. Every area draws all points. The result's statistics are the last area's.
  using NextArea = std::function<bool(const VitrailStats* last, VitrailRect& area)>;
  virtual PointResult drawAreas(std::span<const Point> points, const NextArea& next) = 0;

  // As draw(), but between collecting and resolving every node moves to another place of the pool (scatterNodes()):
  // devices that run many fragments at once hand nodes out in any order, others along each list.
  virtual PointResult drawScattered(std::span<const Point> points) = 0;

  // As draw(), and reads the lists of an area, before the resolve or after it. By Shader up to kMostWalked a pixel.
  static constexpr std::uint32_t kMostWalked = 128;
  virtual ListsRead drawAndRead(std::span<const Point> points, const VitrailRect& area, ReadBy by,
                                bool afterResolve) = 0;

  // Draws the opaque scene, makes the calls that `make` makes, and waits for them.
  virtual CallsResult drawCalls(const std::function<void(FrameCalls&)>& make) = 0;

  // Records a frame and never submits it, as hosts do whose swapchain is out of date.
  virtual void drop(std::span<const Point> points) = 0;

  // Whether every guard word is as it was.
  [[nodiscard]] virtual bool guardsUntouched() = 0;

  // A part of the library's memory, as the last frame left it. `guarded` only.
  [[nodiscard]] virtual std::vector<std::uint32_t> words(StoragePart StorageLayout::*part) = 0;

  [[nodiscard]] virtual VitrailMemory memory() const = 0;
  [[nodiscard]] virtual std::uint64_t newestFrame() const = 0; // that the library knows of

  // Of a frame that has finished; nothing where they cannot be had any more, or yet.
  [[nodiscard]] virtual std::optional<VitrailStats> stats(std::uint64_t frame) const = 0;
};

// Where everything lies in the memory of such a host's target.
StorageLayout layoutOf(const HostDesc& desc, std::uint64_t alignment);

// Moves every node of a frame that has been collected to another place of its pool, in a copy of the target's memory.
// For `standard` nodes at one sample.
void scatterNodes(const HostDesc& desc, const StorageLayout& storage, std::span<std::byte> memory);

} // namespace vitrail::tests
