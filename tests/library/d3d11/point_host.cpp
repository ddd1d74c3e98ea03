#include "point_host.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

namespace vitrail::tests::d3d11 {

namespace {

struct Vertex {
  std::array<float, 3> position;
  std::array<float, 4> color;
  std::uint32_t blend;
  std::uint32_t word;
};

// The clip-space vertex whose point covers the pixel's centre.
Vertex toVertex(const Point& point, const HostDesc& desc) {
  const auto clip = [](std::uint32_t pixel, std::uint32_t size) {
    return (static_cast<float>(pixel) + 0.5F) * 2.0F / static_cast<float>(size) - 1.0F;
  };
  return {{clip(point.x, desc.width), -clip(point.y, desc.height), point.depth}, point.color, point.blend, point.word};
}

bool severalSamples(const HostDesc& desc) { return desc.samples > 1; }
bool perPixel(const HostDesc& desc) {
  return severalSamples(desc) && desc.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_PIXEL;
}
bool perSample(const HostDesc& desc) { return severalSamples(desc) && !perPixel(desc); }
DXGI_FORMAT colorFormat(const HostDesc& desc) {
  return desc.colorFormat == ColorFormat::Float16 ? DXGI_FORMAT_R16G16B16A16_FLOAT : DXGI_FORMAT_R32G32B32A32_FLOAT;
}
float farthest(const HostDesc& desc) { return desc.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? 0.0F : 1.0F; }
ID3D11Device* on() { return device().get(); }

Com<ID3D11Texture2D> makeTexture(const HostDesc& desc, DXGI_FORMAT format, std::uint32_t samples, UINT bind) {
  D3D11_TEXTURE2D_DESC texture{};
  texture.Width = desc.width;
  texture.Height = desc.height;
  texture.MipLevels = 1;
  texture.ArraySize = 1;
  texture.Format = format;
  texture.SampleDesc.Count = samples;
  texture.BindFlags = bind;
  Com<ID3D11Texture2D> made;
  check(on()->CreateTexture2D(&texture, nullptr, made.out()), "CreateTexture2D");
  return made;
}

// What the library copied out.
void decodeCopy(const std::vector<std::byte>& copy, std::uint32_t pixels, ListsRead& read) {
  VitrailD3d11CopyHeader header{};
  std::memcpy(&header, copy.data(), sizeof(header));
  read.layers = header.layers;
  std::vector<VitrailD3d11CopiedList> lists(pixels);
  std::memcpy(lists.data(), copy.data() + sizeof(header), pixels * sizeof(VitrailD3d11CopiedList));
  const std::byte* layers = copy.data() + sizeof(header) + pixels * sizeof(VitrailD3d11CopiedList);
  for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const VitrailD3d11CopiedList& list = lists[pixel];
    if (list.count == 0) read.pixels[pixel].emplace();
    if (list.count == 0 || list.first == 0xffffffffU) continue;
    std::vector<VitrailLayer>& copied = read.pixels[pixel].emplace(list.count);
    std::memcpy(copied.data(), layers + list.first * sizeof(VitrailLayer), list.count * sizeof(VitrailLayer));
  }
}

// What the walker wrote down.
void decodeWalk(const std::vector<std::byte>& walked, ListsRead& read) {
  constexpr std::size_t kWords = 2 + 8 * std::size_t{PointHost::kMostWalked};
  for (std::size_t pixel = 0; pixel < read.pixels.size(); ++pixel) {
    std::array<std::uint32_t, 2> head{};
    const std::byte* at = walked.data() + pixel * kWords * sizeof(std::uint32_t);
    std::memcpy(head.data(), at, sizeof(head));
    if (head[1] != 0) continue;
    std::vector<VitrailLayer>& layers = read.pixels[pixel].emplace(std::min(head[0], PointHost::kMostWalked));
    std::memcpy(layers.data(), at + sizeof(head), layers.size() * sizeof(VitrailLayer));
  }
}

// The parts of a target's memory, by VitrailD3d11BufferKind.
constexpr std::array<StoragePart StorageLayout::*, VITRAIL_D3D11_BUFFERS> kParts = {
    &StorageLayout::control,     &StorageLayout::heads,     &StorageLayout::nodes, &StorageLayout::sums,
    &StorageLayout::mediumLists, &StorageLayout::longLists, &StorageLayout::copy};

} // namespace

// ---- Textures

