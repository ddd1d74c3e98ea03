// The shared device lives until the test program ends its environments, before static objects go.
#include "gpu_fixture.h"

#include <memory>

namespace vitrail::tool::test {

namespace {

std::unique_ptr<Gpu>& sharedGpu() {
  static std::unique_ptr<Gpu> gpu;
  return gpu;
}

class GpuEnvironment : public ::testing::Environment {
 public:
  void TearDown() override { sharedGpu().reset(); }
};

const ::testing::Environment* const environment = ::testing::AddGlobalTestEnvironment(new GpuEnvironment);

} // namespace

Gpu& GpuTest::gpu() {
  std::unique_ptr<Gpu>& gpu = sharedGpu();
  if (!gpu) {
    GpuOptions options;
    options.validate = true;
    gpu = std::make_unique<Gpu>(options);
  }
  return *gpu;
}

void GpuTest::TearDown() {
  if (!sharedGpu()) return;
  for (const std::string& error : sharedGpu()->validationErrors()) ADD_FAILURE() << error;
}

RenderResult renderOnce(Gpu& gpu, const Scene& scene, const RenderOptions& options, std::optional<float> opacity,
                        DrawOrder order) {
  Renderer renderer(gpu, scene, opacity, order);
  return renderer.render(options);
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

} // namespace vitrail::tool::test
