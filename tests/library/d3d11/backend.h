// The Direct3D 11 backend of the tests, and the shaders that hosts share.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <vitrail/d3d11.h>

#include "../backend.h"
#include "device.h"

namespace vitrail::tests::d3d11 {

// "NAME=VALUE", for shaders.
using Defines = std::vector<std::string>;

class D3d11Backend : public Backend {
 public:
  [[nodiscard]] std::string name() const override { return "d3d11"; }
  [[nodiscard]] std::string callPrefix() const override { return "vitrailD3d11"; }
  const Features& features() override;
  std::unique_ptr<PointHost> makeHost(const HostDesc& desc) override;
  VitrailTileLimits tileLimits(VitrailNodeFormat format, std::uint32_t samples) override;
  std::vector<LogLine> takeLog() override;
  // Lines of the library's log that no test took, and a removed device.
  std::vector<std::string> takeErrors() override;
  void close() override;

  VitrailD3d11Context context();
  VitrailD3d11ContextDesc contextDesc();

  // Shaders of tests/library/direct3d/shaders, compiled once. Throws HostError.
  ID3D11PixelShader* pixelShader(const std::string& file, const Defines& defines = {});
  ID3D11ComputeShader* computeShader(const std::string& file, const Defines& defines = {});
  ID3D11VertexShader* vertexShader(const std::string& file);
  ID3D11InputLayout* pointLayout();

 private:
  VitrailD3d11Context context_ = nullptr;
  bool open_ = false;
  Features features_;
  std::map<std::string, Com<ID3D11PixelShader>> pixelShaders_;
  std::map<std::string, Com<ID3D11ComputeShader>> computeShaders_;
  std::map<std::string, Com<ID3D11VertexShader>> vertexShaders_;
  Com<ID3D11InputLayout> pointLayout_;
  std::vector<LogLine> log_;
};

D3d11Backend& backend();

inline void expectOneLine(const std::string& word) { tests::expectOneLine(backend(), word); }

// A test of what only Direct3D 11 has.
class D3d11Test : public ::testing::Test {
 protected:
  // Fails the test for every line of the log that it did not take.
  void TearDown() override;
};

} // namespace vitrail::tests::d3d11