PointTextures::PointTextures(const HostDesc& desc) {
  color = makeTexture(desc, colorFormat(desc), 1,
                      D3D11_BIND_RENDER_TARGET | D3D11_BIND_UNORDERED_ACCESS | D3D11_BIND_SHADER_RESOURCE);
  check(on()->CreateRenderTargetView(color.get(), nullptr, colorTarget.out()), "CreateRenderTargetView");
  check(on()->CreateUnorderedAccessView(color.get(), nullptr, colorWritten.out()), "CreateUnorderedAccessView");
  if (severalSamples(desc)) {
    multisampled =
        makeTexture(desc, colorFormat(desc), desc.samples, D3D11_BIND_RENDER_TARGET | D3D11_BIND_SHADER_RESOURCE);
    check(on()->CreateRenderTargetView(multisampled.get(), nullptr, multisampledTarget.out()), "a render target view");
    check(on()->CreateShaderResourceView(multisampled.get(), nullptr, multisampledRead.out()), "a view to read");
  }
  if (!desc.stencilMark && !severalSamples(desc) && desc.opaqueDepth.empty()) return;
  const bool stencil = desc.stencilMark;
  depth = makeTexture(desc, stencil ? DXGI_FORMAT_R32G8X24_TYPELESS : DXGI_FORMAT_R32_TYPELESS, desc.samples,
                      D3D11_BIND_DEPTH_STENCIL | D3D11_BIND_SHADER_RESOURCE);
  D3D11_DEPTH_STENCIL_VIEW_DESC target{};
  target.Format = stencil ? DXGI_FORMAT_D32_FLOAT_S8X24_UINT : DXGI_FORMAT_D32_FLOAT;
  target.ViewDimension = severalSamples(desc) ? D3D11_DSV_DIMENSION_TEXTURE2DMS : D3D11_DSV_DIMENSION_TEXTURE2D;
  check(on()->CreateDepthStencilView(depth.get(), &target, depthTarget.out()), "CreateDepthStencilView");
  target.Flags = D3D11_DSV_READ_ONLY_DEPTH | (stencil ? UINT{D3D11_DSV_READ_ONLY_STENCIL} : 0U);
  check(on()->CreateDepthStencilView(depth.get(), &target, depthTested.out()), "CreateDepthStencilView");
  D3D11_SHADER_RESOURCE_VIEW_DESC seen{};
  seen.Format = stencil ? DXGI_FORMAT_R32_FLOAT_X8X24_TYPELESS : DXGI_FORMAT_R32_FLOAT;
  seen.ViewDimension = severalSamples(desc) ? D3D11_SRV_DIMENSION_TEXTURE2DMS : D3D11_SRV_DIMENSION_TEXTURE2D;
  seen.Texture2D.MipLevels = severalSamples(desc) ? 0 : 1;
  check(on()->CreateShaderResourceView(depth.get(), &seen, depthRead.out()), "CreateShaderResourceView");
}

// ---- The host

D3d11Host::D3d11Host(D3d11Backend& backend, const HostDesc& desc, bool deferred)
    : backend_(backend), desc_(desc), deferred_(deferred) {
  makeTextures();
  VitrailD3d11TargetDesc target = targetDesc();
  if (desc.guarded) guard(target);
  const VitrailResult result = vitrailD3d11CreateTarget(backend.context(), &target, &target_);
  if (result != VITRAIL_SUCCESS) {
    std::string reason = "vitrailD3d11CreateTarget: VitrailResult " + std::to_string(result);
    for (const LogLine& line : backend.takeLog()) reason += ": " + line.text;
    throw HostError(reason);
  }
  points_ = shaderFor(target, desc.specialized);
  if (desc.strangersFor) {
    target.overflow = *desc.strangersFor;
    strangers_ = shaderFor(target, true);
  }
  makeStates();
}

D3d11Host::~D3d11Host() { vitrailD3d11DestroyTarget(target_); }

void D3d11Host::makeTextures() {
  for (std::size_t i = 0; i < textures_.size(); ++i) {
    textures_[i] = PointTextures(desc_);
    colorViews_[i] = textures_[i].colorWritten.get();
    opaqueViews_[i] = textures_[i].multisampledRead.get();
    depthViews_[i] = textures_[i].depthRead.get();
  }
}

VitrailD3d11Views D3d11Host::views() {
  VitrailD3d11Views views{};
  if (desc_.resolve == VITRAIL_RESOLVE_HOST) return views;
  if (desc_.resolve != VITRAIL_RESOLVE_FRAGMENT) views.color = colorViews_.data();
  if (perPixel(desc_)) views.opaque = opaqueViews_.data();
  if (severalSamples(desc_)) views.depth = depthViews_.data();
  const bool any = views.color != nullptr || views.opaque != nullptr || views.depth != nullptr;
  views.count = any ? kFramesTogether : 0;
  return views;
}

