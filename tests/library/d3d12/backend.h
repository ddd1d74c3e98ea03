// The Direct3D 12 backend of the tests, and the pipelines that hosts share.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include <vitrail/d3d12.h>

#include "../backend.h"
#include "device.h"

namespace vitrail::tests::d3d12 {

// How points are collected.
struct PointsKind {
  std::string shader = "points"; // of the build's, with what it was compiled for
  std::uint32_t samples = 1;
  UINT mask = 0xffffffffU; // of the samples
  DXGI_FORMAT color = DXGI_FORMAT_R32G32B32A32_FLOAT;
  DXGI_FORMAT depth = DXGI_FORMAT_UNKNOWN;
  D3D12_COMPARISON_FUNC passes = D3D12_COMPARISON_FUNC_LESS_EQUAL;
  bool stencil = false;
  bool opaque = false;                 // the opaque scene instead
  ID3D12RootSignature* root = nullptr; // default: the backend's
};

class D3d12Backend : public Backend {
 public:
  [[nodiscard]] std::string name() const override { return "d3d12"; }
  [[nodiscard]] std::string callPrefix() const override { return "vitrailD3d12"; }
  const Features& features() override;
  std::unique_ptr<PointHost> makeHost(const HostDesc& desc) override;
  VitrailTileLimits tileLimits(VitrailNodeFormat format, std::uint32_t samples) override;
  std::vector<LogLine> takeLog() override;
  // Lines of the library's log that no test took, and a removed device.
  std::vector<std::string> takeErrors() override;
  void close() override;

  VitrailD3d12Context context();
  VitrailD3d12ContextDesc contextDesc();

  // Made once each. The root signature of points has the library's five parameters, that of the opaque scene eight
  // constants, that of walks eight constants, what is written, and the library's four.
  ID3D12RootSignature* pointsRoot();
  ID3D12RootSignature* opaqueRoot();
  ID3D12RootSignature* walkRoot();
  ID3D12PipelineState* points(const PointsKind& kind);
  ID3D12PipelineState* walk(const std::string& shader);

 private:
  VitrailD3d12Context context_ = nullptr;
  bool open_ = false;
  Features features_;
  Com<ID3D12RootSignature> pointsRoot_;
  Com<ID3D12RootSignature> opaqueRoot_;
  Com<ID3D12RootSignature> walkRoot_;
  std::map<std::string, Com<ID3D12PipelineState>> pipelines_;
  std::vector<LogLine> log_;
};

D3d12Backend& backend();

inline void expectOneLine(const std::string& word) { tests::expectOneLine(backend(), word); }

// A test of what only Direct3D 12 has.
class D3d12Test : public ::testing::Test {
 protected:
  // Fails the test for every line of the log that it did not take.
  void TearDown() override;
};

} // namespace vitrail::tests::d3d12
