#include "host.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "bytecode/figures_collect_1_1.h"
#include "bytecode/figures_collect_1_2.h"
#include "bytecode/figures_collect_2_1.h"
#include "bytecode/figures_collect_2_2.h"
#include "bytecode/figures_collect_4_1.h"
#include "bytecode/figures_collect_4_2.h"
#include "bytecode/figures_collect_8_1.h"
#include "bytecode/figures_collect_8_2.h"
#include "bytecode/figures_collect_whole.h"
#include "bytecode/figures_draw.h"
#include "bytecode/figures_insertion_1_16.h"
#include "bytecode/figures_insertion_1_32.h"
#include "bytecode/figures_insertion_1_8.h"
#include "bytecode/figures_insertion_n_16.h"
#include "bytecode/figures_insertion_n_32.h"
#include "bytecode/figures_insertion_n_8.h"
#include "bytecode/figures_place.h"
#include "bytecode/figures_sky.h"
#include "bytecode/figures_store.h"
#include "bytecode/figures_triangle.h"

namespace vitrail::tests::figures {

namespace {

using d3d11::check;

constexpr DXGI_FORMAT kColor = DXGI_FORMAT_R16G16B16A16_FLOAT;
constexpr std::uint32_t kFragments = 4'000'000; // that there is room for
constexpr std::uint32_t kStoredBytes = 20;      // StoredFragment of shaders/stored.hlsl
constexpr std::array<float, 4> kWhite = {1.0F, 1.0F, 1.0F, 1.0F};

ID3D11Device* on() { return d3d11::device().get(); }

Com<ID3D11Texture2D> makeTexture(const Settings& settings, DXGI_FORMAT format, std::uint32_t samples, UINT bind) {
  D3D11_TEXTURE2D_DESC desc{};
  desc.Width = settings.width;
  desc.Height = settings.height;
  desc.MipLevels = 1;
  desc.ArraySize = 1;
  desc.Format = format;
  desc.SampleDesc.Count = samples;
  desc.BindFlags = bind;
  Com<ID3D11Texture2D> texture;
  check(on()->CreateTexture2D(&desc, nullptr, texture.out()), "CreateTexture2D");
  return texture;
}

Picture makePicture(const Settings& settings, std::uint32_t samples) {
  Picture picture;
  const UINT written = samples == 1 ? UINT{D3D11_BIND_UNORDERED_ACCESS} : 0U;
  picture.texture =
      makeTexture(settings, kColor, samples, D3D11_BIND_RENDER_TARGET | D3D11_BIND_SHADER_RESOURCE | written);
  check(on()->CreateRenderTargetView(picture.texture.get(), nullptr, picture.target.out()), "CreateRenderTargetView");
  check(on()->CreateShaderResourceView(picture.texture.get(), nullptr, picture.read.out()), "CreateShaderResourceView");
  if (written != 0) {
    check(on()->CreateUnorderedAccessView(picture.texture.get(), nullptr, picture.written.out()),
          "CreateUnorderedAccessView");
  }
  return picture;
}

Images makeImages(const Settings& settings) {
  const bool several = settings.samples > 1;
  Images images;
  images.shown = makePicture(settings, 1);
  if (several) images.drawn = makePicture(settings, settings.samples);
  const Com<ID3D11Texture2D> depth = makeTexture(settings, DXGI_FORMAT_R32_TYPELESS, settings.samples,
                                                 D3D11_BIND_DEPTH_STENCIL | D3D11_BIND_SHADER_RESOURCE);
  D3D11_DEPTH_STENCIL_VIEW_DESC tested{};
  tested.Format = DXGI_FORMAT_D32_FLOAT;
  tested.ViewDimension = several ? D3D11_DSV_DIMENSION_TEXTURE2DMS : D3D11_DSV_DIMENSION_TEXTURE2D;
  check(on()->CreateDepthStencilView(depth.get(), &tested, images.depth.out()), "CreateDepthStencilView");
  D3D11_SHADER_RESOURCE_VIEW_DESC read{};
  read.Format = DXGI_FORMAT_R32_FLOAT;
  read.ViewDimension = several ? D3D11_SRV_DIMENSION_TEXTURE2DMS : D3D11_SRV_DIMENSION_TEXTURE2D;
  read.Texture2D.MipLevels = several ? 0 : 1;
  check(on()->CreateShaderResourceView(depth.get(), &read, images.depthRead.out()), "CreateShaderResourceView");
  return images;
}

std::shared_ptr<const Images> imagesFor(const Settings& settings) {
  static std::map<std::array<std::uint32_t, 3>, std::weak_ptr<const Images>> made;
  std::weak_ptr<const Images>& kept = made[{settings.width, settings.height, settings.samples}];
  std::shared_ptr<const Images> images = kept.lock();
  if (images == nullptr) kept = images = std::make_shared<const Images>(makeImages(settings));
  return images;
}

template <typename Value>
Com<ID3D11Buffer> makeBuffer(const std::vector<Value>& values, UINT bind) {
  return d3d11::device().makeBuffer(values.size() * sizeof(Value), bind, 0, values.data());
}

struct Bytes {
  const unsigned char* data;
  std::size_t size;
};
template <std::size_t Size>
constexpr Bytes bytesOf(const unsigned char (&code)[Size]) {
  return {code, Size};
}

// Shaders live as long as the program: wined3d knows pipelines by the handles of their shaders, and gives those of one
// that is gone to the next.
ID3D11PixelShader* pixelShader(Bytes code) {
  static std::map<const unsigned char*, Com<ID3D11PixelShader>> made;
  Com<ID3D11PixelShader>& shader = made[code.data];
  if (!shader) check(on()->CreatePixelShader(code.data, code.size, nullptr, shader.out()), "CreatePixelShader");
  return shader.get();
}

ID3D11VertexShader* vertexShader(Bytes code) {
  static std::map<const unsigned char*, Com<ID3D11VertexShader>> made;
  Com<ID3D11VertexShader>& shader = made[code.data];
  if (!shader) check(on()->CreateVertexShader(code.data, code.size, nullptr, shader.out()), "CreateVertexShader");
  return shader.get();
}

// What collects for a target with so many samples, by how its lists are built.
Bytes collectFor(const Settings& settings, VitrailListBuild build) {
  using namespace bytecode;
  if (settings.wholePixels) return bytesOf(figures_collect_whole);
  const bool loose = build == VITRAIL_LIST_BUILD_COMPUTE;
  switch (settings.samples) {
    case 1:
      return loose ? bytesOf(figures_collect_1_2) : bytesOf(figures_collect_1_1);
    case 2:
      return loose ? bytesOf(figures_collect_2_2) : bytesOf(figures_collect_2_1);
    case 4:
      return loose ? bytesOf(figures_collect_4_2) : bytesOf(figures_collect_4_1);
    default:
      return loose ? bytesOf(figures_collect_8_2) : bytesOf(figures_collect_8_1);
  }
}

// The resolve by insertion for so many layers.
Bytes insertionFor(const Settings& settings) {
  const bool one = settings.samples == 1;
  switch (settings.layers) {
    case 8:
      return one ? bytesOf(bytecode::figures_insertion_1_8) : bytesOf(bytecode::figures_insertion_n_8);
    case 16:
      return one ? bytesOf(bytecode::figures_insertion_1_16) : bytesOf(bytecode::figures_insertion_n_16);
    case 32:
      return one ? bytesOf(bytecode::figures_insertion_1_32) : bytesOf(bytecode::figures_insertion_n_32);
    default:
      throw HostError("insertion sorts 8, 16 or 32 layers, not " + std::to_string(settings.layers));
  }
}

Com<ID3D11BlendState> makeBlend(D3D11_BLEND source, UINT8 channels) {
  D3D11_BLEND_DESC desc{};
  D3D11_RENDER_TARGET_BLEND_DESC& target = desc.RenderTarget[0];
  target.BlendEnable = channels != 0 ? TRUE : FALSE;
  target.SrcBlend = source;
  target.DestBlend = D3D11_BLEND_INV_SRC_ALPHA;
  target.BlendOp = D3D11_BLEND_OP_ADD;
  target.SrcBlendAlpha = D3D11_BLEND_ONE;
  target.DestBlendAlpha = D3D11_BLEND_INV_SRC_ALPHA;
  target.BlendOpAlpha = D3D11_BLEND_OP_ADD;
  target.RenderTargetWriteMask = channels;
  Com<ID3D11BlendState> state;
  check(on()->CreateBlendState(&desc, state.out()), "CreateBlendState");
  return state;
}

Com<ID3D11DepthStencilState> makeDepth(bool tested, bool written) {
  D3D11_DEPTH_STENCIL_DESC desc{};
  desc.DepthEnable = tested ? TRUE : FALSE;
  desc.DepthWriteMask = written ? D3D11_DEPTH_WRITE_MASK_ALL : D3D11_DEPTH_WRITE_MASK_ZERO;
  desc.DepthFunc = D3D11_COMPARISON_GREATER_EQUAL; // 1 is the nearest
  Com<ID3D11DepthStencilState> state;
  check(on()->CreateDepthStencilState(&desc, state.out()), "CreateDepthStencilState");
  return state;
}

Com<ID3D11RasterizerState> makeRaster(D3D11_CULL_MODE cull, bool several) {
  D3D11_RASTERIZER_DESC desc{};
  desc.FillMode = D3D11_FILL_SOLID;
  desc.CullMode = cull;
  desc.FrontCounterClockwise = TRUE;
  desc.DepthClipEnable = TRUE;
  desc.MultisampleEnable = several ? TRUE : FALSE;
  Com<ID3D11RasterizerState> state;
  check(on()->CreateRasterizerState(&desc, state.out()), "CreateRasterizerState");
  return state;
}

Com<ID3D11Query> makeQuery(D3D11_QUERY kind) {
  const D3D11_QUERY_DESC desc{kind, 0};
  Com<ID3D11Query> query;
  check(on()->CreateQuery(&desc, query.out()), "CreateQuery");
  return query;
}

template <typename Value>
Value answerOf(ID3D11DeviceContext* commands, ID3D11Query* query) {
  Value value{};
  HRESULT result = S_FALSE;
  while ((result = commands->GetData(query, &value, sizeof(value), 0)) == S_FALSE) Sleep(0);
  check(result, "GetData");
  return value;
}

float halfToFloat(std::uint16_t half) {
  const int exponent = half >> 10 & 31;
  const int mantissa = half & 1023;
  const float size = exponent == 0 ? std::ldexp(static_cast<float>(mantissa), -24)
                                   : std::ldexp(static_cast<float>(1024 + mantissa), exponent - 25);
  return (half & 0x8000U) != 0 ? -size : size;
}

std::uint8_t encoded(float linear) {
  const float value = std::fmin(std::fmax(linear, 0.0F), 1.0F);
  const float curve = value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1 / 2.4F) - 0.055F; // sRGB
  return static_cast<std::uint8_t>(std::lround(255 * curve));
}

} // namespace