VitrailD3d11TargetDesc D3d11Host::targetDesc() {
  VitrailD3d11TargetDesc desc{};
  desc.width = desc_.width;
  desc.height = desc_.height;
  desc.samples = desc_.samples;
  desc.nodeFormat = desc_.nodes;
  desc.depthOrder = desc_.depthOrder;
  desc.resolve = desc_.resolve;
  desc.msaaResolve = desc_.msaaResolve;
  desc.maxLayers = desc_.maxLayers;
  desc.overflow = desc_.overflow;
  desc.listBuild = desc_.listBuild;
  desc.nodeCapacity = desc_.capacity;
  desc.memoryBudget = desc_.memoryBudget;
  desc.areaPixels = desc_.areaPixels;
  desc.userWords = desc_.userWords ? 1 : 0;
  desc.copyLayers = desc_.copyLayers;
  desc.colorFormat = colorFormat(desc_);
  desc.views = views();
  desc.severalRenderTargets = desc_.dualSourceBlending ? 0 : 1;
  desc.stencilMark = desc_.stencilMark && !perPixel(desc_) ? 1 : 0;
  desc.debugName = "points";
  return desc;
}

// Makes the target's memory, before guard words and full of them.
void D3d11Host::guard(VitrailD3d11TargetDesc& desc) {
  VitrailD3d11Requirements needs{};
  if (vitrailD3d11TargetRequirements(backend_.context(), &desc, &needs) != VITRAIL_SUCCESS) {
    throw HostError("vitrailD3d11TargetRequirements");
  }
  storage_ = layoutOf(desc_, 16);
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    sizes_.at(i) = needs.sizes[i];
    const std::vector<std::uint32_t> words(needs.sizes[i] / sizeof(std::uint32_t) + kGuardWords, kGuard);
    memory_.at(i) = device().makeBuffer(words.size() * sizeof(std::uint32_t),
                                        D3D11_BIND_UNORDERED_ACCESS | D3D11_BIND_SHADER_RESOURCE,
                                        D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS, words.data());
    memoryPointers_.at(i) = memory_.at(i).get();
  }
  desc.buffers = memoryPointers_.data();
}

// The shader of points for a target, or for what HostDesc says in its place.
ID3D11PixelShader* D3d11Host::shaderFor(const VitrailD3d11TargetDesc& target, bool specialized) {
  if (desc_.shader == ShaderKind::Narrow && !specialized) {
    return backend_.pixelShader("points", {"VITRAIL_ONLY_FORMAT=0", "VITRAIL_ONLY_SAMPLES=1", "VITRAIL_ONLY_OVERFLOW=1",
                                           "VITRAIL_ONLY_LIST_BUILD=1", "VITRAIL_ONLY_USER_WORDS=0"});
  }
  if (!specialized) return backend_.pixelShader("points");
  const VitrailNodeFormat format = desc_.specializedFor.value_or(target.nodeFormat);
  VitrailOverflow overflow = desc_.specializedForOverflow.value_or(target.overflow);
  if (desc_.resolve == VITRAIL_RESOLVE_HOST) overflow = VITRAIL_OVERFLOW_SKIP; // nothing is summed
  const VitrailListBuild build = desc_.specializedForListBuild.value_or(vitrailD3d11TargetListBuild(target_));
  return backend_.pixelShader(
      "points",
      {"VITRAIL_ONLY_FORMAT=" + std::to_string(format), "VITRAIL_ONLY_SAMPLES=" + std::to_string(target.samples),
       "VITRAIL_ONLY_OVERFLOW=" + std::to_string(overflow), "VITRAIL_ONLY_LIST_BUILD=" + std::to_string(build),
       "VITRAIL_ONLY_USER_WORDS=" + std::to_string(target.userWords)});
}

void D3d11Host::makeStates() {
  const D3D11_BLEND_DESC none{}; // no channel is written
  check(on()->CreateBlendState(&none, noColor_.out()), "CreateBlendState");
  D3D11_DEPTH_STENCIL_DESC test{};
  test.DepthEnable = textures_[0].depth ? TRUE : FALSE;
  test.DepthWriteMask = D3D11_DEPTH_WRITE_MASK_ZERO;
  test.DepthFunc =
      desc_.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? D3D11_COMPARISON_GREATER_EQUAL : D3D11_COMPARISON_LESS_EQUAL;
  test.StencilEnable = desc_.stencilMark ? TRUE : FALSE;
  test.StencilReadMask = 0xff;
  test.StencilWriteMask = 0xff;
  test.FrontFace = {D3D11_STENCIL_OP_KEEP, D3D11_STENCIL_OP_KEEP, D3D11_STENCIL_OP_INCR_SAT, D3D11_COMPARISON_ALWAYS};
  test.BackFace = test.FrontFace;
  check(on()->CreateDepthStencilState(&test, collecting_.out()), "CreateDepthStencilState");
  test.DepthWriteMask = D3D11_DEPTH_WRITE_MASK_ALL;
  test.DepthFunc = D3D11_COMPARISON_ALWAYS;
  test.StencilEnable = FALSE;
  check(on()->CreateDepthStencilState(&test, writing_.out()), "CreateDepthStencilState");
  D3D11_RASTERIZER_DESC raster{};
  raster.FillMode = D3D11_FILL_SOLID;
  raster.CullMode = D3D11_CULL_NONE;
  raster.DepthClipEnable = TRUE;
  raster.MultisampleEnable = severalSamples(desc_) ? TRUE : FALSE;
  check(on()->CreateRasterizerState(&raster, rasterizing_.out()), "CreateRasterizerState");
}

