#include "cpu_still.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <vitrail/cpu.h>

#include "../cpu/cpu_scene.h"
#include "../cpu/peel.h"
#include "../gpu/device.h"
#include "../image/encode.h"
#include "../image/large_array.h"
#include "../methods/methods.h"
#include "../scene/threads.h"
#include "attempts.h"
#include "rasterizer.h"

namespace vitrail::tool {

namespace {

constexpr std::uint64_t kBandPixels = std::uint64_t{16} << 20U; // drawn at once: 16 bytes each
constexpr std::size_t kRowsOfAThread = 32;                      // fewer are not worth one

// The most that the process has held at once.
std::uint64_t peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

// Adds up the time of each pass over all bands.
class PassClock {
 public:
  void end(const char* name) {
    const Clock::time_point now = Clock::now();
    const double milliseconds = std::chrono::duration<double, std::milli>(now - start_).count();
    start_ = now;
    const auto known = std::ranges::find(passes_, name, [](const auto& pass) { return pass.first; });
    if (known != passes_.end()) {
      known->second += milliseconds;
    } else {
      passes_.emplace_back(name, milliseconds);
    }
  }
  [[nodiscard]] const PassTimes& passes() const { return passes_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  PassTimes passes_;
};

// An encoded picture, made row by row.
class Encoded {
 public:
  explicit Encoded(const RenderOptions& picture) : picture_(picture) {
    const std::size_t count = std::size_t{picture.width} * picture.height * 4;
    picture.encoding == Encoding::Srgb8 ? shallow.resize(count) : deep.resize(count);
  }

  // Takes rows of linear light, from `firstRow` on.
  void set(std::uint32_t firstRow, std::uint32_t rows, const float* linear) {
    const std::size_t width = picture_.width;
    const std::size_t parts = partsFor(rows, kRowsOfAThread);
    inParts(parts, [&](std::size_t part) {
      const std::size_t first = rows * part / parts;
      const std::size_t count = (rows * (part + 1) / parts - first) * width;
      const std::size_t to = (firstRow + first) * width * 4;
      const float* from = linear + first * width * 4;
      shallow.empty() ? encodePixels(from, count, picture_.encoding, &deep[to])
                      : encodePixels(from, count, &shallow[to]);
    });
  }

  // Whether a row of linear light would be the same as one of the picture.
  [[nodiscard]] bool hasRow(std::uint32_t row, const float* linear) const {
    const std::size_t width = picture_.width;
    const auto at = static_cast<std::ptrdiff_t>(row * width * 4);
    if (shallow.empty()) {
      std::vector<std::uint16_t> numbers(width * 4);
      encodePixels(linear, width, picture_.encoding, numbers.data());
      return std::equal(numbers.begin(), numbers.end(), deep.begin() + at);
    }
    std::vector<std::uint8_t> numbers(width * 4);
    encodePixels(linear, width, numbers.data());
    return std::equal(numbers.begin(), numbers.end(), shallow.begin() + at);
  }

  std::vector<std::uint8_t> shallow; // of Encoding::Srgb8
  std::vector<std::uint16_t> deep;   // of the others

 private:
  const RenderOptions& picture_;
};

void fillBackground(const RenderOptions& picture, std::uint32_t firstRow, std::uint32_t rows, float* linear) {
  const auto parts = static_cast<std::uint32_t>(partsFor(rows, kRowsOfAThread));
  inParts(parts, [&](std::size_t part) {
    const auto first = static_cast<std::uint32_t>(std::uint64_t{rows} * part / parts);
    const auto end = static_cast<std::uint32_t>(std::uint64_t{rows} * (part + 1) / parts);
    drawBackground(picture.background, picture.view, picture.width, picture.height, firstRow + first, end - first,
                   linear + std::size_t{first} * picture.width * 4);
  });
}

// Whether the picture is the background alone. Models tend to be in the middle, so most pictures show at once that
// there is more.
bool isBackgroundAlone(const RenderOptions& picture, const Encoded& encoded) {
  std::vector<float> row(std::size_t{picture.width} * 4);
  for (std::uint32_t i = 0; i < picture.height; ++i) {
    const std::uint32_t y = (picture.height / 2 + i) % picture.height;
    drawBackground(picture.background, picture.view, picture.width, picture.height, y, 1, row.data());
    if (!encoded.hasRow(y, row.data())) return false;
  }
  return true;
}

// Whether the background is a colour that 8-bit pictures have, so that nothing is lost where it shows through.
bool hasCodes(const RenderOptions& picture) {
  if (picture.encoding != Encoding::Srgb8 || picture.background.kind != Background::Kind::Color) return false;
  const glm::vec3 codes = picture.background.srgb * 255.0F;
  return glm::all(glm::lessThan(glm::abs(codes - glm::round(codes)), glm::vec3(1.0e-3F)));
}

// Where the fragments of each pixel are counted.
struct LayerCounts {
  std::uint32_t* first;
  std::size_t width;
};

int countLayers(void* user, std::uint32_t x, std::uint32_t y, const VitrailLayer* /*layers*/, std::uint32_t count,
                float* /*color*/) {
  const LayerCounts& counts = *static_cast<const LayerCounts*>(user);
  counts.first[y * counts.width + x] = count; // x and y are those of the picture, in every band
  return 1;                                   // nobody looks at the picture
}

// Where the nearest fragments are left out.
struct Peeling {
  std::uint32_t count;
  std::uint32_t samples;
  std::atomic<bool> any{false}; // something was
};

int peel(void* user, std::uint32_t /*x*/, std::uint32_t /*y*/, const VitrailLayer* layers, std::uint32_t count,
         float* color) {
  Peeling& peeling = *static_cast<Peeling*>(user);
  if (!peeling.any.load(std::memory_order_relaxed)) peeling.any = true;
  blendPeeled({layers, count}, peeling.count, peeling.samples, color);
  return 1;
}

int tellTiles(void* user, std::uint32_t tilesDone, std::uint32_t /*tiles*/) {
  static_cast<const RenderOptions*>(user)->onTile(tilesDone);
  return 0;
}

} // namespace

// What the bands of a picture add up to.
struct CpuStillRenderer::Totals {
  PassClock clock;
  FrameReport report;
  std::uint64_t coveredPixels = 0;

