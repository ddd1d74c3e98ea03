// Descriptors that are not as vitrail/cpu.h describes them: an error, one line that names the field, and nothing drawn.
#include <algorithm>
#include <cmath>
#include <string>

#include "host.h"

namespace vitrail::tests::raster {
namespace {

struct Described {
  std::vector<Position> positions{{-1.0F, -1.0F, 0.5F, 1.0F}, {1.0F, -1.0F, 0.5F, 1.0F}, {-1.0F, 1.0F, 0.5F, 1.0F}};
  std::vector<std::uint32_t> indices{0, 1, 2};
  std::vector<float> planes = std::vector<float>(40, 1.0F);
  Picture picture{8, 8};
  VitrailCpuFrame frame = picture.frame();
  VitrailCpuDraw draw = drawOf(positions);
};

void noShade(void* /*user*/, VitrailCpuFragments* /*fragments*/) {}

struct Mistake {
  const char* field; // that the line names
  void (*make)(Described& d);
};

const Mistake kMistakes[] = {
    {"next", [](Described& d) { d.frame.next = &d; }},
    {"width", [](Described& d) { d.frame.width = 0; }},
    {"height", [](Described& d) { d.frame.height = 0; }},
    {"wider", [](Described& d) { d.frame.width = VITRAIL_CPU_MAX_SIDE + 1; }},
    {"higher", [](Described& d) { d.frame.height = VITRAIL_CPU_MAX_SIDE + 1; }},
    {"picture is wider", [](Described& d) { d.frame.pictureWidth = VITRAIL_CPU_MAX_SIDE + 1; }},
    {"picture is wider or higher", [](Described& d) { d.frame.pictureHeight = ~0U; }},
    {"originX", [](Described& d) { d.frame.originX = 1; }},
    {"originY", [](Described& d) { d.frame.originY = ~0U; }},
    {"pictureWidth", [](Described& d) { d.frame.pictureWidth = 7; }},
    {"pictureHeight", [](Described& d) { d.frame.pictureHeight = 7; }},
    {"samples", [](Described& d) { d.frame.samples = 3; }},
    {"samples", [](Described& d) { d.frame.samples = 16; }},
    {"clipSpace", [](Described& d) { d.frame.clipSpace = static_cast<VitrailCpuClipSpace>(3); }},
    {"clipSpace", [](Described& d) { d.frame.clipSpace = VITRAIL_CPU_CLIP_SPACE_MAX_ENUM; }},
    {"depthOrder", [](Described& d) { d.frame.depthOrder = static_cast<VitrailDepthOrder>(2); }},
    {"colorFormat", [](Described& d) { d.frame.colorFormat = static_cast<VitrailCpuColorFormat>(2); }},
    {"color is null", [](Described& d) { d.frame.color = nullptr; }},
    {"colorStride", [](Described& d) { d.frame.colorStride = 124; }},
    {"colorStride", [](Described& d) { d.frame.colorStride = 130; }},
    {"depthStride", [](Described& d) { d.frame.depthStride = 28; }},
    {"depthStride", [](Described& d) { d.frame.depthStride = 34; }},
    {"sampleColors", [](Described& d) { d.frame.sampleColors = d.picture.pixels.data(); }},
    {"clear and sampleColors",
     [](Described& d) {
       d.frame.samples = 2;
       d.frame.clear = d.frame.sampleColors = d.picture.pixels.data();
     }},
    {"memoryBudget", [](Described& d) { d.frame.memoryBudget = 65535; }},
    {"brightest", [](Described& d) { d.frame.brightest = -1.0F; }},
    {"brightest", [](Described& d) { d.frame.brightest = NAN; }},
    {"draw 0: next", [](Described& d) { d.draw.next = &d; }},
    {"draw 0: surface", [](Described& d) { d.draw.surface = static_cast<VitrailCpuSurface>(2); }},
    {"draw 0: topology", [](Described& d) { d.draw.topology = static_cast<VitrailCpuTopology>(3); }},
    {"draw 0: cull", [](Described& d) { d.draw.cull = static_cast<VitrailCpuCull>(3); }},
    {"draw 0: blend", [](Described& d) { d.draw.blend = static_cast<VitrailBlend>(4); }},
    {"draw 0: positions", [](Described& d) { d.draw.positions = nullptr; }},
    {"draw 0: components", [](Described& d) { d.draw.components = 2; }},
    {"draw 0: components", [](Described& d) { d.draw.components = 5; }},
    {"draw 0: vertexStride", [](Described& d) { d.draw.vertexStride = 15; }},
    {"clip planes",
     [](Described& d) {
       d.draw.clipPlanes = d.planes.data();
       d.draw.clipPlaneCount = VITRAIL_CPU_MAX_CLIP_PLANES + 1;
     }},
    {"clipPlanes", [](Described& d) { d.draw.clipPlaneCount = 1; }},
    {"pointSize", [](Described& d) { d.draw.pointSize = -1.0F; }},
    {"pointSize", [](Described& d) { d.draw.pointSize = 2049.0F; }},
    {"pointSize", [](Described& d) { d.draw.pointSize = NAN; }},
    {"indices is null", [](Described& d) { d.draw.indexCount = 3; }},
    {"index",
     [](Described& d) {
       d.indices[1] = 3;
       d.draw.indices = d.indices.data();
       d.draw.indexCount = 3;
     }},
    {"number of indices",
     [](Described& d) {
       d.draw.indices = d.indices.data();
       d.draw.indexCount = 2;
     }},
    {"number of indices, or of vertices", [](Described& d) { d.draw.vertexCount = 2; }},
    {"number of indices, or of vertices", [](Described& d) { d.draw.topology = VITRAIL_CPU_LINES; }},
    {"shadeFlags",
     [](Described& d) {
       d.draw.shade = noShade;
       d.draw.shadeFlags = 8;
     }},
    {"shadeFlags without", [](Described& d) { d.draw.shadeFlags = VITRAIL_CPU_SHADE_DISCARD; }},
    {"SHADE_FILTER",
     [](Described& d) {
       d.draw.shade = noShade;
       d.draw.shadeFlags = VITRAIL_CPU_SHADE_FILTER;
     }},
    {"SHADE_FILTER",
     [](Described& d) {
       d.draw.shade = noShade;
       d.draw.shadeFlags = VITRAIL_CPU_SHADE_FILTER;
       d.draw.blend = VITRAIL_BLEND_PREMULTIPLIED;
       d.draw.surface = VITRAIL_CPU_OPAQUE;
     }},
    {"draw 0: brightest", [](Described& d) { d.draw.brightest = -0.5F; }},
    {"draw 0: brightest", [](Described& d) { d.draw.brightest = NAN; }},
    {"draw 0: leastAlpha",
     [](Described& d) {
       d.draw.shade = noShade;
       d.draw.leastAlpha = 1.5F;
     }},
    {"draw 0: leastAlpha",
     [](Described& d) {
       d.draw.shade = noShade;
       d.draw.leastAlpha = NAN;
     }},
    {"draw 0: leastAlpha",
     [](Described& d) {
       d.draw.shade = noShade;
       d.draw.leastAlpha = 0.5F;
       d.draw.shadeFlags = VITRAIL_CPU_SHADE_DISCARD;
     }},
    {"draw 0: color", [](Described& d) { d.draw.color[2] = NAN; }},
};

TEST(RefusedTest, FramesAndDraws) {
  for (const Mistake& mistake : kMistakes) {
    Raster raster(VITRAIL_CPU_BEST);
    Described described;
    std::fill_n(described.draw.color, 4, 1.0F);
    mistake.make(described);
    VitrailStats stats{};
    stats.complete = 1;
    EXPECT_EQ(raster.render(described.frame, {&described.draw, 1}, &stats), VITRAIL_ERROR_INVALID) << mistake.field;
    const std::vector<std::string> lines = raster.takeLog();
    ASSERT_EQ(lines.size(), 1U) << mistake.field;
    EXPECT_NE(lines[0].find(mistake.field), std::string::npos) << lines[0] << " does not name " << mistake.field;
    EXPECT_EQ(stats.complete, 0U) << mistake.field;
    EXPECT_EQ(described.picture.pixels, Picture(8, 8).pixels) << mistake.field;
  }
}

TEST(RefusedTest, TheSecondDrawByItsNumber) {
  Raster raster(VITRAIL_CPU_BEST);
  Described described;
  std::vector<VitrailCpuDraw> draws(2, described.draw);
  draws[1].components = 7;
  EXPECT_EQ(raster.render(described.frame, draws), VITRAIL_ERROR_INVALID);
  EXPECT_EQ(raster.takeLog(), std::vector<std::string>{"draw 1: components is neither 3 nor 4"});
}

// Indices that the draw before it has, too, are looked at once, but each draw has vertices of its own.
TEST(RefusedTest, IndicesOfFewerVerticesThanTheDrawBefore) {
  static constexpr std::uint32_t kIndices[3] = {0, 1, 2};
  Raster raster(VITRAIL_CPU_BEST);
  Described described;
  std::vector<float> positions(12, 0.5F);
  described.draw.positions = positions.data();
  described.draw.vertexCount = 3;
  described.draw.indices = kIndices;
  described.draw.indexCount = 3;
  std::vector<VitrailCpuDraw> draws(2, described.draw);
  EXPECT_EQ(raster.render(described.frame, draws), VITRAIL_SUCCESS);
  draws[1].vertexCount = 2;
  EXPECT_EQ(raster.render(described.frame, draws), VITRAIL_ERROR_INVALID);
  EXPECT_EQ(raster.takeLog(), std::vector<std::string>{"draw 1: an index is not below vertexCount"});
}

TEST(RefusedTest, NullArguments) {
  Raster raster(VITRAIL_CPU_BEST);
  Described d;
  EXPECT_EQ(vitrailCpuRender(nullptr, &d.frame, &d.draw, 1, nullptr), VITRAIL_ERROR_INVALID);
  EXPECT_EQ(vitrailCpuRender(raster.get(), nullptr, &d.draw, 1, nullptr), VITRAIL_ERROR_INVALID);
  EXPECT_EQ(vitrailCpuRender(raster.get(), &d.frame, nullptr, 1, nullptr), VITRAIL_ERROR_INVALID);
  EXPECT_EQ(raster.takeLog(), (std::vector<std::string>{"frame is null", "draws is null"}));
  EXPECT_EQ(vitrailCpuRender(raster.get(), &d.frame, nullptr, 0, nullptr), VITRAIL_SUCCESS);
  EXPECT_EQ(vitrailCpuCreateContext(nullptr, nullptr), VITRAIL_ERROR_INVALID);
  vitrailCpuDestroyContext(nullptr);
  EXPECT_EQ(vitrailCpuContextThreads(nullptr), 0U);
  EXPECT_EQ(vitrailCpuContextInstructions(nullptr), VITRAIL_CPU_BEST);
}

void noParallel(void* /*user*/, std::uint32_t /*count*/, void (*)(void*, std::uint32_t), void* /*data*/) {}

TEST(RefusedTest, Contexts) {
  struct ContextMistake {
    const char* field;
    VitrailResult result;
    void (*make)(VitrailCpuContextDesc& desc);
  };
  const ContextMistake mistakes[] = {
    {"next", VITRAIL_ERROR_INVALID, [](VitrailCpuContextDesc& desc) { desc.next = &desc; }},
    {"threads", VITRAIL_ERROR_INVALID, [](VitrailCpuContextDesc& desc) { desc.threads = 1025; }},
    {"threads", VITRAIL_ERROR_INVALID, [](VitrailCpuContextDesc& desc) { desc.parallel = noParallel; }},
    {"instructions", VITRAIL_ERROR_INVALID,
     [](VitrailCpuContextDesc& desc) { desc.instructions = static_cast<VitrailCpuInstructions>(6); }},
    {"instructions", VITRAIL_ERROR_INVALID,
     [](VitrailCpuContextDesc& desc) { desc.instructions = VITRAIL_CPU_INSTRUCTIONS_MAX_ENUM; }},
#if defined(__x86_64__)
    {"NEON", VITRAIL_ERROR_UNSUPPORTED, [](VitrailCpuContextDesc& desc) { desc.instructions = VITRAIL_CPU_NEON; }},
#endif
  };
  for (const ContextMistake& mistake : mistakes) {
    std::vector<std::string> lines;
    VitrailCpuContextDesc desc{};
    desc.log = [](VitrailLogSeverity, const char* text, void* user) {
      static_cast<std::vector<std::string>*>(user)->emplace_back(text);
    };
    desc.logUser = &lines;
    mistake.make(desc);
    int dummy = 0;
    auto context = reinterpret_cast<VitrailCpuContext>(&dummy);
    EXPECT_EQ(vitrailCpuCreateContext(&desc, &context), mistake.result) << mistake.field;
    EXPECT_EQ(context, nullptr) << mistake.field;
    ASSERT_EQ(lines.size(), 1U) << mistake.field;
    EXPECT_NE(lines[0].find(mistake.field), std::string::npos) << lines[0];
  }
}

// Every set that a context is made with is the one it says.
TEST(ContextTest, SaysWhatItUses) {
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions, 3);
    EXPECT_EQ(vitrailCpuContextInstructions(raster.get()), instructions);
    EXPECT_EQ(vitrailCpuContextThreads(raster.get()), 3U);
  }
  Raster best(VITRAIL_CPU_BEST);
  EXPECT_EQ(vitrailCpuContextInstructions(best.get()), instructionsHere().front());
  VitrailCpuContext context = nullptr;
  ASSERT_EQ(vitrailCpuCreateContext(nullptr, &context), VITRAIL_SUCCESS);
  EXPECT_GE(vitrailCpuContextThreads(context), 1U);
  vitrailCpuDestroyContext(context);
}

} // namespace
} // namespace vitrail::tests::raster
