// Draws frames that libFuzzer makes up with the rasteriser for CPUs: descriptors with any values, vertices that are not
// finite, shade functions that give back anything. Arrays are as large as the descriptors say; everything else is free.
// A frame is either refused with a line in the log, or drawn: then shade functions and list hooks get what
// vitrail/cpu.h promises, and the picture is finite.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include <vitrail/cpu.h>

namespace {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "the rasteriser breaks its promise: %s\n", what);
  std::abort();
}

// The bytes of an input, and zeros after them.
class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> data) : data_(data) {}

  bool isEmpty() const { return at_ >= data_.size(); }
  std::uint8_t byte() { return isEmpty() ? 0 : data_[at_++]; }
  std::uint32_t below(std::uint32_t count) { return byte() % count; }
  bool oneIn(std::uint32_t count) { return below(count) == count - 1; }
  std::uint32_t word() {
    std::uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits = bits << 8U | byte();
    return bits;
  }
  // Mostly numbers of the size of clip space; else a hard one, or any bits.
  float number() {
    using Limits = std::numeric_limits<float>;
    constexpr std::array kHard = {0.0F,
                                  -0.0F,
                                  1.0F,
                                  -1.0F,
                                  Limits::infinity(),
                                  -Limits::infinity(),
                                  Limits::quiet_NaN(),
                                  Limits::max(),
                                  Limits::min(),
                                  Limits::denorm_min(),
                                  1e-30F,
                                  1e30F,
                                  32767.0F,
                                  0.5F};
    const std::uint8_t kind = byte();
    if (kind < 200) return static_cast<float>(kind) / 50.0F - 2.0F + static_cast<float>(byte()) / 12800.0F;
    if (kind < 240) return kHard.at(byte() % kHard.size());
    const std::uint32_t bits = word();
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }
  // A small number that is one of an enumeration's, or just not.
  template <class Enum>
  Enum choice(std::uint32_t count) {
    return static_cast<Enum>(below(16) == 15 ? below(8) : below(count));
  }

 private:
  std::span<const std::uint8_t> data_;
  std::size_t at_ = 0;
};

struct Shading {
  const VitrailCpuFrame* frame = nullptr;
  std::uint32_t primitives = 0;
  std::uint32_t flags = 0;
  std::array<float, 32> values{};
  std::uint32_t discarded = 0;
};

void shade(void* user, VitrailCpuFragments* f) {
  const Shading& shading = *static_cast<Shading*>(user);
  require(f->mask != 0 && (f->mask & ~0xffffU) == 0, "a fragment at least, sixteen at most");
  require(f->discarded == 0, "nothing is discarded beforehand");
  require((f->x - shading.frame->originX) % 4 == 0 && f->x - shading.frame->originX < shading.frame->width, "x");
  require((f->y - shading.frame->originY) % 4 == 0 && f->y - shading.frame->originY < shading.frame->height, "y");
  for (std::size_t i = 0; i < VITRAIL_CPU_LANES; ++i) {
    require(f->triangle[i] < shading.primitives, "triangles of the draw");
    for (std::size_t c = 0; c < 4; ++c) f->color[c][i] = shading.values.at((f->triangle[i] + 4 * i + c) % 32);
    for (std::size_t c = 0; c < 3; ++c) f->filter[c][i] = shading.values.at((f->triangle[i] + 3 * i + c + 7) % 32);
    if ((f->mask >> i & 1U) == 0) continue;
    require(f->depth[i] >= 0.0F && f->depth[i] <= 1.0F, "depths from 0 to 1");
    require(f->x - shading.frame->originX + i % 4 < shading.frame->width, "pixels of the frame");
    require(f->y - shading.frame->originY + i / 4 < shading.frame->height, "pixels of the frame");
  }
  f->discarded = shading.discarded;
}

int list(void* user, std::uint32_t x, std::uint32_t y, const VitrailLayer* layers, std::uint32_t count, float* color) {
  const VitrailCpuFrame& frame = *static_cast<VitrailCpuFrame*>(user);
  require(count > 0, "pixels that have layers");
  require(x - frame.originX < frame.width && y - frame.originY < frame.height, "pixels of the frame");
  const bool nearestIsOne = frame.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
  for (std::uint32_t i = 1; i < count; ++i) {
    const float before = layers[i - 1].depth;
    require(nearestIsOne ? before >= layers[i].depth : before <= layers[i].depth, "nearest first");
  }
  if ((x + y) % 2 == 0) return 0;
  color[0] = 0.25F;
  return 1;
}

struct Draw {
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
  std::vector<float> planes;
  std::array<float, 16> transform{};
  std::array<float, 12> model{};
  Shading shading;
  VitrailCpuDraw desc{};
};