  explicit Totals(bool counts) {
    report.complete = true;
    report.counted = counts;
    report.errorBound = 0.0;
    report.tiles = 0;
  }

  void draw(Rasterizer& rasterizer, const VitrailCpuFrame& frame, std::span<const VitrailCpuDraw> draws) {
    ++report.tiles;
    VitrailStats band{};
    rasterizer.render(frame, draws, report.counted ? &band : nullptr);
    if (!report.counted) return;
    report.fragmentsRequested += band.fragmentsRequested;
    report.fragmentsStored += band.fragmentsStored;
    report.fragmentsMissing += band.fragmentsMissing;
    report.layersMax = std::max(report.layersMax, band.layersMax);
    report.complete = report.complete && band.complete != 0;
    report.errorBound = std::max(report.errorBound, static_cast<double>(band.errorBound));
    coveredPixels += band.coveredPixels;
  }
};

struct CpuStillRenderer::Impl {
  MethodOptions method;
  Rasterizer rasterizer;
  std::vector<std::string> warnings; // of the scene
  CpuScene scene;
  std::string device;
  std::span<const VitrailCpuDraw> draws; // of the picture at hand
  LargeArray band;                       // linear rows, those that are drawn at once

  template <class GivenScene>
  Impl(GivenScene&& given, std::optional<float> opacity, DrawOrder order, const MethodOptions& chosen)
      : method(chosen),
        warnings(pointWarnings(given)),
        scene(std::forward<GivenScene>(given), opacity, order),
        device(rasterizer.name()) {
    warnings.insert(warnings.begin(), scene.warnings().begin(), scene.warnings().end());
  }

  std::vector<std::string> pointWarnings(const Scene& given) const {
    std::vector<std::string> made;
    warnOfPoints(given, cpuPointSize(given), rasterizer.name(), made);
    return made;
  }

