// The shared device lives until the test program ends its environments, before static objects go.
#include "fixture.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>

#include "../../tool/methods/methods.h"
#include "../../tool/render/cpu_still.h"
#include "../../tool/render/gl_still.h"
#include "../kept/kept_pipelines.h"

namespace vitrail::tool::test {

namespace {

std::unique_ptr<Gpu>& sharedGpu() {
  static std::unique_ptr<Gpu> gpu;
  return gpu;
}

std::unique_ptr<Gl>& sharedGl() {
  static std::unique_ptr<Gl> gl;
  return gl;
}

class GpuEnvironment : public ::testing::Environment {
 public:
  void TearDown() override {
    sharedGl().reset();
    if (!sharedGpu()) return;
    for (const std::string& mistake : tests::destroyKeptPipelines(sharedGpu()->device())) ADD_FAILURE() << mistake;
    sharedGpu().reset();
  }
};

const ::testing::Environment* const environment = ::testing::AddGlobalTestEnvironment(new GpuEnvironment);

} // namespace

Gpu& GpuTest::gpu() {
  std::unique_ptr<Gpu>& gpu = sharedGpu();
  if (!gpu) {
    GpuOptions options;
    options.validate = true;
    gpu = std::make_unique<Gpu>(options);
    tests::keepPipelines();
  }
  return *gpu;
}

Gl& GpuTest::gl() {
  std::unique_ptr<Gl>& gl = sharedGl();
  if (!gl) gl = std::make_unique<Gl>(GlOptions{{}, true});
  return *gl;
}

void GpuTest::TearDown() {
  std::vector<std::string> errors;
  if (sharedGpu()) errors = sharedGpu()->validationErrors();
  for (const std::string& error : errors) ADD_FAILURE() << error;
  if (sharedGl()) errors = sharedGl()->validationErrors();
  for (const std::string& error : errors) ADD_FAILURE() << error;
}

std::unique_ptr<Renderer> rendererOf(Gpu& gpu, const Scene& scene, std::optional<float> opacity, DrawOrder order,
                                     const MethodOptions& method) {
  if (traitsOf(method.name).onProcessor) return std::make_unique<CpuStillRenderer>(scene, opacity, order, method);
  if (method.api == Api::OpenGl) {
    return std::make_unique<GlStillRenderer>(GpuTest::gl(), scene, opacity, order, method);
  }
  return std::make_unique<StillRenderer>(gpu, scene, opacity, order, method);
}

RenderResult renderOnce(Gpu& gpu, const Scene& scene, const RenderOptions& options, std::optional<float> opacity,
                        DrawOrder order, const MethodOptions& method) {
  return rendererOf(gpu, scene, opacity, order, method)->render(options);
}

std::vector<MethodOptions> methodVariety(const Gpu& gpu) {
  MethodOptions drawn;
  drawn.resolve = VITRAIL_RESOLVE_FRAGMENT;
  MethodOptions compact;
  compact.nodes = VITRAIL_NODE_COMPACT;
  compact.resolve = VITRAIL_RESOLVE_COMPUTE;
  MethodOptions hdr = drawn;
  hdr.nodes = VITRAIL_NODE_HDR;
  MethodOptions linkedByCompute;
  linkedByCompute.listBuild = VITRAIL_LIST_BUILD_COMPUTE;
  std::vector<MethodOptions> methods = {compact, hdr, linkedByCompute};
  for (const std::uint32_t samples : {2U, 4U, 8U}) {
    if ((gpu.features().sampleCounts & samples) == 0) continue;
    MethodOptions perPixel;
    perPixel.samples = samples;
    methods.push_back(perPixel);
    if (!gpu.features().sampleRateShading) continue;
    MethodOptions perSample = drawn;
    perSample.samples = samples;
    perSample.msaaResolve = VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
    methods.push_back(perSample);
  }
  return methods;
}

std::string describe(const MethodOptions& method) {
  return std::to_string(method.samples) + " samples, " + std::string(nameOf(method.nodes)) + ", " +
         (method.resolve == VITRAIL_RESOLVE_DEFAULT ? "default resolve" : std::string(nameOf(method.resolve))) + ", " +
         std::string(nameOf(method.msaaResolve));
}

RenderOptions usualOptions(const Scene& scene, std::uint32_t width, std::uint32_t height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  options.view = scene.cameras.empty() ? frameScene(scene, Orbit{}, aspect) : viewOf(scene.cameras.front());
  options.background = scene.background.value_or(Background{});
  return options;
}

int largestDifference(const Picture& a, const Picture& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) largest = std::max(largest, std::abs(int{a.rgba[i]} - b.rgba[i]));
  return largest;
}

} // namespace vitrail::tool::test