// ---- What is made once

Host::Host(const Settings& settings)
    : settings_(settings),
      geometry_(makeGeometry(settings.scene, settings.width, settings.height)),
      commands_(d3d11::device().immediate()),
      images_(imagesFor(settings)) {
  makeBuffers();
  makeStates();
  makeShaders();
  if (byLibrary()) makeTarget();
  if (settings.method == Method::Insertion) makeStored();
  disjoint_ = makeQuery(D3D11_QUERY_TIMESTAMP_DISJOINT);
  for (auto& time : times_) time = makeQuery(D3D11_QUERY_TIMESTAMP);
}

Host::~Host() {
  vitrailD3d11DestroyTarget(target_);
  vitrailD3d11DestroyContext(context_);
}

void Host::makeBuffers() {
  vertices_ = makeBuffer(geometry_.vertices, D3D11_BIND_VERTEX_BUFFER);
  indices_ = makeBuffer(geometry_.indices, D3D11_BIND_INDEX_BUFFER);
  instances_ = makeBuffer(geometry_.instances, D3D11_BIND_VERTEX_BUFFER);
  frame_ = d3d11::device().makeBuffer(sizeof(geometry_.frame), D3D11_BIND_CONSTANT_BUFFER, 0, &geometry_.frame);
}

void Host::makeStates() {
  const bool several = settings_.samples > 1;
  frontFaces_ = makeRaster(D3D11_CULL_BACK, several);
  bothFaces_ = makeRaster(D3D11_CULL_NONE, several);
  depthWritten_ = makeDepth(true, true);
  depthTested_ = makeDepth(true, false);
  depthIgnored_ = makeDepth(false, false);
  straight_ = makeBlend(D3D11_BLEND_SRC_ALPHA, D3D11_COLOR_WRITE_ENABLE_ALL);
  premultiplied_ = makeBlend(D3D11_BLEND_ONE, D3D11_COLOR_WRITE_ENABLE_ALL);
  noColor_ = makeBlend(D3D11_BLEND_ONE, 0);
}

