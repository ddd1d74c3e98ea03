// One frame of a picture while it is drawn: what a method draws with. What Frame is with Vulkan.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gl_images.h"
#include "gl_surfaces.h"

namespace vitrail::tool {

// The time that the device takes between the passes of a frame: GL_TIMESTAMP. Drivers on CPUs put draws off until
// somebody waits for them, whatever is stamped: there every pass is waited for, and the clock read.
class GlTimers {
 public:
  explicit GlTimers(const Gl& gl) : waits_(gl.isCpu()) {}
  ~GlTimers();
  GlTimers(const GlTimers&) = delete;
  GlTimers& operator=(const GlTimers&) = delete;

  void startFrame();
  void startSubmission();
  void endPass(const std::string& name);
  void addHostPass(const std::string& name, double milliseconds);
  // Adds the passes since the last start to the frame's, once the device has drawn them. A pass that comes again is
  // summed.
  void addSubmission();

  const std::vector<std::pair<std::string, double>>& milliseconds() const { return frame_; }

 private:
  void stamp();
  std::uint64_t nanosecondsAt(std::size_t stamp) const;
  void add(const std::string& name, double milliseconds);

  bool waits_;
  std::vector<GLuint> queries_;      // of stamps, or
  std::vector<std::uint64_t> clock_; // what the clock said
  std::size_t stamps_ = 0;
  std::vector<std::string> names_; // of the submission's passes
  std::vector<std::pair<std::string, double>> frame_;
};

class GlFrame {
 public:
  // All outlive the frame.
  GlFrame(GlTimers& timers, const GlImages& images, const GlSurfaces& surfaces);

  const GlImages& images() const { return images_; }
  const GlSurfaces& surfaces() const { return surfaces_; }

  // Draws the transparent surfaces into the framebuffer that is bound, all of them in the order of submission, or
  // `runs` of them in an order of the method's.
  void drawSurfaces(const GlSurfacePrograms& programs, const GlSurfaces::BeforeRun& before = {});
  void drawSurfaces(const GlSurfacePrograms& programs, std::span<const SurfaceRun> runs,
                    const GlSurfaces::BeforeRun& before = {});

  // The pass `name` ends here and another begins. Passes of one name are summed.
  void endPass(const std::string& name) { timers_.endPass(name); }
  void addHostPass(const std::string& name, double milliseconds) { timers_.addHostPass(name, milliseconds); }

  // Waits for what has been drawn. Times go on adding up.
  void wait();
  // The same, and nothing is drawn any more.
  void finish();

 private:
  GlTimers& timers_;
  const GlImages& images_;
  const GlSurfaces& surfaces_;
};

// A small block that changes from draw to draw (PUSHED).
class GlPushed {
 public:
  GlPushed() = default;
  GlPushed(Gl& gl, std::uint64_t bytes) : buffer_(gl, bytes, "constants") {}

  void set(std::span<const std::byte> bytes) const;
  template <typename Block>
  void set(const Block& block) const {
    set(std::as_bytes(std::span(&block, 1)));
  }

 private:
  GlBuffer buffer_;
};

} // namespace vitrail::tool