// ---- Frames

void D3d11Host::drawOpaque(ID3D11DeviceContext* commands, PointTextures& textures) {
  if (perPixel(desc_)) commands->ClearRenderTargetView(textures.colorTarget.get(), desc_.beforeResolve.data());
  commands->ClearRenderTargetView(textures.shown(), desc_.behind.data());
  if (textures.depth) {
    commands->ClearDepthStencilView(textures.depthTarget.get(),
                                    D3D11_CLEAR_DEPTH | (desc_.stencilMark ? UINT{D3D11_CLEAR_STENCIL} : 0U),
                                    farthest(desc_), 0);
  }
  if (desc_.behindSamples.empty() && desc_.opaqueDepth.empty()) return;
  ID3D11RenderTargetView* const target = textures.shown();
  const D3D11_VIEWPORT viewport{0.0F, 0.0F, static_cast<float>(desc_.width), static_cast<float>(desc_.height),
                                0.0F, 1.0F};
  commands->OMSetRenderTargets(1, &target, textures.depthTarget.get());
  commands->OMSetDepthStencilState(writing_.get(), 0);
  commands->RSSetState(rasterizing_.get());
  commands->RSSetViewports(1, &viewport);
  commands->IASetInputLayout(nullptr);
  commands->IASetPrimitiveTopology(D3D11_PRIMITIVE_TOPOLOGY_TRIANGLELIST);
  commands->VSSetShader(backend_.vertexShader("opaque"), nullptr, 0);
  commands->PSSetShader(backend_.pixelShader("opaque"), nullptr, 0);
  for (std::uint32_t s = 0; s < desc_.samples; ++s) {
    struct {
      FloatColor color;
      std::array<float, 4> depth;
    } const constants{behindAt(desc_, s), {desc_.opaqueDepth.empty() ? farthest(desc_) : desc_.opaqueDepth.at(s)}};
    const auto buffer = device().makeBuffer(sizeof(constants), D3D11_BIND_CONSTANT_BUFFER, 0, &constants);
    ID3D11Buffer* const bound = buffer.get();
    commands->VSSetConstantBuffers(0, 1, &bound);
    commands->PSSetConstantBuffers(0, 1, &bound);
    commands->OMSetBlendState(nullptr, nullptr, severalSamples(desc_) ? 1U << s : 0xffffffffU);
    commands->Draw(3, 0);
  }
  commands->OMSetBlendState(nullptr, nullptr, 0xffffffffU);
}

void D3d11Host::begin(ID3D11DeviceContext* commands, std::uint64_t frame, const VitrailRect& area) {
  VitrailD3d11BeginInfo info{};
  info.frame = frame;
  info.area = area;
  vitrailD3d11Begin(target_, commands, &info);
  if (desc_.requestedBefore == 0) return;
  const std::array<std::uint32_t, 4> words = {desc_.requestedBefore};
  const D3D11_BOX box{offsetof(layout::VitrailControl, requested), 0, 0, 4, 1, 1};
  commands->UpdateSubresource(memory_[VITRAIL_D3D11_BUFFER_CONTROL].get(), 0, &box, words.data(), 0, 0);
}

void D3d11Host::setForPoints(ID3D11DeviceContext* commands, PointTextures& textures) const {
  const D3D11_VIEWPORT viewport{0.0F, 0.0F, static_cast<float>(desc_.width), static_cast<float>(desc_.height),
                                0.0F, 1.0F};
  ID3D11RenderTargetView* const target = textures.shown();
  commands->OMSetRenderTargets(1, &target, textures.depthTarget.get());
  commands->OMSetDepthStencilState(collecting_.get(), 0);
  commands->OMSetBlendState(noColor_.get(), nullptr, 0xffffffffU);
  commands->RSSetState(rasterizing_.get());
  commands->RSSetViewports(1, &viewport);
  commands->IASetInputLayout(backend_.pointLayout());
  commands->IASetPrimitiveTopology(D3D11_PRIMITIVE_TOPOLOGY_POINTLIST);
  commands->VSSetShader(backend_.vertexShader("points"), nullptr, 0);
}

