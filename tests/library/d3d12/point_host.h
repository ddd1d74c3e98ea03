// The point host of Direct3D 12: frames in one command list, as far as nothing has to be read between them.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <vitrail/d3d12.h>

#include "../host.h"
#include "backend.h"
#include "d3d12/storage.h"

namespace vitrail::tests::d3d12 {

// A texture and the state that it was left in.
struct Texture {
  Com<ID3D12Resource> resource;
  D3D12_RESOURCE_STATES state = D3D12_RESOURCE_STATE_COMMON;

  void to(ID3D12GraphicsCommandList* commands, D3D12_RESOURCE_STATES after) {
    if (resource) transition(commands, resource.get(), state, after);
    state = after;
  }
};

// The textures of one frame, and their views.
struct PointTextures {
  PointTextures() = default;
  explicit PointTextures(const HostDesc& desc);

  Texture color;        // one sample
  Texture multisampled; // where there are several
  Texture depth;        // where something is tested
  Com<ID3D12DescriptorHeap> targets;
  Com<ID3D12DescriptorHeap> depths;

  [[nodiscard]] D3D12_CPU_DESCRIPTOR_HANDLE colorTarget() const { return at(targets, 0); }
  [[nodiscard]] D3D12_CPU_DESCRIPTOR_HANDLE shownTarget() const { return at(targets, multisampled.resource ? 1 : 0); }
  [[nodiscard]] D3D12_CPU_DESCRIPTOR_HANDLE depthTarget() const { return at(depths, 0); }
  [[nodiscard]] D3D12_CPU_DESCRIPTOR_HANDLE depthTested() const { return at(depths, 1); } // read-only
  [[nodiscard]] Texture& shown() { return multisampled.resource ? multisampled : color; }

 private:
  static D3D12_CPU_DESCRIPTOR_HANDLE at(const Com<ID3D12DescriptorHeap>& heap, UINT number);
};

class D3d12Host : public PointHost {
 public:
  // `change`: of what the target is made with.
  using Change = std::function<void(VitrailD3d12TargetDesc&)>;
  D3d12Host(D3d12Backend& backend, const HostDesc& desc, const Change& change = {});
  ~D3d12Host() override;

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
  [[nodiscard]] std::uint64_t newestFrame() const override { return vitrailD3d12TargetFrame(target_); }

  [[nodiscard]] VitrailD3d12Target target() const { return target_; }
  PointTextures& texturesOf(std::uint64_t frame) { return textures_[frame % kFramesTogether]; }
  [[nodiscard]] VitrailD3d12TargetDesc targetDesc();

  // The calls of a frame, for tests that look at what is between them. `kept`: what has to outlive the command list.
  void drawOpaque(ID3D12GraphicsCommandList* commands, PointTextures& textures);
  void begin(ID3D12GraphicsCommandList* commands, std::uint64_t frame, const VitrailRect& area);
  void drawPoints(ID3D12GraphicsCommandList* commands, CommandList& kept, PointTextures& textures,
                  std::span<const Point> points);
  // What drawPoints() sets beside root signature and pipeline.
  void setPoints(ID3D12GraphicsCommandList* commands, CommandList& kept, PointTextures& textures,
                 std::span<const Point> points) const;
  // The heap that is set before the library's calls, for a target with the host's descriptors.
  void setHeap(ID3D12DescriptorHeap* heap) { visible_ = heap; }
  void setForResolve(ID3D12GraphicsCommandList* commands, PointTextures& textures);
  void resolve(ID3D12GraphicsCommandList* commands, PointTextures& textures, std::uint64_t view);
  [[nodiscard]] std::vector<FloatColor> pixels(PointTextures& textures);
  [[nodiscard]] PointResult read(PointTextures& textures, std::uint64_t frame);

 private:
  class Calls;

  void makeTextures();
  [[nodiscard]] VitrailD3d12Views views();
  void guard(VitrailD3d12TargetDesc& desc);
  [[nodiscard]] std::string shaderFor(const VitrailD3d12TargetDesc& target, bool specialized) const;
  [[nodiscard]] PointsKind pointsKind(const PointTextures& textures) const;
  void update(std::uint64_t frame);
  void drawFrame(ID3D12GraphicsCommandList* commands, CommandList& kept, std::uint64_t frame, PointTextures& textures,
                 const VitrailRect& area, std::span<const Point> points);
  void walk(ID3D12GraphicsCommandList* commands, const VitrailRect& area, ID3D12Resource* buffer);
  [[nodiscard]] VitrailRect wholeArea() const { return {0, 0, desc_.width, desc_.height}; }
  [[nodiscard]] std::uint64_t placeOf(const StoragePart& part) const; // in memory_
  [[nodiscard]] std::vector<std::byte> readMemory() const;
  void writeMemory(std::uint64_t offset, std::span<const std::byte> bytes);

  D3d12Backend& backend_;
  HostDesc desc_;
  CommandList commands_;
  std::uint64_t frame_ = 0;
  std::array<PointTextures, kFramesTogether> textures_;       // of frame n: n % kFramesTogether
  std::array<ID3D12Resource*, kFramesTogether> colorViews_{}; // what views() points to
  std::array<ID3D12Resource*, kFramesTogether> opaqueViews_{};
  std::array<ID3D12Resource*, kFramesTogether> depthViews_{};
  StorageLayout storage_;      // of the memory between the guards
  Com<ID3D12Heap> heap_;       // where it is this host's
  Com<ID3D12Resource> memory_; // all of it
  std::uint64_t memoryBytes_ = 0;
  VitrailD3d12Target target_ = nullptr;
  std::string points_;
  std::string strangers_;
  ID3D12DescriptorHeap* visible_ = nullptr;
};

} // namespace vitrail::tests::d3d12
