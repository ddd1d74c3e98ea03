// The point host of Direct3D 11: one frame after the other, on the immediate context, or with `deferred` each frame in
// a command list of its own.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <vitrail/d3d11.h>

#include "../host.h"
#include "backend.h"

namespace vitrail::tests::d3d11 {

// The textures of one frame, and their views; null where there is none.
struct PointTextures {
  PointTextures() = default;
  explicit PointTextures(const HostDesc& desc);

  Com<ID3D11Texture2D> color; // one sample
  Com<ID3D11RenderTargetView> colorTarget;
  Com<ID3D11UnorderedAccessView> colorWritten;
  Com<ID3D11Texture2D> multisampled; // where there are several
  Com<ID3D11RenderTargetView> multisampledTarget;
  Com<ID3D11ShaderResourceView> multisampledRead;
  Com<ID3D11Texture2D> depth; // where something is tested
  Com<ID3D11DepthStencilView> depthTarget;
  Com<ID3D11DepthStencilView> depthTested; // read-only
  Com<ID3D11ShaderResourceView> depthRead;

  [[nodiscard]] ID3D11RenderTargetView* shown() const {
    return multisampledTarget ? multisampledTarget.get() : colorTarget.get();
  }
};

class D3d11Host : public PointHost {
 public:
  D3d11Host(D3d11Backend& backend, const HostDesc& desc, bool deferred = false);
  ~D3d11Host() override;

  std::vector<PointResult> drawTogether(const std::vector<std::vector<Point>>& frames) override;
  std::array<PointResult, 2> drawAcrossResize(std::span<const Point> first, Extent extent,
                                              std::span<const Point> second, std::uint32_t capacity) override;
  PointResult drawAreas(std::span<const Point> points, const NextArea& next) override;
  PointResult drawScattered(std::span<const Point> points) override;
  ListsRead drawAndRead(std::span<const Point> points, const VitrailRect& area, ReadBy by, bool afterResolve) override;
  CallsResult drawCalls(const std::function<void(FrameCalls&)>& make) override;
  void drop(std::span<const Point> points) override;
  [[nodiscard]] bool guardsUntouched() override;
  [[nodiscard]] std::vector<std::uint32_t> words(StoragePart StorageLayout::*part) override;
  [[nodiscard]] VitrailMemory memory() const override;
  [[nodiscard]] std::optional<VitrailStats> stats(std::uint64_t frame) const override;
  [[nodiscard]] std::uint64_t newestFrame() const override { return vitrailD3d11TargetFrame(target_); }

  [[nodiscard]] VitrailD3d11Target target() const { return target_; }
  PointTextures& texturesOf(std::uint64_t frame) { return textures_[frame % kFramesTogether]; }

  // The calls of a frame, for tests that look at what is between them.
  void drawOpaque(ID3D11DeviceContext* commands, PointTextures& textures);
  void begin(ID3D11DeviceContext* commands, std::uint64_t frame, const VitrailRect& area);
  void drawPoints(ID3D11DeviceContext* commands, PointTextures& textures, std::span<const Point> points);
  // What drawPoints() sets beside the library's; and its vertices.
  void setForPoints(ID3D11DeviceContext* commands, PointTextures& textures) const;
  Com<ID3D11Buffer> setVertices(ID3D11DeviceContext* commands, std::span<const Point> points) const;
  void setTargets(ID3D11DeviceContext* commands, PointTextures& textures) const; // those of the resolve
  void resolve(ID3D11DeviceContext* commands, PointTextures& textures, std::uint64_t view);
  [[nodiscard]] PointResult read(const PointTextures& textures, std::uint64_t frame) const;

 private:
  class Calls;

  void makeTextures();
  [[nodiscard]] VitrailD3d11Views views();
  [[nodiscard]] VitrailD3d11TargetDesc targetDesc();
  void guard(VitrailD3d11TargetDesc& desc);
  ID3D11PixelShader* shaderFor(const VitrailD3d11TargetDesc& target, bool specialized);
  void makeStates();
  void update(std::uint64_t frame);
  void drawFrame(ID3D11DeviceContext* commands, std::uint64_t frame, PointTextures& textures, const VitrailRect& area,
                 std::span<const Point> points);
  // A frame with its opaque scene: on the immediate context, or in a command list that is executed at once.
  void drawWhole(std::uint64_t frame, std::span<const Point> points);
  void walk(ID3D11DeviceContext* commands, const VitrailRect& area, ID3D11Buffer* buffer, std::size_t bytes);
  [[nodiscard]] std::vector<FloatColor> pixels(const PointTextures& textures) const;
  [[nodiscard]] VitrailRect wholeArea() const { return {0, 0, desc_.width, desc_.height}; }
  [[nodiscard]] std::vector<std::byte> readPart(std::size_t kind) const;

  D3d11Backend& backend_;
  HostDesc desc_;
  bool deferred_ = false;
  std::uint64_t frame_ = 0;
  std::array<PointTextures, kFramesTogether> textures_;                  // of frame n: n % kFramesTogether
  std::array<ID3D11UnorderedAccessView*, kFramesTogether> colorViews_{}; // what views() points to
  std::array<ID3D11ShaderResourceView*, kFramesTogether> opaqueViews_{};
  std::array<ID3D11ShaderResourceView*, kFramesTogether> depthViews_{};
  StorageLayout storage_;                                       // of the memory before the guards
  std::array<Com<ID3D11Buffer>, VITRAIL_D3D11_BUFFERS> memory_; // where it is this host's: the parts, and guards
  std::array<ID3D11Buffer*, VITRAIL_D3D11_BUFFERS> memoryPointers_{};
  std::array<std::uint64_t, VITRAIL_D3D11_BUFFERS> sizes_{};
  VitrailD3d11Target target_ = nullptr;
  ID3D11PixelShader* points_ = nullptr;    // the backend's
  ID3D11PixelShader* strangers_ = nullptr; // the backend's
  Com<ID3D11BlendState> noColor_;
  Com<ID3D11DepthStencilState> collecting_;
  Com<ID3D11DepthStencilState> writing_;
  Com<ID3D11RasterizerState> rasterizing_;
};

} // namespace vitrail::tests::d3d11
