// Draws a scene with Direct3D 11: by the library, by lists that a pixel shader sorts by insertion, or in no order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <vitrail/d3d11.h>

#include "scene.h"
#include "tests/library/d3d11/device.h"

namespace vitrail::tests::figures {

using d3d11::Com;

enum class Method { Unsorted, Insertion, Fragment, Compute }; // the last two: the library, by its resolves

struct Settings {
  std::string scene = "mannequins";
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  std::uint32_t samples = 1;
  Method method = Method::Compute;
  std::uint32_t layers = 0; // a cap on those of a pixel that are sorted, 8, 16 or 32; 0: none (the library only)
  bool wholePixels = false; // whatever samples a fragment covers it counts for all (the library only)
};

struct PassTimes {
  std::array<double, 3> milliseconds; // the opaque scene, collect or blend, resolve
  [[nodiscard]] double all() const { return milliseconds[0] + milliseconds[1] + milliseconds[2]; }
};

// A colour texture and what it is used as.
struct Picture {
  Com<ID3D11Texture2D> texture;
  Com<ID3D11RenderTargetView> target;
  Com<ID3D11UnorderedAccessView> written;
  Com<ID3D11ShaderResourceView> read;
};

// What is drawn into. Hosts of one size and as many samples share it: a device has only so much memory.
struct Images {
  Picture shown; // of one sample
  Picture drawn; // of several, where there are several
  Com<ID3D11DepthStencilView> depth;
  Com<ID3D11ShaderResourceView> depthRead;
};

// One way to draw one scene, and what it takes.
class Host {
 public:
  explicit Host(const Settings& settings);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  // Draws a frame and waits for it.
  PassTimes draw();
  // Of the last frame of all hosts that share its images: sRGB, 3 bytes a pixel.
  [[nodiscard]] std::vector<std::uint8_t> picture() const;
  // Fragments, layers and so on of the last frame; the library only.
  [[nodiscard]] VitrailStats stats() const;

 private:
  void makeBuffers();
  void makeStates();
  void makeShaders();
  void makeTarget();
  void makeStored();

  void drawOpaque();
  void drawTransparent();
  void store();
  void collect();
  void resolve();
  void drawGroups(bool transparent);
  void mark(std::size_t number);
  [[nodiscard]] bool byLibrary() const { return settings_.method >= Method::Fragment; }

  Settings settings_;
  Geometry geometry_;
  ID3D11DeviceContext* commands_;
  std::shared_ptr<const Images> images_;
  Com<ID3D11Buffer> vertices_, indices_, instances_, frame_;
  Com<ID3D11InputLayout> layout_;
  Com<ID3D11RasterizerState> frontFaces_, bothFaces_;
  Com<ID3D11DepthStencilState> depthWritten_, depthTested_, depthIgnored_;
  Com<ID3D11BlendState> straight_, premultiplied_, noColor_;
  ID3D11VertexShader* place_ = nullptr;
  ID3D11VertexShader* triangle_ = nullptr;
  ID3D11PixelShader* surface_ = nullptr;
  ID3D11PixelShader* sky_ = nullptr;
  ID3D11PixelShader* transparent_ = nullptr;
  ID3D11PixelShader* insertion_ = nullptr;
  Com<ID3D11Query> disjoint_;
  std::array<Com<ID3D11Query>, 4> times_;
  // The library's.
  VitrailD3d11Context context_ = nullptr;
  VitrailD3d11Target target_ = nullptr;
  std::string said_;
  // The other lists'.
  Com<ID3D11UnorderedAccessView> storedWritten_, headsWritten_;
  Com<ID3D11ShaderResourceView> storedRead_, headsRead_;
};

// Which of 1, 2, 4 and 8 samples the device has.
std::vector<std::uint32_t> sampleCounts();

} // namespace vitrail::tests::figures