  FrameReport draw(const RenderOptions& picture, Encoded* encoded);
  void drawCodes(const RenderOptions& picture, VitrailCpuFrame& frame, Encoded& encoded, Totals& totals);
  void drawBands(const RenderOptions& picture, VitrailCpuFrame& frame, Encoded* encoded, Totals& totals);
  VitrailCpuFrame frameOf(const RenderOptions& picture) const;
  void finish(FrameReport& report, const RenderOptions& picture, const PassTimes& passes) const;
};

// The frame of a whole picture.
VitrailCpuFrame CpuStillRenderer::Impl::frameOf(const RenderOptions& picture) const {
  VitrailCpuFrame frame{};
  frame.width = picture.width;
  frame.height = picture.height;
  frame.pictureWidth = picture.width;
  frame.pictureHeight = picture.height;
  frame.samples = method.samples;
  frame.clipSpace = VITRAIL_CPU_CLIP_VULKAN;
  frame.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
  frame.memoryBudget = picture.memoryBudget.value_or(0);
  if (picture.onTile) {
    frame.progress = tellTiles;
    frame.progressUser = const_cast<RenderOptions*>(&picture); // it is not written to
  }
  return frame;
}

FrameReport CpuStillRenderer::Impl::draw(const RenderOptions& picture, Encoded* encoded) {
  if (std::max(picture.width, picture.height) > kMaxProcessorSide) {
    throw GpuError(fmt::format("a picture of {}x{} is too large: the processor draws at most {}x{}", picture.width,
                               picture.height, kMaxProcessorSide, kMaxProcessorSide));
  }
  Totals totals(picture.counts);
  VitrailCpuFrame frame = frameOf(picture);
  draws = scene.draws(picture.view, picture.width, picture.height);
  totals.clock.end("vertices");
  Peeling peeling{picture.peel, method.samples};
  if (picture.peel > 0) {
    frame.list = peel;
    frame.listUser = &peeling;
  }
  if (encoded != nullptr && hasCodes(picture)) {
    drawCodes(picture, frame, *encoded, totals);
  } else {
    drawBands(picture, frame, encoded, totals);
  }
  FrameReport& report = totals.report;
  report.layersMean = meanLayers(report.fragmentsStored, totals.coveredPixels);
  if (!report.pixelLayers.empty()) report.layersMax = std::ranges::max(report.pixelLayers);
  finish(report, picture, totals.clock.passes());
  if (picture.peel > 0 && !peeling.any) {
    report.warnings.push_back(nothingPeeledWarning());
  }
  return report;
}

// The rasteriser encodes: each pixel is touched once, and there is no other picture than the encoded one.
void CpuStillRenderer::Impl::drawCodes(const RenderOptions& picture, VitrailCpuFrame& frame, Encoded& encoded,
                                       Totals& totals) {
  std::array<float, 4> linear{};
  drawBackground(picture.background, picture.view, 1, 1, 0, 1, linear.data());
  frame.clear = linear.data();
  frame.colorFormat = VITRAIL_CPU_RGBA8_SRGB;
  frame.color = encoded.shallow.data();
  totals.draw(rasterizer, frame, draws);
  totals.clock.end("draw");
}

// Draws in linear light, and encodes where that is wanted.
void CpuStillRenderer::Impl::drawBands(const RenderOptions& picture, VitrailCpuFrame& frame, Encoded* encoded,
                                       Totals& totals) {
  const auto most = static_cast<std::uint32_t>(std::max<std::uint64_t>(kBandPixels / picture.width, 1));
  const std::uint32_t rows = std::min(picture.height, most);
  float* const pixels = band.atLeast(std::size_t{picture.width} * rows * 4);
  frame.colorFormat = VITRAIL_CPU_RGBA32F;
  frame.color = pixels;
  std::vector<std::uint32_t>& layers = totals.report.pixelLayers;
  LayerCounts counts{nullptr, picture.width};
  if (method.name == kLayerCount) {
    layers.resize(std::size_t{picture.width} * picture.height);
    counts.first = layers.data();
    frame.list = countLayers;
    frame.listUser = &counts;
  }
  std::array<float, 4> everywhere{};
  if (picture.background.kind != Background::Kind::Sky) {
    drawBackground(picture.background, picture.view, 1, 1, 0, 1, everywhere.data());
    frame.clear = everywhere.data();
  }
  for (frame.originY = 0; frame.originY < picture.height; frame.originY += rows) {
    frame.height = std::min(rows, picture.height - frame.originY);
    if (frame.clear == nullptr) {
      fillBackground(picture, frame.originY, frame.height, pixels);
      totals.clock.end("background");
    }
    totals.draw(rasterizer, frame, draws);
    totals.clock.end("draw");
    if (encoded == nullptr) continue;
    encoded->set(frame.originY, frame.height, pixels);
    totals.clock.end("encode");
  }
}

void CpuStillRenderer::Impl::finish(FrameReport& report, const RenderOptions& picture, const PassTimes& passes) const {
  report.nodesBytes = rasterizer.fragmentBytes();
  report.totalBytes = report.nodesBytes;
  report.device = device;
  report.api = "CPU";
  report.method = method.name;
  report.width = picture.width;
  report.height = picture.height;
  report.samples = method.samples;
  report.peeled = picture.peel;
  report.warnings = warnings;
  report.peakBytes = peakMemory();
  report.passesMs = passes;
  for (const auto& [name, milliseconds] : passes) report.frameMs += milliseconds;
}

CpuStillRenderer::CpuStillRenderer(const Scene& scene, std::optional<float> opacity, DrawOrder order,
                                   const MethodOptions& method)
    : impl_(std::make_unique<Impl>(scene, opacity, order, method)) {}

CpuStillRenderer::CpuStillRenderer(Scene&& scene, std::optional<float> opacity, const MethodOptions& method)
    : impl_(std::make_unique<Impl>(std::move(scene), opacity, DrawOrder::Forward, method)) {}

CpuStillRenderer::~CpuStillRenderer() = default;

RenderResult CpuStillRenderer::render(const RenderOptions& options) {
  RenderResult result;
  Encoded encoded(options);
  result.report = impl_->draw(options, &encoded);
  result.isEmpty = isBackgroundAlone(options, encoded);
  const bool hasAlpha = options.background.kind == Background::Kind::Transparent;
  if (options.encoding == Encoding::Srgb8) {
    result.picture = {options.width, options.height, hasAlpha, std::move(encoded.shallow)};
  } else {
    result.deep = {options.width, options.height, hasAlpha, options.encoding, std::move(encoded.deep)};
  }
  return result;
}

FrameReport CpuStillRenderer::measure(const RenderOptions& options) { return impl_->draw(options, nullptr); }

std::string processorDevice() { return Rasterizer().name(); }

} // namespace vitrail::tool
