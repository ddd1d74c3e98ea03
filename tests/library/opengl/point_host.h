// The point host of OpenGL: one context, one frame after the other.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <vitrail/gl.h>

#include "../host.h"
#include "backend.h"

namespace vitrail::tests::opengl {

// The textures of one frame and the framebuffers that draw into them.
class PointTextures {
 public:
  PointTextures() = default;
  explicit PointTextures(const HostDesc& desc);
  ~PointTextures();
  PointTextures(PointTextures&& other) noexcept { *this = std::move(other); }
  PointTextures& operator=(PointTextures&& other) noexcept;

  GLuint color = 0;        // one sample
  GLuint multisampled = 0; // where there are several
  GLuint depth = 0;        // where something is tested
  GLuint drawn = 0;        // framebuffer: the opaque scene, and a resolve per sample
  GLuint resolved = 0;     // framebuffer: `color` alone
  GLuint collecting = 0;   // framebuffer: as `drawn`, without a draw buffer
};

class OpenGlHost : public PointHost {
 public:
  OpenGlHost(OpenGlBackend& backend, const HostDesc& desc, bool hostBarriers = false);
  ~OpenGlHost() override;

  std::vector<PointResult> drawTogether(const std::vector<std::vector<Point>>& frames) override;
  std::array<PointResult, 2> drawAcrossResize(std::span<const Point> first, Extent extent,
                                              std::span<const Point> second, std::uint32_t capacity) override;
  PointResult drawAreas(std::span<const Point> points, const NextArea& next) override;
  PointResult drawScattered(std::span<const Point> points) override;
  ListsRead drawAndRead(std::span<const Point> points, const VitrailRect& area, ReadBy by, bool afterResolve) override;
  CallsResult drawCalls(const std::function<void(FrameCalls&)>& make) override;
  void drop(std::span<const Point> points) override; // what OpenGL was given it runs: nobody looks at the frame
  [[nodiscard]] bool guardsUntouched() override;
  [[nodiscard]] std::vector<std::uint32_t> words(StoragePart StorageLayout::*part) override;
  [[nodiscard]] VitrailMemory memory() const override;
  [[nodiscard]] std::uint64_t newestFrame() const override { return vitrailGlTargetFrame(target_); }
  [[nodiscard]] std::optional<VitrailStats> stats(std::uint64_t frame) const override;

  [[nodiscard]] VitrailGlTarget target() const { return target_; }
  PointTextures& texturesOf(std::uint64_t frame) { return textures_[frame % kFramesTogether]; }

  // The calls of a frame, for tests that look at what is between them.
  void drawOpaque(PointTextures& textures);
  void begin(std::uint64_t frame, const VitrailRect& area);
  void drawPoints(PointTextures& textures, std::span<const Point> points);
  void collected();
  void resolve(PointTextures& textures, std::uint64_t view);
  void end();
  [[nodiscard]] PointResult read(const PointTextures& textures, std::uint64_t frame) const;

 private:
  class Calls;

  void makeTextures();
  [[nodiscard]] VitrailGlTextures views();
  [[nodiscard]] VitrailGlTargetDesc targetDesc();
  void guard(VitrailGlTargetDesc& desc);
  GLuint programFor(VitrailGlTargetDesc target, bool specialized);
  void update(std::uint64_t frame);
  void drawFrame(std::uint64_t frame, PointTextures& textures, const VitrailRect& area, std::span<const Point> points);
  void barrier(VitrailGlBarrierPoint point) const;
  void walk(const VitrailRect& area, GLuint buffer);
  [[nodiscard]] std::vector<FloatColor> pixels(const PointTextures& textures) const;
  [[nodiscard]] std::vector<std::uint32_t> wordsAt(std::uint64_t offset, std::uint64_t size) const; // of memory_
  [[nodiscard]] VitrailRect wholeArea() const { return {0, 0, desc_.width, desc_.height}; }

  OpenGlBackend& backend_;
  HostDesc desc_;
  bool hostBarriers_ = false;
  bool postDepthCoverage_ = false;
  std::uint64_t frame_ = 0;
  std::array<PointTextures, kFramesTogether> textures_; // of frame n: n % kFramesTogether
  std::array<GLuint, kFramesTogether> colorViews_{};    // what views() points to
  std::array<GLuint, kFramesTogether> opaqueViews_{};
  std::array<GLuint, kFramesTogether> depthViews_{};
  std::uint64_t guardBytes_ = 0;
  StorageLayout storage_; // of the memory between the guards
  GLuint memory_ = 0;     // guards, the library's memory, guards
  VitrailGlTarget target_ = nullptr;
  GLuint points_ = 0;    // the backend's
  GLuint strangers_ = 0; // the backend's
  GLuint vertices_ = 0;
  GLuint vertexArray_ = 0;
};

} // namespace vitrail::tests::opengl
