#include "raster/cpu/frame_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vitrail::raster {

namespace {

constexpr float kBrightest = 65504.0F;
constexpr std::uint64_t kLeastBudget = 65536;
static_assert(kLeastBudget >= kLeastOfThread);
constexpr std::uint64_t kBudget = std::uint64_t{256} << 20U; // only what deep tiles need of it is ever touched
constexpr std::uint64_t kBudgetOfThread = std::uint64_t{4} << 20U;
// What is behind less light than this, for colours up to 1, changes the sRGB picture by at most kLeftOut of 1/255: the
// curve rises by at most 12.92.
constexpr float kLeastTransmittance = kLeftOut / 255.0F / 12.92F;

std::uint32_t cornersOf(VitrailCpuTopology topology) {
  return topology == VITRAIL_CPU_POINTS ? 1 : topology == VITRAIL_CPU_LINES ? 2 : 3;
}

VitrailResult invalid(const Log& log, const char* what) { return log.fail(VITRAIL_ERROR_INVALID, "%s", what); }

VitrailResult invalidDraw(const Log& log, std::uint32_t draw, const char* what) {
  return log.fail(VITRAIL_ERROR_INVALID, "draw %u: %s", draw, what);
}

template <class Enum>
bool isOneOf(Enum value, Enum last) {
  return value >= Enum{} && value <= last;
}

const char* whatIsWrongWithShading(const VitrailCpuDraw& draw) {
  constexpr std::uint32_t kBits = VITRAIL_CPU_SHADE_DERIVATIVES | VITRAIL_CPU_SHADE_DISCARD | VITRAIL_CPU_SHADE_FILTER;
  if ((draw.shadeFlags & ~kBits) != 0) return "shadeFlags has a bit that VitrailCpuShadeBits has not";
  if (draw.shade == nullptr && draw.shadeFlags != 0) return "shadeFlags without a shade function";
  const bool filters = (draw.shadeFlags & VITRAIL_CPU_SHADE_FILTER) != 0;
  if (filters && (draw.surface != VITRAIL_CPU_TRANSPARENT || draw.blend != VITRAIL_BLEND_PREMULTIPLIED)) {
    return "VITRAIL_CPU_SHADE_FILTER is for transparent draws with VITRAIL_BLEND_PREMULTIPLIED";
  }
  if (!(draw.brightest >= 0.0F)) return "brightest is negative or not a number";
  if (!(draw.leastAlpha >= 0.0F && draw.leastAlpha <= 1.0F)) return "leastAlpha is not between 0 and 1";
  if (draw.leastAlpha > 0.0F && (draw.shadeFlags & VITRAIL_CPU_SHADE_DISCARD) != 0) {
    return "leastAlpha is not 0, but VITRAIL_CPU_SHADE_DISCARD says that fragments may hide nothing";
  }
  if (draw.shade != nullptr) return nullptr;
  for (const float c : draw.color) {
    if (std::isnan(c)) return "color has a component that is not a number";
  }
  return nullptr;
}

const char* whatIsWrongWithVertices(const VitrailCpuDraw& draw) {
  if (draw.positions == nullptr && draw.vertexCount > 0) return "positions is null";
  if (draw.components != 0 && draw.components != 3 && draw.components != 4) return "components is neither 3 nor 4";
  const std::uint32_t components = draw.components == 0 ? 4 : draw.components;
  if (draw.vertexStride != 0 && draw.vertexStride < components * sizeof(float)) {
    return "vertexStride is smaller than a vertex";
  }
  if (draw.clipPlaneCount > VITRAIL_CPU_MAX_CLIP_PLANES) return "more than VITRAIL_CPU_MAX_CLIP_PLANES clip planes";
  if (draw.clipPlaneCount > 0 && draw.clipPlanes == nullptr) return "clipPlanes is null";
  if (!(draw.pointSize >= 0.0F) || draw.pointSize > VITRAIL_CPU_MAX_POINT_SIZE) {
    return "pointSize is not between 0 and VITRAIL_CPU_MAX_POINT_SIZE (2048)";
  }
  if (draw.indices == nullptr && draw.indexCount > 0) return "indices is null";
  const std::uint32_t count = draw.indices == nullptr ? draw.vertexCount : draw.indexCount;
  if (count % cornersOf(draw.topology) != 0)
    return "the number of indices, or of vertices, is no multiple of the topology's";
  return nullptr;
}

const char* whatIsWrongWith(const VitrailCpuDraw& draw) {
  if (draw.next != nullptr) return "next is not null";
  if (!isOneOf(draw.surface, VITRAIL_CPU_OPAQUE)) return "surface is none of VitrailCpuSurface";
  if (!isOneOf(draw.topology, VITRAIL_CPU_POINTS)) return "topology is none of VitrailCpuTopology";
  if (!isOneOf(draw.cull, VITRAIL_CPU_CULL_FRONT)) return "cull is none of VitrailCpuCull";
  if (!isOneOf(draw.blend, VITRAIL_BLEND_MULTIPLY)) return "blend is none of VitrailBlend";
  const char* wrong = whatIsWrongWithVertices(draw);
  return wrong != nullptr ? wrong : whatIsWrongWithShading(draw);
}

const char* whatIsWrongWith(const VitrailCpuFrame& frame) {
  if (frame.next != nullptr) return "the frame's next is not null";
  if (frame.width == 0 || frame.height == 0) return "the frame's width or height is 0";
  if (frame.width > VITRAIL_CPU_MAX_SIDE || frame.height > VITRAIL_CPU_MAX_SIDE) {
    return "the frame is wider or higher than VITRAIL_CPU_MAX_SIDE (32768 pixels): draw it in parts";
  }
  const std::uint32_t pictureWidth = frame.pictureWidth == 0 ? frame.width : frame.pictureWidth;
  const std::uint32_t pictureHeight = frame.pictureHeight == 0 ? frame.height : frame.pictureHeight;
  if (pictureWidth > VITRAIL_CPU_MAX_SIDE || pictureHeight > VITRAIL_CPU_MAX_SIDE) {
    return "the picture is wider or higher than VITRAIL_CPU_MAX_SIDE (32768 pixels)";
  }
  if (frame.originX > pictureWidth || frame.width > pictureWidth - frame.originX || frame.originY > pictureHeight ||
      frame.height > pictureHeight - frame.originY) {
    return "the frame reaches out of its picture (originX, originY, pictureWidth, pictureHeight)";
  }
  const std::uint32_t samples = frame.samples;
  if (samples != 0 && samples != 1 && samples != 2 && samples != 4 && samples != 8)
    return "samples is not 1, 2, 4 or 8";
  if (!isOneOf(frame.clipSpace, VITRAIL_CPU_CLIP_OPENGL)) return "clipSpace is none of VitrailCpuClipSpace";
  if (!isOneOf(frame.depthOrder, VITRAIL_DEPTH_NEAREST_IS_ONE)) return "depthOrder is none of VitrailDepthOrder";
  if (!isOneOf(frame.colorFormat, VITRAIL_CPU_RGBA8_SRGB)) return "colorFormat is none of VitrailCpuColorFormat";
  if (frame.color == nullptr) return "color is null";
  const std::uint32_t pixel = frame.colorFormat == VITRAIL_CPU_RGBA32F ? 16 : 4;
  if (frame.colorStride != 0 && frame.colorStride < frame.width * pixel) return "colorStride is smaller than a row";
  if (frame.colorStride % (pixel == 16 ? sizeof(float) : 1) != 0) return "colorStride is no multiple of a float";
  const std::uint32_t sampleCount = samples == 0 ? 1 : samples;
  if (frame.depthStride != 0 && frame.depthStride < std::uint64_t{frame.width} * sampleCount * sizeof(float)) {
    return "depthStride is smaller than a row";
  }
  if (frame.depthStride % sizeof(float) != 0) return "depthStride is no multiple of a float";
  if (frame.sampleColors != nullptr && sampleCount == 1) return "sampleColors is for several samples";
  if (frame.sampleColors != nullptr && frame.clear != nullptr) {
    return "clear and sampleColors both say what is behind all draws: leave one out";
  }
  if (frame.memoryBudget != 0 && frame.memoryBudget < kLeastBudget) return "memoryBudget is below 65536 bytes";
  if (!(frame.brightest >= 0.0F)) return "the frame's brightest is negative or not a number";
  return nullptr;
}

// The largest index of draws, of those that follow each other with the same ones once: a frame may draw a mesh many
// times.
class LargestIndex {
 public:
  std::uint32_t of(const VitrailCpuDraw& draw) {
    if (draw.indices == indices_ && draw.indexCount == count_) return largest_;
    indices_ = draw.indices;
    count_ = draw.indexCount;
    std::uint32_t largest = 0; // no member, which the compiler would take for one of the indices and store each time
    for (std::uint32_t i = 0; i < draw.indexCount; ++i) largest = std::max(largest, draw.indices[i]);
    return largest_ = largest;
  }