void Host::makeShaders() {
  constexpr Bytes kPlace = bytesOf(bytecode::figures_place);
  place_ = vertexShader(kPlace);
  triangle_ = vertexShader(bytesOf(bytecode::figures_triangle));
  surface_ = pixelShader(bytesOf(bytecode::figures_draw));
  sky_ = pixelShader(bytesOf(bytecode::figures_sky));
  if (settings_.method == Method::Unsorted) transparent_ = pixelShader(bytesOf(bytecode::figures_draw));
  if (settings_.method == Method::Insertion) transparent_ = pixelShader(bytesOf(bytecode::figures_store));
  constexpr D3D11_INPUT_CLASSIFICATION kEach = D3D11_INPUT_PER_INSTANCE_DATA;
  constexpr std::array<D3D11_INPUT_ELEMENT_DESC, 7> kLayout = {{
      {"POSITION", 0, DXGI_FORMAT_R32G32B32_FLOAT, 0, offsetof(Vertex, position), D3D11_INPUT_PER_VERTEX_DATA, 0},
      {"NORMAL", 0, DXGI_FORMAT_R32G32B32_FLOAT, 0, offsetof(Vertex, normal), D3D11_INPUT_PER_VERTEX_DATA, 0},
      {"ROW", 0, DXGI_FORMAT_R32G32B32A32_FLOAT, 1, 0, kEach, 1},
      {"ROW", 1, DXGI_FORMAT_R32G32B32A32_FLOAT, 1, 16, kEach, 1},
      {"ROW", 2, DXGI_FORMAT_R32G32B32A32_FLOAT, 1, 32, kEach, 1},
      {"COLOR", 0, DXGI_FORMAT_R32G32B32A32_FLOAT, 1, offsetof(Instance, color), kEach, 1},
      {"ROUGHNESS", 0, DXGI_FORMAT_R32_FLOAT, 1, offsetof(Instance, roughness), kEach, 1},
  }};
  check(on()->CreateInputLayout(kLayout.data(), kLayout.size(), kPlace.data, kPlace.size, layout_.out()),
        "CreateInputLayout");
}