Com<ID3D11Buffer> D3d11Host::setVertices(ID3D11DeviceContext* commands, std::span<const Point> points) const {
  std::vector<Vertex> vertices;
  vertices.reserve(points.size());
  for (const Point& point : points) vertices.push_back(toVertex(point, desc_));
  Com<ID3D11Buffer> buffer =
      device().makeBuffer(vertices.size() * sizeof(Vertex), D3D11_BIND_VERTEX_BUFFER, 0, vertices.data());
  ID3D11Buffer* const bound = buffer.get();
  constexpr UINT kStride = sizeof(Vertex);
  constexpr UINT kOffset = 0;
  commands->IASetVertexBuffers(0, 1, &bound, &kStride, &kOffset);
  return buffer;
}

// Points that follow each other and cover the same samples, strangers or not, are one draw.
void D3d11Host::drawPoints(ID3D11DeviceContext* commands, PointTextures& textures, std::span<const Point> points) {
  if (points.empty()) return;
  setForPoints(commands, textures);
  const Com<ID3D11Buffer> vertices = setVertices(commands, points);
  vitrailD3d11Bind(target_, commands);
  const std::uint32_t all = (1U << desc_.samples) - 1U;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t end = first + 1;
    const Point& point = points[first];
    const auto isAlike = [&](const Point& other) {
      return ((other.coverage ^ point.coverage) & all) == 0 && other.stranger == point.stranger;
    };
    while (end < points.size() && isAlike(points[end])) ++end;
    const bool covers = severalSamples(desc_) || (point.coverage & all) != 0;
    commands->OMSetBlendState(noColor_.get(), nullptr, severalSamples(desc_) ? point.coverage & all : 0xffffffffU);
    commands->PSSetShader(point.stranger ? strangers_ : points_, nullptr, 0);
    if (covers) commands->Draw(static_cast<UINT>(end - first), static_cast<UINT>(first));
    first = end;
  }
  commands->OMSetBlendState(nullptr, nullptr, 0xffffffffU);
}

void D3d11Host::setTargets(ID3D11DeviceContext* commands, PointTextures& textures) const {
  if (desc_.resolve != VITRAIL_RESOLVE_FRAGMENT) {
    commands->OMSetRenderTargets(0, nullptr, nullptr);
    return;
  }
  ID3D11RenderTargetView* const target = perPixel(desc_) ? textures.colorTarget.get() : textures.shown();
  commands->OMSetRenderTargets(1, &target, perPixel(desc_) ? nullptr : textures.depthTested.get());
}

void D3d11Host::resolve(ID3D11DeviceContext* commands, PointTextures& textures, std::uint64_t view) {
  VitrailD3d11ResolveInfo info{};
  if (views().count > 0) info.view = static_cast<std::uint32_t>(view);
  setTargets(commands, textures);
  vitrailD3d11Resolve(target_, commands, &info);
}

void D3d11Host::drawFrame(ID3D11DeviceContext* commands, std::uint64_t frame, PointTextures& textures,
                          const VitrailRect& area, std::span<const Point> points) {
  begin(commands, frame, area);
  drawPoints(commands, textures, points);
  vitrailD3d11Collected(target_, commands);
  resolve(commands, textures, static_cast<std::uint64_t>(&textures - textures_.data()));
  vitrailD3d11End(target_, commands);
}

void D3d11Host::drawWhole(std::uint64_t frame, std::span<const Point> points) {
  PointTextures& textures = texturesOf(frame);
  if (!deferred_) {
    drawOpaque(device().immediate(), textures);
    drawFrame(device().immediate(), frame, textures, wholeArea(), points);
    return;
  }
  Com<ID3D11DeviceContext> commands;
  check(on()->CreateDeferredContext(0, commands.out()), "CreateDeferredContext");
  drawOpaque(commands.get(), textures);
  drawFrame(commands.get(), frame, textures, wholeArea(), points);
  Com<ID3D11CommandList> list;
  check(commands->FinishCommandList(FALSE, list.out()), "FinishCommandList");
  device().immediate()->ExecuteCommandList(list.get(), FALSE);
}