 private:
  const std::uint32_t* indices_ = nullptr;
  std::uint32_t count_ = 0;
  std::uint32_t largest_ = 0;
};

bool hasIndicesOutside(const VitrailCpuDraw& draw, LargestIndex& largest) {
  return draw.indices != nullptr && draw.indexCount > 0 && largest.of(draw) >= draw.vertexCount;
}

void setDefaults(VitrailCpuFrame& info) {
  const auto orElse = [](auto& value, auto fallback) {
    if (value == 0) value = fallback;
  };
  orElse(info.samples, 1U);
  orElse(info.pictureWidth, info.width);
  orElse(info.pictureHeight, info.height);
  orElse(info.colorStride, info.width * (info.colorFormat == VITRAIL_CPU_RGBA32F ? 16U : 4U));
  orElse(info.depthStride, static_cast<std::uint32_t>(info.width * info.samples * sizeof(float)));
  orElse(info.brightest, 1.0F);
}

void setDefaults(VitrailCpuDraw& draw) {
  if (draw.components == 0) draw.components = 4;
  if (draw.vertexStride == 0) draw.vertexStride = draw.components * static_cast<std::uint32_t>(sizeof(float));
  if (draw.pointSize == 0.0F) draw.pointSize = 1.0F;
  if (draw.topology != VITRAIL_CPU_TRIANGLES) draw.cull = VITRAIL_CPU_CULL_NONE; // they have no sides
  const auto clamp = [](float v, float most) { return v > 0.0F ? std::min(v, most) : 0.0F; };
  for (std::size_t c = 0; c < 3; ++c) draw.color[c] = clamp(draw.color[c], kBrightest);
  draw.color[3] = clamp(draw.color[3], 1.0F);
  if (draw.shade != nullptr) {
    draw.brightest = draw.brightest == 0.0F ? kBrightest : std::min(draw.brightest, kBrightest);
    return;
  }
  draw.brightest = std::max({draw.color[0], draw.color[1], draw.color[2]});
  if (draw.surface == VITRAIL_CPU_TRANSPARENT && draw.blend == VITRAIL_BLEND_ADDITIVE) draw.brightest *= draw.color[3];
}

// The most light that any number of such surfaces, one behind the other, send together. What hides as much as it sends
// sends no more than the brightest colour; of others there is no bound.
float mostLightOf(const VitrailCpuDraw& draw) {
  if (draw.surface == VITRAIL_CPU_OPAQUE || draw.blend == VITRAIL_BLEND_OVER) return draw.brightest;
  if (draw.blend == VITRAIL_BLEND_MULTIPLY || draw.brightest == 0.0F) return 0.0F;
  const bool isKnown = draw.blend == VITRAIL_BLEND_PREMULTIPLIED && draw.shade == nullptr;
  return isKnown ? draw.brightest / draw.color[3] : std::numeric_limits<float>::infinity();
}

// Of a draw whose colour is known: whether it changes nothing.
bool isNothing(const VitrailCpuDraw& draw) {
  if (draw.shade != nullptr || draw.surface == VITRAIL_CPU_OPAQUE || draw.color[3] > 0.0F) return false;
  return draw.blend != VITRAIL_BLEND_PREMULTIPLIED || (draw.color[0] + draw.color[1] + draw.color[2] == 0.0F);
}

void addFlatPair(Frame& frame, const VitrailCpuDraw& draw) {
  const float a = draw.color[3];
  const bool isMultiplied = draw.blend == VITRAIL_BLEND_MULTIPLY;
  const bool isPremultiplied = draw.blend == VITRAIL_BLEND_PREMULTIPLIED;
  const bool hides = draw.blend == VITRAIL_BLEND_OVER || isPremultiplied;
  std::array<float, 4> pair{};
  std::array<float, 4> filter{};
  pair[3] = hides ? a : 0.0F;
  for (std::size_t c = 0; c < 3; ++c) {
    pair[c] = isMultiplied ? 0.0F : isPremultiplied ? draw.color[c] : draw.color[c] * a;
    filter[c] = isMultiplied ? 1.0F + a * (draw.color[c] - 1.0F) : 1.0F - pair[3];
  }
  frame.flatPairs.push_back(pair);
  frame.flatFilters.push_back(filter);
  const float hidden = hides && draw.shade != nullptr ? draw.leastAlpha : pair[3];
  frame.leastAlphas.push_back(hidden);
  frame.opticalDepths.push_back(hidden < 1.0F ? -std::log2(1.0F - hidden) : 24.0F);
}

void addNeeds(FrameNeeds& needs, const VitrailCpuDraw& draw) {
  const bool derivatives = (draw.shadeFlags & VITRAIL_CPU_SHADE_DERIVATIVES) != 0;
  if (draw.surface == VITRAIL_CPU_OPAQUE) {
    needs.opaque = true;
    needs.opaqueDerivatives = needs.opaqueDerivatives || derivatives;
    return;
  }
  needs.shaded = needs.shaded || draw.shade != nullptr;
  needs.derivatives = needs.derivatives || derivatives;
  needs.filters =
      needs.filters || draw.blend == VITRAIL_BLEND_MULTIPLY || (draw.shadeFlags & VITRAIL_CPU_SHADE_FILTER) != 0;
}

// Cuts a draw's vertices and primitives into what a thread works on at a time.
void addWork(Frame& frame, std::uint32_t draw, std::uint64_t& vertices) {
  DrawInfo& info = frame.draws[draw];
  info.firstVertex = vertices;
  info.firstJob = static_cast<std::uint32_t>(frame.jobs.size());
  if (info.primitives == 0) return;
  if (info.draw.topology == VITRAIL_CPU_TRIANGLES) {
    vertices += info.draw.vertexCount;
    for (std::uint64_t i = 0; i < info.draw.vertexCount; i += kVertexChunk) { // 64 bits: it passes the end
      const auto first = static_cast<std::uint32_t>(i);
      frame.vertexChunks.push_back({draw, first, std::min(kVertexChunk, info.draw.vertexCount - first)});
    }
  }
  for (std::uint64_t i = 0; i < info.primitives; i += kJobTriangles) {
    const auto first = static_cast<std::uint32_t>(i);
    frame.jobs.push_back({draw, first, std::min(kJobTriangles, info.primitives - first), 0});
  }
}

// Each of n fragments rounds what comes through by 2^-23 in either order. Where each hides 1/256 or more, 17,700 of
// them let through less than kNoTransmittance, and are off by 0.4 %. Where they hide less, there may be any number.
float trackedOf(const Frame& frame) {
  constexpr float kMuch = 1.0F / 256.0F;
  const bool isMuch = std::all_of(frame.leastAlphas.begin(), frame.leastAlphas.end(),
                                  [](float alpha) { return alpha == 0.0F || alpha >= kMuch; });
  return (isMuch ? 0.99F : 0.5F) * frame.leastTransmittance;
}

// Makes room for how near primitives come, where what is near may hide what is behind it, and that is known when it
// comes.
void addNearest(Frame& frame) {
  float depth = 0.0F; // of one layer of each job: a guess, as for each tile later
  std::uint64_t primitives = 0;
  for (Job& job : frame.jobs) {
    job.firstNearest = primitives;
    if (frame.draws[job.draw].draw.surface != VITRAIL_CPU_TRANSPARENT) continue;
    primitives += job.count;
    depth += frame.opticalDepths[job.draw];
  }
  // Not emptied first: that would fill all of it once more in each frame.
  const bool isNeeded = frame.mayTrackHidden() && depth > frame.opaqueDepth();
  frame.nearest.resize(isNeeded ? primitives : 0);
}

} // namespace