void makeVertices(Bytes& bytes, Draw& draw) {
  VitrailCpuDraw& desc = draw.desc;
  desc.components = bytes.oneIn(8) ? bytes.below(6) : 0;
  desc.vertexCount = 3 * bytes.below(16) + (bytes.oneIn(16) ? 1 : 0);
  const std::uint32_t components = desc.components == 3 ? 3 : 4;
  const std::uint32_t gap = bytes.oneIn(8) ? bytes.below(3) : 0;
  const std::uint32_t stride = components + gap;
  desc.vertexStride = gap == 0 ? 0 : stride * 4;
  draw.positions.resize(std::size_t{stride} * desc.vertexCount + 1);
  for (float& value : draw.positions) value = bytes.number();
  const bool isPlain = !bytes.oneIn(4); // w of 1, so that something is seen
  for (std::size_t v = 0; isPlain && components == 4 && v < desc.vertexCount; ++v)
    draw.positions[v * stride + 3] = 1.0F;
  desc.positions = bytes.oneIn(32) ? nullptr : draw.positions.data();
  if (bytes.oneIn(4)) {
    draw.indices.resize(3 * bytes.below(12));
    for (std::uint32_t& index : draw.indices)
      index = bytes.below(std::max(desc.vertexCount, 1U) + (bytes.oneIn(64) ? 1 : 0));
    desc.indices = draw.indices.data();
    desc.indexCount = static_cast<std::uint32_t>(draw.indices.size());
  }
  if (bytes.oneIn(4)) {
    for (float& value : draw.transform) value = bytes.number();
    desc.transform = draw.transform.data();
  }
  if (bytes.oneIn(4)) {
    for (float& value : draw.model) value = bytes.number();
    desc.model = draw.model.data();
  }
  if (bytes.oneIn(4)) {
    desc.clipPlaneCount = bytes.below(10);
    draw.planes.resize(std::size_t{4} * desc.clipPlaneCount + 1);
    for (float& value : draw.planes) value = bytes.number();
    desc.clipPlanes = draw.planes.data();
  }
}

void makeDraw(Bytes& bytes, const VitrailCpuFrame& frame, Draw& draw) {
  VitrailCpuDraw& desc = draw.desc;
  desc.surface = bytes.choice<VitrailCpuSurface>(2);
  desc.topology = bytes.oneIn(4) ? bytes.choice<VitrailCpuTopology>(3) : VITRAIL_CPU_TRIANGLES;
  desc.cull = bytes.oneIn(4) ? bytes.choice<VitrailCpuCull>(3) : VITRAIL_CPU_CULL_NONE;
  desc.blend = bytes.choice<VitrailBlend>(4);
  makeVertices(bytes, draw);
  desc.pointSize = bytes.oneIn(4) ? std::fabs(bytes.number()) * 8.0F : 0.0F;
  for (float& c : desc.color) c = bytes.oneIn(8) ? bytes.number() : static_cast<float>(bytes.byte()) / 255.0F;
  if (!bytes.oneIn(2)) return;
  desc.shade = shade;
  desc.shadeUser = &draw.shading;
  desc.shadeFlags = bytes.below(bytes.oneIn(16) ? 16 : 4);
  if (desc.blend == VITRAIL_BLEND_PREMULTIPLIED && desc.surface == VITRAIL_CPU_TRANSPARENT && bytes.oneIn(2)) {
    desc.shadeFlags |= VITRAIL_CPU_SHADE_FILTER;
  }
  if (bytes.oneIn(2)) desc.brightest = bytes.number();
  if (bytes.oneIn(4)) desc.leastAlpha = static_cast<float>(bytes.byte()) / 255.0F; // true or not
  const std::uint32_t corners = desc.topology == VITRAIL_CPU_POINTS ? 1 : desc.topology == VITRAIL_CPU_LINES ? 2 : 3;
  draw.shading.frame = &frame;
  draw.shading.primitives = (desc.indices != nullptr ? desc.indexCount : desc.vertexCount) / corners;
  for (float& value : draw.shading.values) value = bytes.oneIn(8) ? bytes.number() : bytes.number() * 0.25F + 0.5F;
  draw.shading.discarded = bytes.oneIn(2) ? bytes.word() & 0xffffU : 0;
}

struct Frame {
  std::vector<float> color;
  std::vector<float> depth;
  std::vector<float> sampleColors;
  VitrailCpuFrame desc{};
};

