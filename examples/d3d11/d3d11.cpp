// A complete host with Direct3D 11 (d3d11 PICTURE.ppm): the cube of glass panes that examples/minimal draws with
// Vulkan, without a window. What concerns Vitrail is in glass.hlsl, in drawFrame() and in draw().
#include <d3d11.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <vitrail/d3d11.h>

#include "bytecode/floor_pixel.h"
#include "bytecode/floor_vertex.h"
#include "bytecode/glass_pixel.h"
#include "bytecode/glass_vertex.h"

namespace {
constexpr int kWidth = 1600, kHeight = 1200; // four pixels make one of the file

void check(bool well, const std::string& what) {
  if (!well) throw std::runtime_error(what);
}
void check(HRESULT result, const char* call) { check(SUCCEEDED(result), std::string(call) + " failed"); }

// What the host draws with. The process ends with it: nothing is released before.
struct Host {
  ID3D11Device* device = nullptr;
  ID3D11DeviceContext* commands = nullptr;
  ID3D11Texture2D* color = nullptr;
  ID3D11RenderTargetView* colorTarget = nullptr;
  ID3D11UnorderedAccessView* colorWritten = nullptr; // by the resolve
  ID3D11DepthStencilView* depth = nullptr;
  ID3D11DepthStencilState* depthWritten = nullptr;
  ID3D11DepthStencilState* depthTested = nullptr;
  ID3D11BlendState* noColor = nullptr;
  ID3D11RasterizerState* bothFaces = nullptr;
  ID3D11VertexShader *floorVertex = nullptr, *glassVertex = nullptr;
  ID3D11PixelShader *floorPixel = nullptr, *glassPixel = nullptr;
};

ID3D11Texture2D* createTexture(const Host& host, DXGI_FORMAT format, UINT bind) {
  D3D11_TEXTURE2D_DESC desc{};
  desc.Width = kWidth;
  desc.Height = kHeight;
  desc.MipLevels = 1;
  desc.ArraySize = 1;
  desc.Format = format;
  desc.SampleDesc.Count = 1;
  desc.BindFlags = bind;
  ID3D11Texture2D* texture = nullptr;
  check(host.device->CreateTexture2D(&desc, nullptr, &texture), "CreateTexture2D");
  return texture;
}

void createImages(Host& host) {
  host.color =
      createTexture(host, DXGI_FORMAT_R32G32B32A32_FLOAT, D3D11_BIND_RENDER_TARGET | D3D11_BIND_UNORDERED_ACCESS);
  check(host.device->CreateRenderTargetView(host.color, nullptr, &host.colorTarget), "CreateRenderTargetView");
  check(host.device->CreateUnorderedAccessView(host.color, nullptr, &host.colorWritten), "CreateUnorderedAccessView");
  ID3D11Texture2D* depth = createTexture(host, DXGI_FORMAT_D32_FLOAT, D3D11_BIND_DEPTH_STENCIL);
  check(host.device->CreateDepthStencilView(depth, nullptr, &host.depth), "CreateDepthStencilView");
}

void createStates(Host& host) {
  D3D11_DEPTH_STENCIL_DESC depth{};
  depth.DepthEnable = TRUE;
  depth.DepthFunc = D3D11_COMPARISON_LESS;
  depth.DepthWriteMask = D3D11_DEPTH_WRITE_MASK_ALL;
  check(host.device->CreateDepthStencilState(&depth, &host.depthWritten), "CreateDepthStencilState");
  depth.DepthWriteMask = D3D11_DEPTH_WRITE_MASK_ZERO;
  check(host.device->CreateDepthStencilState(&depth, &host.depthTested), "CreateDepthStencilState");
  D3D11_RASTERIZER_DESC raster{};
  raster.FillMode = D3D11_FILL_SOLID;
  raster.CullMode = D3D11_CULL_NONE;
  raster.DepthClipEnable = TRUE;
  check(host.device->CreateRasterizerState(&raster, &host.bothFaces), "CreateRasterizerState");
  const D3D11_BLEND_DESC none{}; // no channel is written
  check(host.device->CreateBlendState(&none, &host.noColor), "CreateBlendState");
}

template <size_t Bytes>
void create(const Host& host, const unsigned char (&code)[Bytes], ID3D11VertexShader** shader) {
  check(host.device->CreateVertexShader(code, Bytes, nullptr, shader), "CreateVertexShader");
}
template <size_t Bytes>
void create(const Host& host, const unsigned char (&code)[Bytes], ID3D11PixelShader** shader) {
  check(host.device->CreatePixelShader(code, Bytes, nullptr, shader), "CreatePixelShader");
}

Host createHost() {
  Host host;
  const D3D_FEATURE_LEVEL level = D3D_FEATURE_LEVEL_11_0;
  check(D3D11CreateDevice(nullptr, D3D_DRIVER_TYPE_HARDWARE, nullptr, 0, &level, 1, D3D11_SDK_VERSION, &host.device,
                          nullptr, &host.commands),
        "D3D11CreateDevice");
  createImages(host);
  createStates(host);
  create(host, example::bytecode::floor_vertex, &host.floorVertex);
  create(host, example::bytecode::floor_pixel, &host.floorPixel);
  create(host, example::bytecode::glass_vertex, &host.glassVertex);
  create(host, example::bytecode::glass_pixel, &host.glassPixel);
  return host;
}

void drawFrame(const Host& host, VitrailD3d11Target target) {
  ID3D11DeviceContext* commands = host.commands;
  const D3D11_VIEWPORT viewport{0, 0, kWidth, kHeight, 0, 1};
  const float horizon[] = {0.70F, 0.77F, 0.84F, 1.0F};
  commands->ClearRenderTargetView(host.colorTarget, horizon);
  commands->ClearDepthStencilView(host.depth, D3D11_CLEAR_DEPTH, 1.0F, 0);
  commands->IASetPrimitiveTopology(D3D11_PRIMITIVE_TOPOLOGY_TRIANGLESTRIP);
  commands->RSSetViewports(1, &viewport);
  commands->RSSetState(host.bothFaces);
  commands->OMSetRenderTargets(1, &host.colorTarget, host.depth);
  commands->OMSetDepthStencilState(host.depthWritten, 0);
  commands->VSSetShader(host.floorVertex, nullptr, 0);
  commands->PSSetShader(host.floorPixel, nullptr, 0);
  commands->Draw(4, 0);
  vitrailD3d11Begin(target, commands, nullptr);
  vitrailD3d11Bind(target, commands);
  commands->OMSetDepthStencilState(host.depthTested, 0);
  commands->OMSetBlendState(host.noColor, nullptr, 0xffffffff);
  commands->VSSetShader(host.glassVertex, nullptr, 0);
  commands->PSSetShader(host.glassPixel, nullptr, 0);
  commands->DrawInstanced(4, 9, 0, 0); // nine panes, in any order
  vitrailD3d11Collected(target, commands);
  commands->OMSetRenderTargets(0, nullptr, nullptr); // the resolve writes it
  vitrailD3d11Resolve(target, commands, nullptr);
  vitrailD3d11End(target, commands);
}

void save(const Host& host, const char* path) {
  D3D11_TEXTURE2D_DESC desc{};
  host.color->GetDesc(&desc);
  desc.Usage = D3D11_USAGE_STAGING;
  desc.BindFlags = 0;
  desc.CPUAccessFlags = D3D11_CPU_ACCESS_READ;
  ID3D11Texture2D* read = nullptr;
  check(host.device->CreateTexture2D(&desc, nullptr, &read), "CreateTexture2D");
  host.commands->CopyResource(read, host.color);
  D3D11_MAPPED_SUBRESOURCE mapped{};
  check(host.commands->Map(read, 0, D3D11_MAP_READ, 0, &mapped), "Map"); // which waits for the frame
  const size_t pitch = mapped.RowPitch / sizeof(float);
  std::ofstream file(path, std::ios::binary);
  file << "P6 " << kWidth / 2 << ' ' << kHeight / 2 << " 255\n";
  for (size_t y = 0; y < kHeight; y += 2) {
    for (size_t i = 0; i < kWidth / 2 * 3; ++i) {
      const float* p = static_cast<const float*>(mapped.pData) + y * pitch + 8 * (i / 3) + i % 3;
      const float mean = std::fmin((p[0] + p[4] + p[pitch] + p[pitch + 4]) / 4, 1.0F);
      const float curve = mean <= 0.0031308F ? 12.92F * mean : 1.055F * std::pow(mean, 1 / 2.4F) - 0.055F; // sRGB
      file.put(static_cast<char>(std::lround(255 * curve)));
    }
  }
  check(static_cast<bool>(file.flush()), std::string("cannot write ") + path);
}

void draw(const char* path) {
  const Host host = createHost();
  std::string reason;
  VitrailD3d11ContextDesc contextDesc{};
  contextDesc.device = host.device;
  contextDesc.log = [](VitrailLogSeverity, const char* text, void* user) { *static_cast<std::string*>(user) = text; };
  contextDesc.logUser = &reason;
  VitrailD3d11Context context = nullptr;
  check(vitrailD3d11CreateContext(&contextDesc, &context) == VITRAIL_SUCCESS, reason);
  VitrailD3d11TargetDesc desc{};
  desc.width = kWidth;
  desc.height = kHeight;
  desc.nodeCapacity = 8'000'000;
  desc.colorFormat = DXGI_FORMAT_R32G32B32A32_FLOAT;
  desc.views.count = 1;
  desc.views.color = &host.colorWritten;
  VitrailD3d11Target target = nullptr;
  check(vitrailD3d11CreateTarget(context, &desc, &target) == VITRAIL_SUCCESS, reason);
  drawFrame(host, target);
  save(host, path);
  VitrailStats stats{};
  while (vitrailD3d11ReadStats(target, 0, &stats) == VITRAIL_INCOMPLETE) Sleep(1); // others read it frames later
  check(stats.complete != 0, std::string("the node pool is too small"));
  vitrailD3d11DestroyTarget(target);
  vitrailD3d11DestroyContext(context);
}
} // namespace

int main(int argc, char** argv) {
  try {
    check(argc == 2, std::string("usage: d3d11 PICTURE.ppm"));
    draw(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "d3d11: error: %s\n", error.what());
    return 1;
  }
}