std::vector<FloatColor> D3d11Host::pixels(const PointTextures& textures) const {
  ID3D11DeviceContext* commands = device().immediate();
  commands->OMSetRenderTargets(0, nullptr, nullptr);
  if (perSample(desc_)) { // the box filter
    commands->ResolveSubresource(textures.color.get(), 0, textures.multisampled.get(), 0, colorFormat(desc_));
  }
  D3D11_TEXTURE2D_DESC desc{};
  textures.color->GetDesc(&desc);
  desc.Usage = D3D11_USAGE_STAGING;
  desc.BindFlags = 0;
  desc.CPUAccessFlags = D3D11_CPU_ACCESS_READ;
  Com<ID3D11Texture2D> staging;
  check(on()->CreateTexture2D(&desc, nullptr, staging.out()), "CreateTexture2D");
  commands->CopyResource(staging.get(), textures.color.get());
  D3D11_MAPPED_SUBRESOURCE mapped{};
  check(commands->Map(staging.get(), 0, D3D11_MAP_READ, 0, &mapped), "Map");
  std::vector<FloatColor> result(std::size_t{desc_.width} * desc_.height);
  if (desc_.colorFormat == ColorFormat::Float32) {
    for (std::uint32_t y = 0; y < desc_.height; ++y) {
      std::memcpy(&result[std::size_t{y} * desc_.width],
                  static_cast<const std::byte*>(mapped.pData) + y * mapped.RowPitch, desc_.width * sizeof(FloatColor));
    }
  }
  commands->Unmap(staging.get(), 0);
  return result;
}

PointResult D3d11Host::read(const PointTextures& textures, std::uint64_t frame) const {
  std::vector<FloatColor> picture = pixels(textures); // which waits for the frame
  std::optional<VitrailStats> counted = stats(frame);
  // wined3d looks at its queries when it comes to it.
  for (int tries = 0; !counted && tries < 2000; ++tries) {
    Sleep(1);
    counted = stats(frame);
  }
  if (!counted) throw HostError("the statistics of frame " + std::to_string(frame) + " are not there");
  return {std::move(picture), *counted};
}

std::optional<VitrailStats> D3d11Host::stats(std::uint64_t frame) const {
  VitrailStats stats{};
  if (vitrailD3d11ReadStats(target_, frame, &stats) != VITRAIL_SUCCESS) return {};
  return stats;
}

VitrailMemory D3d11Host::memory() const {
  VitrailMemory memory{};
  vitrailD3d11TargetMemory(target_, &memory);
  return memory;
}

void D3d11Host::update(std::uint64_t frame) {
  if (vitrailD3d11UpdateTarget(target_, frame) != VITRAIL_SUCCESS) throw HostError("vitrailD3d11UpdateTarget");
}

std::vector<PointResult> D3d11Host::drawTogether(const std::vector<std::vector<Point>>& frames) {
  const std::uint64_t first = frame_;
  frame_ += frames.size();
  update(first);
  for (std::uint64_t frame = first; frame < frame_; ++frame) drawWhole(frame, frames[frame - first]);
  std::vector<PointResult> results;
  for (std::uint64_t frame = first; frame < frame_; ++frame) results.push_back(read(texturesOf(frame), frame));
  return results;
}

std::array<PointResult, 2> D3d11Host::drawAcrossResize(std::span<const Point> first, Extent extent,
                                                       std::span<const Point> second, std::uint32_t capacity) {
  const std::uint64_t frame = frame_;
  frame_ += 2;
  update(frame);
  drawWhole(frame, first);
  std::array<PointTextures, kFramesTogether> old = std::exchange(textures_, {});
  const HostDesc before = desc_;
  desc_.width = extent.width;
  desc_.height = extent.height;
  makeTextures();
  VitrailD3d11ResizeInfo info{};
  info.width = extent.width;
  info.height = extent.height;
  info.nodeCapacity = capacity;
  info.views = views();
  if (vitrailD3d11ResizeTarget(target_, &info) != VITRAIL_SUCCESS) throw HostError("vitrailD3d11ResizeTarget");
  drawWhole(frame + 1, second);
  PointResult after = read(texturesOf(frame + 1), frame + 1);
  const HostDesc now = std::exchange(desc_, before);
  PointResult earlier = read(old[frame % kFramesTogether], frame);
  desc_ = now;
  return {std::move(earlier), std::move(after)};
}

class D3d11Host::Calls : public FrameCalls {
 public:
  Calls(D3d11Host& host, ID3D11DeviceContext* commands, PointTextures& textures)
      : host_(host), commands_(commands), textures_(textures) {}