void Host::makeTarget() {
  VitrailD3d11ContextDesc contextDesc{};
  contextDesc.device = on();
  contextDesc.log = [](VitrailLogSeverity, const char* text, void* user) { *static_cast<std::string*>(user) = text; };
  contextDesc.logUser = &said_;
  if (vitrailD3d11CreateContext(&contextDesc, &context_) != VITRAIL_SUCCESS) throw HostError(said_);
  ID3D11UnorderedAccessView* const color = images_->shown.written.get();
  ID3D11ShaderResourceView* const opaque = images_->drawn.read.get();
  ID3D11ShaderResourceView* const depth = images_->depthRead.get();
  const bool compute = settings_.method == Method::Compute;
  VitrailD3d11TargetDesc desc{};
  desc.width = settings_.width;
  desc.height = settings_.height;
  desc.samples = settings_.samples;
  desc.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
  desc.resolve = compute ? VITRAIL_RESOLVE_COMPUTE : VITRAIL_RESOLVE_FRAGMENT;
  desc.msaaResolve = compute ? VITRAIL_MSAA_RESOLVE_PER_PIXEL : VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  desc.maxLayers = settings_.layers;
  desc.nodeFormat = VITRAIL_NODE_HDR;
  desc.overflow = VITRAIL_OVERFLOW_SKIP; // there is room for all
  desc.nodeCapacity = kFragments;
  if (compute || settings_.samples > 1) desc.views.count = 1;
  if (compute) desc.views.color = &color;
  if (compute && settings_.samples > 1) desc.views.opaque = &opaque;
  if (settings_.samples > 1) desc.views.depth = &depth;
  if (vitrailD3d11CreateTarget(context_, &desc, &target_) != VITRAIL_SUCCESS) throw HostError(said_);
  transparent_ = pixelShader(collectFor(settings_, vitrailD3d11TargetListBuild(target_)));
}