void makeFrame(Bytes& bytes, Frame& frame) {
  VitrailCpuFrame& desc = frame.desc;
  desc.width = bytes.below(80);
  desc.height = bytes.below(80);
  if (bytes.oneIn(4)) {
    desc.pictureWidth = bytes.oneIn(8) ? bytes.word() : 16 * bytes.byte();
    desc.pictureHeight = 16 * bytes.byte();
    desc.originX = bytes.byte();
    desc.originY = bytes.byte();
  }
  desc.samples = bytes.oneIn(16) ? bytes.byte() : bytes.oneIn(2) ? 1U << bytes.below(4) : 0;
  const std::uint32_t samples = desc.samples == 0 || desc.samples > 8 ? 1 : desc.samples;
  desc.clipSpace = bytes.choice<VitrailCpuClipSpace>(3);
  desc.depthOrder = bytes.choice<VitrailDepthOrder>(2);
  desc.colorFormat = bytes.choice<VitrailCpuColorFormat>(2);
  const std::size_t pixels = std::size_t{desc.width} * desc.height;
  frame.color.assign(pixels * 4 + 1, 0.5F);
  desc.color = bytes.oneIn(64) ? nullptr : frame.color.data();
  if (bytes.oneIn(32)) desc.colorStride = bytes.byte();
  if (desc.colorStride > desc.width * 4) desc.colorStride = 0;
  if (bytes.oneIn(3)) {
    frame.depth.assign(pixels * samples + 1, bytes.oneIn(4) ? bytes.number() : 1.0F);
    desc.depth = frame.depth.data();
  }
  if (bytes.oneIn(4)) {
    frame.sampleColors.assign(pixels * samples * 4 + 1, 0.75F);
    desc.sampleColors = frame.sampleColors.data();
  }
  if (bytes.oneIn(4)) desc.brightest = bytes.number();
  if (bytes.oneIn(4)) {
    desc.list = list;
    desc.listUser = &desc;
  }
  static constexpr float kClear[4] = {0.5F, 0.25F, 0.125F, 0.75F};
  if (bytes.oneIn(4)) desc.clear = kClear;
  desc.memoryBudget = bytes.oneIn(2) ? 65536 : bytes.oneIn(16) ? bytes.word() % (1U << 24U) : 0;
}

// Contexts are kept, as hosts keep them: one for each set of instructions that there is.
struct Contexts {
  std::vector<VitrailCpuContext> all;
  std::size_t lines = 0;

  Contexts() {
    for (int instructions = VITRAIL_CPU_SSE4; instructions <= VITRAIL_CPU_BASELINE; ++instructions) {
      VitrailCpuContextDesc desc{};
      desc.threads = 1;
      desc.instructions = static_cast<VitrailCpuInstructions>(instructions);
      desc.log = [](VitrailLogSeverity, const char* text, void* user) {
        require(std::strlen(text) > 0 && std::strchr(text, '\n') == nullptr, "messages of one line");
        ++static_cast<Contexts*>(user)->lines;
      };
      desc.logUser = this;
      VitrailCpuContext context = nullptr;
      if (vitrailCpuCreateContext(&desc, &context) == VITRAIL_SUCCESS) all.push_back(context);
    }
  }
  Contexts(const Contexts&) = delete;
  Contexts& operator=(const Contexts&) = delete;
  ~Contexts() {
    for (const VitrailCpuContext context : all) vitrailCpuDestroyContext(context);
  }
};

void drawFrame(Bytes& bytes, Contexts& contexts) {
  const VitrailCpuContext context = contexts.all[bytes.below(static_cast<std::uint32_t>(contexts.all.size()))];
  Frame frame;
  makeFrame(bytes, frame);
  std::vector<Draw> draws(bytes.below(6));
  std::vector<VitrailCpuDraw> descs;
  for (Draw& draw : draws) {
    makeDraw(bytes, frame.desc, draw);
    descs.push_back(draw.desc);
  }
  contexts.lines = 0;
  VitrailStats stats{};
  const bool counts = bytes.below(2) == 0;
  const VitrailResult result = vitrailCpuRender(context, &frame.desc, descs.data(),
                                                static_cast<std::uint32_t>(descs.size()), counts ? &stats : nullptr);
  if (result != VITRAIL_SUCCESS) {
    require(contexts.lines == 1, "a line for each error");
    return;
  }
  require(contexts.lines == 0, "no line without an error");
  require(!counts || stats.complete == 1, "complete frames");
  require(stats.fragmentsMissing == 0, "complete frames");
  if (frame.desc.colorFormat == VITRAIL_CPU_RGBA32F) {
    for (const float value : frame.color) require(std::isfinite(value), "finite pictures");
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Contexts contexts;
  Bytes bytes({data, size});
  for (int frames = 0; frames < 3 && !bytes.isEmpty(); ++frames) drawFrame(bytes, contexts);
  return 0;
}
