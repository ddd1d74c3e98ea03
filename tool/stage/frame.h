// One frame of a picture while it is recorded: what a transparency method draws with.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "../gpu/submit.h"
#include "../gpu/timers.h"
#include "picture_images.h"
#include "surfaces.h"

namespace vitrail::tool {

class Frame {
 public:
  // Begins the first submission. All outlive the frame. Without `timesSteps` passes have fewer time stamps: endStep().
  Frame(Submitter& submitter, Timers& timers, PictureImages& images, const Surfaces& surfaces, bool timesSteps = true);

  // What is recorded into, until submitAndWait(). Outside a rendering scope, unless the method has begun one.
  VkCommandBuffer commands() const { return commands_; }
  PictureImages& images() { return images_; }
  const Surfaces& surfaces() const { return surfaces_; }

  // Draws the transparent surfaces, all of them in the order of submission, or `runs` of them in an order of the
  // method's, whose indices are those of `indices` where it is not null. Inside a rendering scope; nothing that was
  // bound before stays bound. `set` is set 2 of the pipelines, null where they have none.
  void drawSurfaces(const SurfacePipelines& pipelines, VkDescriptorSet set = VK_NULL_HANDLE);
  void drawSurfaces(const SurfacePipelines& pipelines, VkDescriptorSet set, std::span<const SurfaceRun> runs,
                    VkBuffer indices = VK_NULL_HANDLE);

  // The most passes that one submission has, the renderer's own among them; submitAndWait() begins another.
  static constexpr std::uint32_t kMostPasses = 64;
  // The pass `name` ends here and another begins: how the frame's time is reported. Passes of one name are summed.
  // Outside a rendering scope. Throws std::logic_error where the submission has kMostPasses.
  void endPass(const std::string& name);
  // The same of a pass behind which another one of the method's is sure to come. Of a frame that does not time steps it
  // is a part of that one, as stamps take time.
  void endStep(const std::string& name);
  // The host worked so long on the frame: reported as a pass of that name.
  void addHostPass(const std::string& name, double milliseconds);

  // Has the GPU execute what has been recorded, and waits for it: the host may then read what shaders wrote, and go on
  // recording, into other commands(). Times go on adding up. The work since the last endPass() has no name and is not
  // reported. Outside a rendering scope.
  void submitAndWait();
  // The same, and nothing is recorded any more.
  void finish();
  // The same without waiting: that is left to who has the Submitter, and the Timers' addSubmission() with it.
  void submit();

 private:
  Submitter& submitter_;
  Timers& timers_;
  PictureImages& images_;
  const Surfaces& surfaces_;
  bool timesSteps_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

} // namespace vitrail::tool