void Host::makeStored() {
  insertion_ = pixelShader(insertionFor(settings_));
  D3D11_BUFFER_DESC desc{};
  desc.ByteWidth = kFragments * kStoredBytes;
  desc.BindFlags = D3D11_BIND_UNORDERED_ACCESS | D3D11_BIND_SHADER_RESOURCE;
  desc.MiscFlags = D3D11_RESOURCE_MISC_BUFFER_STRUCTURED;
  desc.StructureByteStride = kStoredBytes;
  Com<ID3D11Buffer> stored;
  check(on()->CreateBuffer(&desc, nullptr, stored.out()), "CreateBuffer");
  D3D11_UNORDERED_ACCESS_VIEW_DESC counted{};
  counted.ViewDimension = D3D11_UAV_DIMENSION_BUFFER;
  counted.Buffer.NumElements = kFragments;
  counted.Buffer.Flags = D3D11_BUFFER_UAV_FLAG_COUNTER;
  check(on()->CreateUnorderedAccessView(stored.get(), &counted, storedWritten_.out()), "CreateUnorderedAccessView");
  check(on()->CreateShaderResourceView(stored.get(), nullptr, storedRead_.out()), "CreateShaderResourceView");
  const Com<ID3D11Texture2D> heads =
      makeTexture(settings_, DXGI_FORMAT_R32_UINT, 1, D3D11_BIND_UNORDERED_ACCESS | D3D11_BIND_SHADER_RESOURCE);
  check(on()->CreateUnorderedAccessView(heads.get(), nullptr, headsWritten_.out()), "CreateUnorderedAccessView");
  check(on()->CreateShaderResourceView(heads.get(), nullptr, headsRead_.out()), "CreateShaderResourceView");
}

// ---- A frame

PassTimes Host::draw() {
  commands_->Begin(disjoint_.get());
  mark(0);
  drawOpaque();
  mark(1);
  drawTransparent();
  mark(2);
  resolve();
  mark(3);
  commands_->End(disjoint_.get());
  const auto clock = answerOf<D3D11_QUERY_DATA_TIMESTAMP_DISJOINT>(commands_, disjoint_.get());
  std::array<std::uint64_t, 4> at{};
  for (std::size_t i = 0; i < at.size(); ++i) at.at(i) = answerOf<std::uint64_t>(commands_, times_.at(i).get());
  PassTimes times{};
  for (std::size_t i = 0; i < 3; ++i) {
    times.milliseconds.at(i) =
        1e3 * static_cast<double>(at.at(i + 1) - at.at(i)) / static_cast<double>(clock.Frequency);
  }
  return times;
}