  void begin(const VitrailRect& area) override {
    begun = host_.frame_++;
    host_.begin(commands_, *begun, area);
  }
  void draw(std::span<const Point> points) override { host_.drawPoints(commands_, textures_, points); }
  void collected() override { vitrailD3d11Collected(host_.target_, commands_); }
  void copyLists(const CopyAttempt& attempt) override {
    if (!copied_) {
      bytes_ = vitrailD3d11CopySize(host_.target_, 4, 4);
      const std::vector<std::byte> untouched(bytes_, kUntouched);
      copied_ = device().makeBuffer(bytes_, D3D11_BIND_UNORDERED_ACCESS, D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS,
                                    untouched.data());
    }
    VitrailD3d11CopyInfo info{};
    info.area = attempt.area;
    if (attempt.hasBuffer) info.buffer = copied_.get();
    info.offset = attempt.offset;
    info.size = attempt.size.value_or(bytes_ - attempt.offset);
    vitrailD3d11CopyLists(host_.target_, commands_, &info);
  }
  void resolve(std::optional<std::uint32_t> view) override {
    const auto own = static_cast<std::uint64_t>(&textures_ - host_.textures_.data());
    host_.resolve(commands_, textures_, view ? *view : own);
  }
  void end() override { vitrailD3d11End(host_.target_, commands_); }
  void resize() override {
    VitrailD3d11ResizeInfo info{};
    info.width = host_.desc_.width;
    info.height = host_.desc_.height;
    info.views = host_.views();
    if (vitrailD3d11ResizeTarget(host_.target_, &info) != VITRAIL_SUCCESS) throw HostError("vitrailD3d11ResizeTarget");
  }

  [[nodiscard]] bool hasCopied() const {
    if (!copied_) return false;
    const std::vector<std::byte> bytes = device().read(copied_.get(), bytes_);
    return std::any_of(bytes.begin(), bytes.end(), [](std::byte byte) { return byte != kUntouched; });
  }

  std::optional<std::uint64_t> begun;

 private:
  static constexpr std::byte kUntouched{0x5a};

  D3d11Host& host_;
  ID3D11DeviceContext* commands_;
  PointTextures& textures_;
  Com<ID3D11Buffer> copied_;
  std::uint64_t bytes_ = 0;
};

CallsResult D3d11Host::drawCalls(const std::function<void(FrameCalls&)>& make) {
  PointTextures& textures = texturesOf(frame_);
  ID3D11DeviceContext* commands = device().immediate();
  drawOpaque(commands, textures);
  Calls calls(*this, commands, textures);
  make(calls);
  CallsResult result{pixels(textures), std::nullopt, calls.hasCopied()}; // which waits
  // wined3d looks at its queries when it comes to it; a frame that has no statistics never gets them.
  for (int tries = 0; calls.begun && !result.stats && tries < 50; ++tries) {
    Sleep(1);
    result.stats = stats(*calls.begun);
  }
  return result;
}

PointResult D3d11Host::drawAreas(std::span<const Point> points, const NextArea& next) {
  PointTextures& textures = textures_[0];
  drawOpaque(device().immediate(), textures);
  VitrailStats stats{};
  VitrailRect area{};
  for (bool more = next(nullptr, area); more; more = next(&stats, area)) {
    const std::uint64_t frame = frame_++;
    drawFrame(device().immediate(), frame, textures, area, points);
    stats = read(textures, frame).stats;
  }
  return {pixels(textures), stats};
}

std::vector<std::byte> D3d11Host::readPart(std::size_t kind) const {
  return device().read(memory_.at(kind).get(), sizes_.at(kind) + kGuardWords * sizeof(std::uint32_t));
}

PointResult D3d11Host::drawScattered(std::span<const Point> points) {
  const std::uint64_t frame = frame_++;
  PointTextures& textures = texturesOf(frame);
  ID3D11DeviceContext* commands = device().immediate();
  drawOpaque(commands, textures);
  begin(commands, frame, wholeArea());
  drawPoints(commands, textures, points);
  std::vector<std::byte> copy(storage_.total);
  for (std::size_t i = 0; i < kParts.size(); ++i) {
    const StoragePart& part = storage_.*kParts.at(i);
    std::memcpy(copy.data() + part.offset, readPart(i).data(), part.size);
  }
  scatterNodes(desc_, storage_, copy);
  for (std::size_t i = 0; i < kParts.size(); ++i) {
    const StoragePart& part = storage_.*kParts.at(i);
    const D3D11_BOX box{0, 0, 0, static_cast<UINT>(part.size), 1, 1};
    commands->UpdateSubresource(memory_.at(i).get(), 0, &box, copy.data() + part.offset, 0, 0);
  }
  vitrailD3d11Collected(target_, commands);
  resolve(commands, textures, frame % kFramesTogether);
  vitrailD3d11End(target_, commands);
  return read(textures, frame);
}