VitrailResult checkFrame(const Log& log, const VitrailCpuFrame* frame, const VitrailCpuDraw* draws,
                         std::uint32_t count) {
  if (frame == nullptr) return invalid(log, "frame is null");
  if (draws == nullptr && count > 0) return invalid(log, "draws is null");
  if (const char* wrong = whatIsWrongWith(*frame)) return invalid(log, wrong);
  std::uint64_t jobs = 0;
  LargestIndex largest;
  for (std::uint32_t i = 0; i < count; ++i) {
    const VitrailCpuDraw& draw = draws[i];
    if (const char* wrong = whatIsWrongWith(draw)) return invalidDraw(log, i, wrong);
    if (hasIndicesOutside(draw, largest)) return invalidDraw(log, i, "an index is not below vertexCount");
    const std::uint32_t corners = draw.indices == nullptr ? draw.vertexCount : draw.indexCount;
    jobs += (corners / cornersOf(draw.topology) + kJobTriangles - 1) / kJobTriangles;
  }
  if (jobs > kMaxJobs) {
    return log.fail(
        VITRAIL_ERROR_UNSUPPORTED,
        "the draws come in %llu parts, each of one draw and of up to %u triangles: a frame takes %u; put draws "
        "together",
        static_cast<unsigned long long>(jobs), kJobTriangles, kMaxJobs);
  }
  return VITRAIL_SUCCESS;
}

