// Draws pictures for somebody who moves about in a scene: as fast as the device draws them, with several in flight, and
// without waiting for any. Each is drawn once, into lists whose memory follows what the last pictures needed, within
// the budget (vitrailVkUpdateTarget); its report says whether it is exact. The same scene can be drawn as StillRenderer
// does, in between.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "../gpu/device.h"
#include "../gpu/timers.h"
#include "encode_image.h"
#include "gpu_pick.h"
#include "renderer.h"
#include "still.h"

namespace vitrail::tool {

// A picture that the GPU has drawn.
struct InteractivePicture {
  // Its codes, in the top left corner: for fragment shaders, in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL. Whoever lets
  // the GPU sample it holds it until that is done.
  std::shared_ptr<const GpuImage> image;
  VkExtent2D part{};
  std::vector<std::uint8_t> pixels; // of the part, where they were asked for
  FrameReport report;
};

class InteractiveRenderer final : public Renderer {
 public:
  static constexpr std::uint32_t kFramesInFlight = 2;

  // Whether it draws by a method.
  static bool draws(const MethodOptions& method);

  // As StillRenderer. Throws GpuError.
  InteractiveRenderer(Gpu& gpu, const Scene& scene, std::optional<float> opacity, const MethodOptions& method);
  ~InteractiveRenderer() override;

  // Begins a picture of options.width and options.height, in the corner of images of `size`, neither smaller.
  // `readsBack`: with its pixels. Fewer than kFramesInFlight are pending. False: the device has no room to draw so, and
  // render() draws it. Throws GpuError.
  bool draw(const RenderOptions& options, VkExtent2D size, bool readsBack);
  std::size_t pending() const { return pending_.size(); } // that were begun and not finished
  // Waits for the oldest of them.
  InteractivePicture finish();

  // Other planes cut the scene from now on, which some cut already: nothing is made anew.
  void setClipPlanes(const Scene& scene) { still_.stage().setClipPlanes(scene); }

  // What is under a pixel of such a picture, from its lists (gpu_pick.h). None is pending. Throws GpuError.
  std::optional<std::vector<PickedLayer>> pick(const RenderOptions& options, std::uint32_t x, std::uint32_t y);
  // The GPU's time for that.
  [[nodiscard]] double pickMilliseconds() const { return picker_ ? picker_->milliseconds() : 0.0; }

  // None is pending.
  RenderResult render(const RenderOptions& options) override;
  FrameReport measure(const RenderOptions& options) override;

 private:
  // What belongs to a frame in flight.
  struct Slot {
    explicit Slot(Gpu& gpu) : timers(gpu, Frame::kMostPasses), submitter(gpu) {}
    Timers timers;
    GpuBuffer pixels;
    Submitter submitter; // the first that goes: it waits for what uses the others
  };
  struct Pending {
    Slot* slot = nullptr;
    std::shared_ptr<EncodeImagePass::Output> output;
    RenderOptions options;
    std::uint64_t picture = 0; // of the method
    bool readsBack = false;
    std::optional<FrameStats> stats{}; // once the GPU is done
  };

  void setSize(VkExtent2D size);
  std::shared_ptr<EncodeImagePass::Output> freeOutput();
  void settle(Pending& pending);
  void settleAll();

  Gpu& gpu_;
  MethodOptions method_;
  StillRenderer still_;
  std::vector<DrawFacts> facts_; // of the scene
  std::optional<GpuPicker> picker_;
  EncodeImagePass encode_;
  std::vector<std::shared_ptr<EncodeImagePass::Output>> outputs_; // of the stage's present images
  std::uint64_t outputImages_ = 0;                                // which those are
  std::vector<std::unique_ptr<Slot>> slots_;
  std::size_t next_ = 0;
  std::deque<Pending> pending_;
  // The size and the budget of a picture for which there was no room in flight.
  std::optional<std::tuple<std::uint32_t, std::uint32_t, std::optional<std::uint64_t>>> noRoom_;
};

} // namespace vitrail::tool