void D3d11Host::walk(ID3D11DeviceContext* commands, const VitrailRect& area, ID3D11Buffer* buffer, std::size_t bytes) {
  struct {
    std::array<std::uint32_t, 4> area;
    std::array<std::uint32_t, 4> most;
  } const constants{{area.x, area.y, area.width, area.height}, {kMostWalked}};
  const auto constantBuffer = device().makeBuffer(sizeof(constants), D3D11_BIND_CONSTANT_BUFFER, 0, &constants);
  const auto view = device().makeRawView(buffer, bytes);
  ID3D11Buffer* bound = constantBuffer.get();
  ID3D11UnorderedAccessView* written = view.get();
  Defines defines;
  if (desc_.resolve == VITRAIL_RESOLVE_HOST) defines.emplace_back("VITRAIL_SORTED_LISTS=1");
  commands->OMSetRenderTargets(0, nullptr, nullptr);
  vitrailD3d11BindLists(target_, commands);
  commands->CSSetShader(backend_.computeShader("walk", defines), nullptr, 0);
  commands->CSSetConstantBuffers(0, 1, &bound);
  commands->CSSetUnorderedAccessViews(0, 1, &written, nullptr);
  commands->Dispatch((area.width + 7) / 8, (area.height + 7) / 8, 1);
  written = nullptr;
  commands->CSSetUnorderedAccessViews(0, 1, &written, nullptr);
  vitrailD3d11UnbindLists(target_, commands);
}

ListsRead D3d11Host::drawAndRead(std::span<const Point> points, const VitrailRect& area, ReadBy by, bool afterResolve) {
  const std::uint64_t frame = frame_++;
  PointTextures& textures = texturesOf(frame);
  ID3D11DeviceContext* commands = device().immediate();
  const std::uint64_t pixelCount = std::uint64_t{area.width} * area.height;
  const std::uint64_t bytes = by == ReadBy::Shader ? pixelCount * (2 + 8 * std::uint64_t{kMostWalked}) * 4
                                                   : vitrailD3d11CopySize(target_, area.width, area.height);
  const auto buffer =
      device().makeBuffer(bytes, D3D11_BIND_UNORDERED_ACCESS, D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS);
  const auto readLists = [&] {
    if (by == ReadBy::Shader) return walk(commands, area, buffer.get(), bytes);
    VitrailD3d11CopyInfo info{};
    info.area = area;
    info.buffer = buffer.get();
    info.size = bytes;
    vitrailD3d11CopyLists(target_, commands, &info);
  };
  update(frame);
  drawOpaque(commands, textures);
  begin(commands, frame, wholeArea());
  drawPoints(commands, textures, points);
  vitrailD3d11Collected(target_, commands);
  if (!afterResolve) readLists();
  resolve(commands, textures, frame % kFramesTogether);
  if (afterResolve) readLists();
  vitrailD3d11End(target_, commands);
  ListsRead result;
  result.frame = read(textures, frame);
  result.pixels.resize(pixelCount);
  const std::vector<std::byte> copy = device().read(buffer.get(), bytes);
  if (by == ReadBy::Shader) {
    decodeWalk(copy, result);
  } else {
    decodeCopy(copy, static_cast<std::uint32_t>(pixelCount), result);
  }
  return result;
}

// On a deferred context, whose command list is never executed.
void D3d11Host::drop(std::span<const Point> points) {
  const std::uint64_t frame = frame_++;
  update(frame);
  Com<ID3D11DeviceContext> commands;
  check(on()->CreateDeferredContext(0, commands.out()), "CreateDeferredContext");
  drawOpaque(commands.get(), texturesOf(frame));
  drawFrame(commands.get(), frame, texturesOf(frame), wholeArea(), points);
  Com<ID3D11CommandList> list;
  check(commands->FinishCommandList(FALSE, list.out()), "FinishCommandList");
}

std::vector<std::uint32_t> D3d11Host::words(StoragePart StorageLayout::*part) {
  const auto kind = static_cast<std::size_t>(std::find(kParts.begin(), kParts.end(), part) - kParts.begin());
  const std::vector<std::byte> bytes = readPart(kind);
  std::vector<std::uint32_t> words((storage_.*part).size / sizeof(std::uint32_t));
  std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t));
  return words;
}

bool D3d11Host::guardsUntouched() {
  bool untouched = true;
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    const std::vector<std::byte> bytes = readPart(i);
    std::array<std::uint32_t, kGuardWords> guards{};
    std::memcpy(guards.data(), bytes.data() + sizes_.at(i), sizeof(guards));
    untouched =
        untouched && std::all_of(guards.begin(), guards.end(), [](std::uint32_t word) { return word == kGuard; });
  }
  return untouched;
}

} // namespace vitrail::tests::d3d11