void Host::mark(std::size_t number) { commands_->End(times_.at(number).get()); }

void Host::drawGroups(bool transparent) {
  const std::array<ID3D11Buffer*, 2> buffers = {vertices_.get(), instances_.get()};
  constexpr std::array<UINT, 2> kStrides = {sizeof(Vertex), sizeof(Instance)};
  constexpr std::array<UINT, 2> kOffsets{};
  commands_->IASetInputLayout(layout_.get());
  commands_->IASetVertexBuffers(0, buffers.size(), buffers.data(), kStrides.data(), kOffsets.data());
  commands_->IASetIndexBuffer(indices_.get(), DXGI_FORMAT_R32_UINT, 0);
  commands_->VSSetShader(place_, nullptr, 0);
  for (const Group& group : geometry_.groups) {
    if (group.transparent != transparent) continue;
    commands_->DrawIndexedInstanced(group.indices, group.instances, group.firstIndex, group.firstVertex,
                                    group.firstInstance);
  }
}

void Host::drawOpaque() {
  const D3D11_VIEWPORT viewport{0, 0, static_cast<float>(settings_.width), static_cast<float>(settings_.height), 0, 1};
  const Picture& picture = settings_.samples > 1 ? images_->drawn : images_->shown;
  ID3D11RenderTargetView* const target = picture.target.get();
  ID3D11Buffer* const constants = frame_.get();
  commands_->ClearState();
  commands_->ClearRenderTargetView(target, kWhite.data());
  commands_->ClearDepthStencilView(images_->depth.get(), D3D11_CLEAR_DEPTH, 0.0F, 0);
  commands_->RSSetViewports(1, &viewport);
  commands_->IASetPrimitiveTopology(D3D11_PRIMITIVE_TOPOLOGY_TRIANGLELIST);
  commands_->VSSetConstantBuffers(0, 1, &constants);
  commands_->PSSetConstantBuffers(0, 1, &constants);
  commands_->OMSetRenderTargets(1, &target, images_->depth.get());
  commands_->RSSetState(bothFaces_.get());
  if (geometry_.sky) {
    commands_->OMSetDepthStencilState(depthIgnored_.get(), 0);
    commands_->VSSetShader(triangle_, nullptr, 0);
    commands_->PSSetShader(sky_, nullptr, 0);
    commands_->Draw(3, 0);
  }
  commands_->OMSetDepthStencilState(depthWritten_.get(), 0);
  commands_->PSSetShader(surface_, nullptr, 0);
  drawGroups(false);
  commands_->OMSetDepthStencilState(depthTested_.get(), 0);
}

void Host::drawTransparent() {
  if (byLibrary()) return collect();
  if (settings_.method == Method::Insertion) return store();
  commands_->OMSetBlendState(straight_.get(), nullptr, 0xffffffffU);
  commands_->PSSetShader(transparent_, nullptr, 0);
  drawGroups(true);
}

void Host::store() {
  constexpr std::array<UINT, 4> kEnd = {0xffffffffU, 0xffffffffU, 0xffffffffU, 0xffffffffU};
  constexpr std::array<UINT, 2> kCounts{};
  const std::array<ID3D11UnorderedAccessView*, 2> written = {storedWritten_.get(), headsWritten_.get()};
  commands_->ClearUnorderedAccessViewUint(headsWritten_.get(), kEnd.data());
  commands_->OMSetRenderTargetsAndUnorderedAccessViews(D3D11_KEEP_RENDER_TARGETS_AND_DEPTH_STENCIL, nullptr, nullptr, 1,
                                                       written.size(), written.data(), kCounts.data());
  commands_->OMSetBlendState(noColor_.get(), nullptr, 0xffffffffU);
  commands_->PSSetShader(transparent_, nullptr, 0);
  drawGroups(true);
}