void prepareFrame(Frame& frame, const VitrailCpuFrame& info, std::span<const VitrailCpuDraw> draws,
                  std::uint32_t threads, bool counts) {
  frame.info = info;
  frame.counts = counts;
  setDefaults(frame.info);
  frame.viewport = {frame.info.pictureWidth,
                    frame.info.pictureHeight,
                    static_cast<std::int32_t>(info.originX),
                    static_cast<std::int32_t>(info.originY),
                    info.clipSpace != VITRAIL_CPU_CLIP_VULKAN,
                    info.clipSpace == VITRAIL_CPU_CLIP_OPENGL};
  frame.tilesX = (info.width + kTileSide - 1) / kTileSide;
  frame.tilesY = (info.height + kTileSide - 1) / kTileSide;
  const std::uint64_t budget =
      info.memoryBudget == 0 ? std::max(kBudget, kBudgetOfThread * threads) : info.memoryBudget;
  frame.tileThreads = static_cast<std::uint32_t>(std::min<std::uint64_t>(threads, budget / kLeastOfThread));
  frame.budget = budget / frame.tileThreads;

  frame.draws.clear();
  frame.jobs.clear();
  frame.vertexChunks.clear();
  frame.flatPairs.clear();
  frame.flatFilters.clear();
  frame.leastAlphas.clear();
  frame.opticalDepths.clear();
  frame.needs = {};
  frame.needs.shaded = frame.info.samples > 1 || info.list != nullptr;
  frame.needs.opaque = info.depth != nullptr;
  float brightest = std::max(1.0F, std::min(frame.info.brightest, std::numeric_limits<float>::max()));
  bool isBrightened = false; // filters make light brighter: what is behind too little of it may be seen after all
  std::uint64_t vertices = 0;
  for (std::uint32_t i = 0; i < draws.size(); ++i) {
    DrawInfo made;
    made.draw = draws[i];
    setDefaults(made.draw);
    const std::uint32_t corners = made.draw.indices == nullptr ? made.draw.vertexCount : made.draw.indexCount;
    made.primitives = isNothing(made.draw) ? 0 : corners / cornersOf(made.draw.topology);
    frame.draws.push_back(made);
    if (made.primitives > 0) {
      addNeeds(frame.needs, made.draw);
      const bool filters = made.draw.surface == VITRAIL_CPU_TRANSPARENT && made.draw.blend == VITRAIL_BLEND_MULTIPLY;
      isBrightened = isBrightened || (filters && made.draw.brightest > 1.0F);
      brightest = std::max(brightest, mostLightOf(made.draw));
    }
    addFlatPair(frame, made.draw);
    addWork(frame, i, vertices);
  }
  frame.flatPairs.push_back({0.0F, 0.0F, 0.0F, 0.0F});
  frame.flatFilters.push_back({1.0F, 1.0F, 1.0F, 0.0F});
  frame.leastTransmittance =
      info.list != nullptr || isBrightened ? 0.0F : std::max(kLeastTransmittance / brightest, kNoTransmittance);
  frame.trackedTransmittance = trackedOf(frame);
  frame.addsUp = std::isinf(brightest);
  frame.corners.resize(vertices);
  addNearest(frame);
}

} // namespace vitrail::raster