void Host::collect() {
  vitrailD3d11Begin(target_, commands_, nullptr);
  vitrailD3d11Bind(target_, commands_);
  commands_->OMSetBlendState(noColor_.get(), nullptr, 0xffffffffU);
  commands_->PSSetShader(transparent_, nullptr, 0);
  drawGroups(true);
  vitrailD3d11Collected(target_, commands_);
}

void Host::resolve() {
  const Picture& picture = settings_.samples > 1 ? images_->drawn : images_->shown;
  ID3D11RenderTargetView* const target = picture.target.get();
  commands_->OMSetRenderTargets(1, &target, nullptr);
  if (settings_.method == Method::Insertion) {
    const std::array<ID3D11ShaderResourceView*, 2> read = {storedRead_.get(), headsRead_.get()};
    commands_->OMSetBlendState(premultiplied_.get(), nullptr, 0xffffffffU);
    commands_->OMSetDepthStencilState(depthIgnored_.get(), 0);
    commands_->PSSetShaderResources(0, read.size(), read.data());
    commands_->IASetInputLayout(nullptr);
    commands_->VSSetShader(triangle_, nullptr, 0);
    commands_->PSSetShader(insertion_, nullptr, 0);
    commands_->Draw(3, 0);
  }
  if (settings_.method == Method::Compute) commands_->OMSetRenderTargets(0, nullptr, nullptr); // the resolve writes it
  if (byLibrary()) {
    vitrailD3d11Resolve(target_, commands_, nullptr);
    vitrailD3d11End(target_, commands_);
  }
  commands_->ClearState();
  if (settings_.samples > 1 && settings_.method != Method::Compute) {
    commands_->ResolveSubresource(images_->shown.texture.get(), 0, images_->drawn.texture.get(), 0, kColor);
  }
}

// ---- What came of it

std::vector<std::uint8_t> Host::picture() const {
  D3D11_TEXTURE2D_DESC desc{};
  images_->shown.texture->GetDesc(&desc);
  desc.Usage = D3D11_USAGE_STAGING;
  desc.BindFlags = 0;
  desc.CPUAccessFlags = D3D11_CPU_ACCESS_READ;
  Com<ID3D11Texture2D> staging;
  check(on()->CreateTexture2D(&desc, nullptr, staging.out()), "CreateTexture2D");
  commands_->CopyResource(staging.get(), images_->shown.texture.get());
  D3D11_MAPPED_SUBRESOURCE mapped{};
  check(commands_->Map(staging.get(), 0, D3D11_MAP_READ, 0, &mapped), "Map");
  std::vector<std::uint8_t> bytes;
  for (std::uint32_t y = 0; y < settings_.height; ++y) {
    const auto* row = static_cast<const std::byte*>(mapped.pData) + std::size_t{y} * mapped.RowPitch;
    for (std::uint32_t x = 0; x < settings_.width; ++x) {
      std::array<std::uint16_t, 4> color{};
      std::memcpy(color.data(), row + x * sizeof(color), sizeof(color));
      for (std::size_t c = 0; c < 3; ++c) bytes.push_back(encoded(halfToFloat(color.at(c))));
    }
  }
  commands_->Unmap(staging.get(), 0);
  return bytes;
}

VitrailStats Host::stats() const {
  VitrailStats stats{};
  while (vitrailD3d11ReadStats(target_, vitrailD3d11TargetFrame(target_), &stats) == VITRAIL_INCOMPLETE) Sleep(1);
  return stats;
}

std::vector<std::uint32_t> sampleCounts() {
  std::vector<std::uint32_t> counts;
  for (const std::uint32_t samples : {1U, 2U, 4U, 8U}) {
    UINT color = 0;
    UINT depth = 0;
    const bool answered = SUCCEEDED(on()->CheckMultisampleQualityLevels(kColor, samples, &color)) &&
                          SUCCEEDED(on()->CheckMultisampleQualityLevels(DXGI_FORMAT_D32_FLOAT, samples, &depth));
    if (answered && color > 0 && depth > 0) counts.push_back(samples);
  }
  return counts;
}

} // namespace vitrail::tests::figures
