#include "point_host.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

namespace vitrail::tests::d3d12 {

namespace {

using State = D3D12_RESOURCE_STATES;

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
DXGI_FORMAT depthFormat(const HostDesc& desc) {
  return desc.stencilMark ? DXGI_FORMAT_D32_FLOAT_S8X24_UINT : DXGI_FORMAT_D32_FLOAT;
}
bool hasDepth(const HostDesc& desc) { return desc.stencilMark || severalSamples(desc) || !desc.opaqueDepth.empty(); }
float farthest(const HostDesc& desc) { return desc.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? 0.0F : 1.0F; }
ID3D12Device* on() { return device().get(); }

Texture makeTexture(const HostDesc& desc, DXGI_FORMAT format, std::uint32_t samples, D3D12_RESOURCE_FLAGS flags,
                    State state) {
  D3D12_HEAP_PROPERTIES heap{};
  heap.Type = D3D12_HEAP_TYPE_DEFAULT;
  D3D12_RESOURCE_DESC texture{};
  texture.Dimension = D3D12_RESOURCE_DIMENSION_TEXTURE2D;
  texture.Width = desc.width;
  texture.Height = desc.height;
  texture.DepthOrArraySize = 1;
  texture.MipLevels = 1;
  texture.Format = format;
  texture.SampleDesc.Count = samples;
  texture.Flags = flags;
  Texture made;
  made.state = state;
  check(on()->CreateCommittedResource(&heap, D3D12_HEAP_FLAG_NONE, &texture, state, nullptr,
                                      VITRAIL_TEST_ID(ID3D12Resource), outOf(made.resource)),
        "CreateCommittedResource");
  return made;
}

// What the library copied out.
void decodeCopy(const std::vector<std::byte>& copy, std::uint32_t pixels, ListsRead& read) {
  VitrailD3d12CopyHeader header{};
  std::memcpy(&header, copy.data(), sizeof(header));
  read.layers = header.layers;
  std::vector<VitrailD3d12CopiedList> lists(pixels);
  std::memcpy(lists.data(), copy.data() + sizeof(header), pixels * sizeof(VitrailD3d12CopiedList));
  const std::byte* layers = copy.data() + sizeof(header) + pixels * sizeof(VitrailD3d12CopiedList);
  for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const VitrailD3d12CopiedList& list = lists[pixel];
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

// The parts of a target's memory that tests look at.
constexpr std::array kParts = {&StorageLayout::control, &StorageLayout::heads,       &StorageLayout::nodes,
                               &StorageLayout::sums,    &StorageLayout::mediumLists, &StorageLayout::longLists,
                               &StorageLayout::copy};

// Where the library's memory begins in a host's.
constexpr std::uint64_t kFirst = kPlacement;

} // namespace

// ---- Textures

D3D12_CPU_DESCRIPTOR_HANDLE PointTextures::at(const Com<ID3D12DescriptorHeap>& heap, UINT number) {
  D3D12_DESCRIPTOR_HEAP_DESC desc = heap->GetDesc();
  D3D12_CPU_DESCRIPTOR_HANDLE place = heap->GetCPUDescriptorHandleForHeapStart();
  place.ptr += std::size_t{number} * on()->GetDescriptorHandleIncrementSize(desc.Type);
  return place;
}

PointTextures::PointTextures(const HostDesc& desc) {
  targets = device().makeHeap(D3D12_DESCRIPTOR_HEAP_TYPE_RTV, 2);
  color = makeTexture(desc, colorFormat(desc), 1,
                      D3D12_RESOURCE_FLAG_ALLOW_RENDER_TARGET | D3D12_RESOURCE_FLAG_ALLOW_UNORDERED_ACCESS,
                      D3D12_RESOURCE_STATE_RENDER_TARGET);
  on()->CreateRenderTargetView(color.resource.get(), nullptr, at(targets, 0));
  if (severalSamples(desc)) {
    multisampled = makeTexture(desc, colorFormat(desc), desc.samples, D3D12_RESOURCE_FLAG_ALLOW_RENDER_TARGET,
                               D3D12_RESOURCE_STATE_RENDER_TARGET);
    on()->CreateRenderTargetView(multisampled.resource.get(), nullptr, at(targets, 1));
  }
  if (!hasDepth(desc)) return;
  depth = makeTexture(desc, desc.stencilMark ? DXGI_FORMAT_R32G8X24_TYPELESS : DXGI_FORMAT_R32_TYPELESS, desc.samples,
                      D3D12_RESOURCE_FLAG_ALLOW_DEPTH_STENCIL, D3D12_RESOURCE_STATE_DEPTH_WRITE);
  depths = device().makeHeap(D3D12_DESCRIPTOR_HEAP_TYPE_DSV, 2);
  D3D12_DEPTH_STENCIL_VIEW_DESC view{};
  view.Format = depthFormat(desc);
  view.ViewDimension = severalSamples(desc) ? D3D12_DSV_DIMENSION_TEXTURE2DMS : D3D12_DSV_DIMENSION_TEXTURE2D;
  on()->CreateDepthStencilView(depth.resource.get(), &view, at(depths, 0));
  view.Flags = D3D12_DSV_FLAG_READ_ONLY_DEPTH;
  if (desc.stencilMark) view.Flags |= D3D12_DSV_FLAG_READ_ONLY_STENCIL;
  on()->CreateDepthStencilView(depth.resource.get(), &view, at(depths, 1));
}

// ---- The host

D3d12Host::D3d12Host(D3d12Backend& backend, const HostDesc& desc, const Change& change)
    : backend_(backend), desc_(desc) {
  makeTextures();
  VitrailD3d12TargetDesc target = targetDesc();
  if (desc.guarded) guard(target);
  if (change) change(target);
  const VitrailResult result = vitrailD3d12CreateTarget(backend.context(), &target, &target_);
  if (result != VITRAIL_SUCCESS) {
    std::string reason = "vitrailD3d12CreateTarget: VitrailResult " + std::to_string(result);
    for (const LogLine& line : backend.takeLog()) reason += ": " + line.text;
    throw HostError(reason);
  }
  points_ = shaderFor(target, desc.specialized);
  if (desc.strangersFor) {
    target.overflow = *desc.strangersFor;
    strangers_ = shaderFor(target, true);
  }
}

D3d12Host::~D3d12Host() { vitrailD3d12DestroyTarget(target_); }

void D3d12Host::makeTextures() {
  for (std::size_t i = 0; i < textures_.size(); ++i) {
    textures_[i] = PointTextures(desc_);
    colorViews_[i] = textures_[i].color.resource.get();
    opaqueViews_[i] = textures_[i].multisampled.resource.get();
    depthViews_[i] = textures_[i].depth.resource.get();
  }
}

VitrailD3d12Views D3d12Host::views() {
  VitrailD3d12Views views{};
  if (desc_.resolve == VITRAIL_RESOLVE_HOST) return views;
  if (desc_.resolve != VITRAIL_RESOLVE_FRAGMENT) views.color = colorViews_.data();
  if (perPixel(desc_)) views.opaque = opaqueViews_.data();
  if (severalSamples(desc_)) views.depth = depthViews_.data();
  const bool any = views.color != nullptr || views.opaque != nullptr || views.depth != nullptr;
  views.count = any ? kFramesTogether : 0;
  return views;
}

VitrailD3d12TargetDesc D3d12Host::targetDesc() {
  VitrailD3d12TargetDesc desc{};
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
  if (hasDepth(desc_) && !perPixel(desc_)) desc.depthStencilFormat = depthFormat(desc_);
  desc.severalRenderTargets = desc_.dualSourceBlending ? 0 : 1;
  desc.stencilMark = desc_.stencilMark && !perPixel(desc_) ? 1 : 0;
  desc.debugName = "points";
  return desc;
}

// Makes the target's memory, between guard words and full of them.
void D3d12Host::guard(VitrailD3d12TargetDesc& desc) {
  VitrailD3d12Requirements needs{};
  if (vitrailD3d12TargetRequirements(backend_.context(), &desc, &needs) != VITRAIL_SUCCESS) {
    throw HostError("vitrailD3d12TargetRequirements");
  }
  storage_ = layoutOf(desc_, D3D12_CONSTANT_BUFFER_DATA_PLACEMENT_ALIGNMENT);
  memoryBytes_ = kFirst + needs.size + kPlacement;
  D3D12_HEAP_DESC heap{};
  heap.SizeInBytes = memoryBytes_;
  heap.Properties.Type = D3D12_HEAP_TYPE_DEFAULT;
  heap.Flags = D3D12_HEAP_FLAG_ALLOW_ONLY_BUFFERS;
  check(on()->CreateHeap(&heap, VITRAIL_TEST_ID(ID3D12Heap), outOf(heap_)), "CreateHeap");
  D3D12_RESOURCE_DESC all{};
  all.Dimension = D3D12_RESOURCE_DIMENSION_BUFFER;
  all.Width = memoryBytes_;
  all.Height = 1;
  all.DepthOrArraySize = 1;
  all.MipLevels = 1;
  all.SampleDesc.Count = 1;
  all.Layout = D3D12_TEXTURE_LAYOUT_ROW_MAJOR;
  check(on()->CreatePlacedResource(heap_.get(), 0, &all, D3D12_RESOURCE_STATE_COMMON, nullptr,
                                   VITRAIL_TEST_ID(ID3D12Resource), outOf(memory_)),
        "CreatePlacedResource");
  const std::vector<std::uint32_t> words(memoryBytes_ / sizeof(std::uint32_t), kGuard);
  writeMemory(0, std::as_bytes(std::span(words)));
  desc.heap = heap_.get();
  desc.heapOffset = kFirst;
  desc.heapSize = needs.size;
}

// The shader of points for a target, or for what HostDesc says in its place: tests/library/d3d12/CMakeLists.txt.
std::string D3d12Host::shaderFor(const VitrailD3d12TargetDesc& target, bool specialized) const {
  if (desc_.shader == ShaderKind::Narrow && !specialized) return "points_0_1_1_1_0";
  if (!specialized) return "points";
  const VitrailNodeFormat format = desc_.specializedFor.value_or(target.nodeFormat);
  VitrailOverflow overflow = desc_.specializedForOverflow.value_or(target.overflow);
  if (desc_.resolve == VITRAIL_RESOLVE_HOST) overflow = VITRAIL_OVERFLOW_SKIP; // nothing is summed
  const VitrailListBuild build = desc_.specializedForListBuild.value_or(vitrailD3d12TargetListBuild(target_));
  return "points_" + std::to_string(format) + "_" + std::to_string(target.samples) + "_" + std::to_string(overflow) +
         "_" + std::to_string(build) + "_" + std::to_string(target.userWords);
}

// ---- Frames

PointsKind D3d12Host::pointsKind(const PointTextures& textures) const {
  PointsKind kind;
  kind.shader = points_;
  kind.samples = desc_.samples;
  kind.color = colorFormat(desc_);
  kind.depth = textures.depth.resource ? depthFormat(desc_) : DXGI_FORMAT_UNKNOWN;
  kind.passes = desc_.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? D3D12_COMPARISON_FUNC_GREATER_EQUAL
                                                                 : D3D12_COMPARISON_FUNC_LESS_EQUAL;
  kind.stencil = desc_.stencilMark;
  return kind;
}

void D3d12Host::drawOpaque(ID3D12GraphicsCommandList* commands, PointTextures& textures) {
  textures.color.to(commands, D3D12_RESOURCE_STATE_RENDER_TARGET);
  textures.multisampled.to(commands, D3D12_RESOURCE_STATE_RENDER_TARGET);
  textures.depth.to(commands, D3D12_RESOURCE_STATE_DEPTH_WRITE);
  if (perPixel(desc_)) commands->ClearRenderTargetView(textures.colorTarget(), desc_.beforeResolve.data(), 0, nullptr);
  commands->ClearRenderTargetView(textures.shownTarget(), desc_.behind.data(), 0, nullptr);
  if (textures.depth.resource) {
    auto what = D3D12_CLEAR_FLAG_DEPTH;
    if (desc_.stencilMark) what |= D3D12_CLEAR_FLAG_STENCIL;
    commands->ClearDepthStencilView(textures.depthTarget(), what, farthest(desc_), 0, 0, nullptr);
  }
  if (desc_.behindSamples.empty() && desc_.opaqueDepth.empty()) return;
  const D3D12_CPU_DESCRIPTOR_HANDLE target = textures.shownTarget();
  const D3D12_CPU_DESCRIPTOR_HANDLE depth =
      textures.depth.resource ? textures.depthTarget() : D3D12_CPU_DESCRIPTOR_HANDLE{};
  const D3D12_VIEWPORT viewport{0.0F, 0.0F, static_cast<float>(desc_.width), static_cast<float>(desc_.height),
                                0.0F, 1.0F};
  const D3D12_RECT scissor{0, 0, static_cast<LONG>(desc_.width), static_cast<LONG>(desc_.height)};
  commands->OMSetRenderTargets(1, &target, FALSE, textures.depth.resource ? &depth : nullptr);
  commands->RSSetViewports(1, &viewport);
  commands->RSSetScissorRects(1, &scissor);
  commands->IASetPrimitiveTopology(D3D_PRIMITIVE_TOPOLOGY_TRIANGLELIST);
  commands->SetGraphicsRootSignature(backend_.opaqueRoot());
  PointsKind kind = pointsKind(textures);
  kind.opaque = true;
  for (std::uint32_t s = 0; s < desc_.samples; ++s) {
    struct {
      FloatColor color;
      std::array<float, 4> depth;
    } const constants{behindAt(desc_, s), {desc_.opaqueDepth.empty() ? farthest(desc_) : desc_.opaqueDepth.at(s)}};
    kind.mask = severalSamples(desc_) ? 1U << s : 0xffffffffU;
    commands->SetPipelineState(backend_.points(kind));
    commands->SetGraphicsRoot32BitConstants(0, 8, &constants, 0);
    commands->DrawInstanced(3, 1, 0, 0);
  }
}

void D3d12Host::begin(ID3D12GraphicsCommandList* commands, std::uint64_t frame, const VitrailRect& area) {
  VitrailD3d12BeginInfo info{};
  info.frame = frame;
  info.area = area;
  if (visible_ != nullptr) commands->SetDescriptorHeaps(1, &visible_);
  vitrailD3d12Begin(target_, commands, &info);
  if (desc_.requestedBefore == 0) return;
  commands_.run(); // so that nothing but this host is at its memory
  const std::uint32_t word = desc_.requestedBefore;
  writeMemory(placeOf(storage_.control) + offsetof(layout::VitrailControl, requested),
              std::as_bytes(std::span(&word, 1)));
}

void D3d12Host::setPoints(ID3D12GraphicsCommandList* commands, CommandList& kept, PointTextures& textures,
                          std::span<const Point> points) const {
  std::vector<Vertex> vertices;
  vertices.reserve(points.size());
  for (const Point& point : points) vertices.push_back(toVertex(point, desc_));
  Com<ID3D12Resource> buffer = device().upload(std::as_bytes(std::span(vertices)));
  D3D12_VERTEX_BUFFER_VIEW view{};
  view.BufferLocation = buffer->GetGPUVirtualAddress();
  view.SizeInBytes = static_cast<UINT>(vertices.size() * sizeof(Vertex));
  view.StrideInBytes = sizeof(Vertex);
  kept.keep(std::move(buffer));
  const D3D12_VIEWPORT viewport{0.0F, 0.0F, static_cast<float>(desc_.width), static_cast<float>(desc_.height),
                                0.0F, 1.0F};
  const D3D12_RECT scissor{0, 0, static_cast<LONG>(desc_.width), static_cast<LONG>(desc_.height)};
  const D3D12_CPU_DESCRIPTOR_HANDLE target = textures.shownTarget();
  const D3D12_CPU_DESCRIPTOR_HANDLE depth =
      textures.depth.resource ? textures.depthTarget() : D3D12_CPU_DESCRIPTOR_HANDLE{};
  textures.shown().to(commands, D3D12_RESOURCE_STATE_RENDER_TARGET);
  textures.depth.to(commands, D3D12_RESOURCE_STATE_DEPTH_WRITE);
  commands->OMSetRenderTargets(1, &target, FALSE, textures.depth.resource ? &depth : nullptr);
  commands->RSSetViewports(1, &viewport);
  commands->RSSetScissorRects(1, &scissor);
  commands->IASetPrimitiveTopology(D3D_PRIMITIVE_TOPOLOGY_POINTLIST);
  commands->IASetVertexBuffers(0, 1, &view);
}

// Points that follow each other and cover the same samples, strangers or not, are one draw.
void D3d12Host::drawPoints(ID3D12GraphicsCommandList* commands, CommandList& kept, PointTextures& textures,
                           std::span<const Point> points) {
  if (points.empty()) return;
  setPoints(commands, kept, textures, points);
  commands->SetGraphicsRootSignature(backend_.pointsRoot());
  vitrailD3d12Bind(target_, commands, 0);
  const std::uint32_t all = (1U << desc_.samples) - 1U;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t end = first + 1;
    const Point& point = points[first];
    const auto isAlike = [&](const Point& other) {
      return ((other.coverage ^ point.coverage) & all) == 0 && other.stranger == point.stranger;
    };
    while (end < points.size() && isAlike(points[end])) ++end;
    PointsKind kind = pointsKind(textures);
    kind.mask = severalSamples(desc_) ? point.coverage & all : 0xffffffffU;
    if (point.stranger) kind.shader = strangers_;
    if ((point.coverage & all) != 0) {
      commands->SetPipelineState(backend_.points(kind));
      commands->DrawInstanced(static_cast<UINT>(end - first), 1, static_cast<UINT>(first), 0);
    }
    first = end;
  }
}

void D3d12Host::setForResolve(ID3D12GraphicsCommandList* commands, PointTextures& textures) {
  if (desc_.resolve != VITRAIL_RESOLVE_FRAGMENT) {
    if (desc_.resolve != VITRAIL_RESOLVE_HOST) textures.color.to(commands, D3D12_RESOURCE_STATE_UNORDERED_ACCESS);
    textures.multisampled.to(commands, D3D12_RESOURCE_STATE_NON_PIXEL_SHADER_RESOURCE);
    textures.depth.to(commands, D3D12_RESOURCE_STATE_NON_PIXEL_SHADER_RESOURCE);
    return;
  }
  textures.color.to(commands, D3D12_RESOURCE_STATE_RENDER_TARGET);
  if (perPixel(desc_)) {
    textures.multisampled.to(commands, D3D12_RESOURCE_STATE_PIXEL_SHADER_RESOURCE);
    textures.depth.to(commands, D3D12_RESOURCE_STATE_PIXEL_SHADER_RESOURCE);
  } else {
    textures.depth.to(commands, D3D12_RESOURCE_STATE_DEPTH_READ | D3D12_RESOURCE_STATE_PIXEL_SHADER_RESOURCE);
  }
  const D3D12_CPU_DESCRIPTOR_HANDLE target = perPixel(desc_) ? textures.colorTarget() : textures.shownTarget();
  const bool tests = !perPixel(desc_) && textures.depth.resource;
  const D3D12_CPU_DESCRIPTOR_HANDLE depth = tests ? textures.depthTested() : D3D12_CPU_DESCRIPTOR_HANDLE{};
  commands->OMSetRenderTargets(1, &target, FALSE, tests ? &depth : nullptr);
}

void D3d12Host::resolve(ID3D12GraphicsCommandList* commands, PointTextures& textures, std::uint64_t view) {
  VitrailD3d12ResolveInfo info{};
  if (views().count > 0) info.view = static_cast<std::uint32_t>(view);
  setForResolve(commands, textures);
  vitrailD3d12Resolve(target_, commands, &info);
}

void D3d12Host::drawFrame(ID3D12GraphicsCommandList* commands, CommandList& kept, std::uint64_t frame,
                          PointTextures& textures, const VitrailRect& area, std::span<const Point> points) {
  begin(commands, frame, area);
  drawPoints(commands, kept, textures, points);
  vitrailD3d12Collected(target_, commands);
  resolve(commands, textures, static_cast<std::uint64_t>(&textures - textures_.data()));
  vitrailD3d12End(target_, commands);
}

std::vector<FloatColor> D3d12Host::pixels(PointTextures& textures) {
  const std::size_t pitch = (desc_.width * sizeof(FloatColor) + D3D12_TEXTURE_DATA_PITCH_ALIGNMENT - 1) /
                            D3D12_TEXTURE_DATA_PITCH_ALIGNMENT * D3D12_TEXTURE_DATA_PITCH_ALIGNMENT;
  if (desc_.colorFormat != ColorFormat::Float32)
    return std::vector<FloatColor>(std::size_t{desc_.width} * desc_.height);
  if (perSample(desc_)) { // the box filter
    textures.color.to(commands_.get(), D3D12_RESOURCE_STATE_RESOLVE_DEST);
    textures.multisampled.to(commands_.get(), D3D12_RESOURCE_STATE_RESOLVE_SOURCE);
    commands_->ResolveSubresource(textures.color.resource.get(), 0, textures.multisampled.resource.get(), 0,
                                  colorFormat(desc_));
  }
  textures.color.to(commands_.get(), D3D12_RESOURCE_STATE_COPY_SOURCE);
  const Com<ID3D12Resource> staging = device().makeBuffer(pitch * desc_.height, D3D12_HEAP_TYPE_READBACK);
  D3D12_TEXTURE_COPY_LOCATION to{};
  to.pResource = staging.get();
  to.Type = D3D12_TEXTURE_COPY_TYPE_PLACED_FOOTPRINT;
  to.PlacedFootprint.Footprint = {colorFormat(desc_), desc_.width, desc_.height, 1, static_cast<UINT>(pitch)};
  D3D12_TEXTURE_COPY_LOCATION from{};
  from.pResource = textures.color.resource.get();
  from.Type = D3D12_TEXTURE_COPY_TYPE_SUBRESOURCE_INDEX;
  commands_->CopyTextureRegion(&to, 0, 0, 0, &from, nullptr);
  commands_.run();
  void* mapped = nullptr;
  check(staging->Map(0, nullptr, &mapped), "ID3D12Resource::Map");
  std::vector<FloatColor> result(std::size_t{desc_.width} * desc_.height);
  for (std::uint32_t y = 0; y < desc_.height; ++y) {
    std::memcpy(&result[std::size_t{y} * desc_.width], static_cast<const std::byte*>(mapped) + y * pitch,
                desc_.width * sizeof(FloatColor));
  }
  staging->Unmap(0, nullptr);
  return result;
}

PointResult D3d12Host::read(PointTextures& textures, std::uint64_t frame) {
  std::vector<FloatColor> picture = pixels(textures);
  const std::optional<VitrailStats> counted = stats(frame);
  if (!counted) throw HostError("the statistics of frame " + std::to_string(frame) + " are not there");
  return {std::move(picture), *counted};
}

std::optional<VitrailStats> D3d12Host::stats(std::uint64_t frame) const {
  VitrailStats stats{};
  if (vitrailD3d12ReadStats(target_, frame, &stats) != VITRAIL_SUCCESS) return {};
  return stats;
}

VitrailMemory D3d12Host::memory() const {
  VitrailMemory memory{};
  vitrailD3d12TargetMemory(target_, &memory);
  return memory;
}

void D3d12Host::update(std::uint64_t frame) {
  if (vitrailD3d12UpdateTarget(target_, frame) != VITRAIL_SUCCESS) throw HostError("vitrailD3d12UpdateTarget");
}

std::vector<PointResult> D3d12Host::drawTogether(const std::vector<std::vector<Point>>& frames) {
  const std::uint64_t first = frame_;
  frame_ += frames.size();
  update(first);
  for (std::uint64_t frame = first; frame < frame_; ++frame) {
    drawOpaque(commands_.get(), texturesOf(frame));
    drawFrame(commands_.get(), commands_, frame, texturesOf(frame), wholeArea(), frames[frame - first]);
  }
  commands_.run();
  std::vector<PointResult> results;
  for (std::uint64_t frame = first; frame < frame_; ++frame) results.push_back(read(texturesOf(frame), frame));
  return results;
}

std::array<PointResult, 2> D3d12Host::drawAcrossResize(std::span<const Point> first, Extent extent,
                                                       std::span<const Point> second, std::uint32_t capacity) {
  const std::uint64_t frame = frame_;
  frame_ += 2;
  update(frame);
  drawOpaque(commands_.get(), texturesOf(frame));
  drawFrame(commands_.get(), commands_, frame, texturesOf(frame), wholeArea(), first);
  std::array<PointTextures, kFramesTogether> old = std::exchange(textures_, {});
  const HostDesc before = desc_;
  desc_.width = extent.width;
  desc_.height = extent.height;
  makeTextures();
  VitrailD3d12ResizeInfo info{};
  info.width = extent.width;
  info.height = extent.height;
  info.nodeCapacity = capacity;
  info.views = views();
  if (vitrailD3d12ResizeTarget(target_, &info) != VITRAIL_SUCCESS) throw HostError("vitrailD3d12ResizeTarget");
  drawOpaque(commands_.get(), texturesOf(frame + 1));
  drawFrame(commands_.get(), commands_, frame + 1, texturesOf(frame + 1), wholeArea(), second);
  commands_.run();
  PointResult after = read(texturesOf(frame + 1), frame + 1);
  const HostDesc now = std::exchange(desc_, before);
  PointResult earlier = read(old[frame % kFramesTogether], frame);
  desc_ = now;
  return {std::move(earlier), std::move(after)};
}

class D3d12Host::Calls : public FrameCalls {
 public:
  Calls(D3d12Host& host, PointTextures& textures) : host_(host), commands_(host.commands_.get()), textures_(textures) {}

  void begin(const VitrailRect& area) override {
    begun = host_.frame_++;
    host_.begin(commands_, *begun, area);
  }
  void draw(std::span<const Point> points) override { host_.drawPoints(commands_, host_.commands_, textures_, points); }
  void collected() override { vitrailD3d12Collected(host_.target_, commands_); }
  void copyLists(const CopyAttempt& attempt) override {
    if (!copied_) {
      bytes_ = vitrailD3d12CopySize(host_.target_, 4, 4);
      const std::vector<std::byte> untouched(bytes_, kUntouched);
      copied_ = device().makeBuffer(bytes_, D3D12_HEAP_TYPE_READBACK);
      void* mapped = nullptr;
      check(copied_->Map(0, nullptr, &mapped), "ID3D12Resource::Map");
      std::memcpy(mapped, untouched.data(), bytes_);
      copied_->Unmap(0, nullptr);
    }
    VitrailD3d12CopyInfo info{};
    info.area = attempt.area;
    if (attempt.hasBuffer) info.buffer = copied_.get();
    info.offset = attempt.offset;
    info.size = attempt.size.value_or(bytes_ - attempt.offset);
    vitrailD3d12CopyLists(host_.target_, commands_, &info);
  }
  void resolve(std::optional<std::uint32_t> view) override {
    const auto own = static_cast<std::uint64_t>(&textures_ - host_.textures_.data());
    // All views are ready to be taken, whichever it is.
    for (PointTextures& other : host_.textures_) {
      if (host_.desc_.resolve != VITRAIL_RESOLVE_FRAGMENT) host_.setForResolve(commands_, other);
    }
    host_.resolve(commands_, textures_, view ? *view : own);
  }
  void end() override { vitrailD3d12End(host_.target_, commands_); }
  void resize() override {
    VitrailD3d12ResizeInfo info{};
    info.width = host_.desc_.width;
    info.height = host_.desc_.height;
    info.views = host_.views();
    if (vitrailD3d12ResizeTarget(host_.target_, &info) != VITRAIL_SUCCESS) throw HostError("vitrailD3d12ResizeTarget");
  }

  [[nodiscard]] bool hasCopied() const {
    if (!copied_) return false;
    void* mapped = nullptr;
    check(copied_->Map(0, nullptr, &mapped), "ID3D12Resource::Map");
    const auto* bytes = static_cast<const std::byte*>(mapped);
    const bool any = std::any_of(bytes, bytes + bytes_, [](std::byte byte) { return byte != kUntouched; });
    copied_->Unmap(0, nullptr);
    return any;
  }

  std::optional<std::uint64_t> begun;

 private:
  static constexpr std::byte kUntouched{0x5a};

  D3d12Host& host_;
  ID3D12GraphicsCommandList* commands_;
  PointTextures& textures_;
  Com<ID3D12Resource> copied_;
  std::uint64_t bytes_ = 0;
};

CallsResult D3d12Host::drawCalls(const std::function<void(FrameCalls&)>& make) {
  PointTextures& textures = texturesOf(frame_);
  drawOpaque(commands_.get(), textures);
  Calls calls(*this, textures);
  make(calls);
  CallsResult result{pixels(textures), std::nullopt, calls.hasCopied()}; // which waits
  if (calls.begun) result.stats = stats(*calls.begun);
  return result;
}

PointResult D3d12Host::drawAreas(std::span<const Point> points, const NextArea& next) {
  PointTextures& textures = textures_[0];
  drawOpaque(commands_.get(), textures);
  VitrailStats stats{};
  VitrailRect area{};
  for (bool more = next(nullptr, area); more; more = next(&stats, area)) {
    const std::uint64_t frame = frame_++;
    drawFrame(commands_.get(), commands_, frame, textures, area, points);
    commands_.run();
    const auto counted = this->stats(frame);
    if (!counted) throw HostError("the statistics of frame " + std::to_string(frame) + " are not there");
    stats = *counted;
  }
  return {pixels(textures), stats};
}

// ---- The host's own memory

std::uint64_t D3d12Host::placeOf(const StoragePart& part) const {
  if (part.offset == storage_.parameters.offset) return kFirst;
  if (part.offset == storage_.control.offset) return kFirst + kHeapOffsets[1];
  return kFirst + kHeapOffsets[2] + offsetInLists(storage_, part);
}

std::vector<std::byte> D3d12Host::readMemory() const { return device().read(memory_.get(), memoryBytes_); }

void D3d12Host::writeMemory(std::uint64_t offset, std::span<const std::byte> bytes) {
  CommandList commands;
  const Com<ID3D12Resource> source = device().upload(bytes);
  transition(commands.get(), memory_.get(), D3D12_RESOURCE_STATE_COMMON, D3D12_RESOURCE_STATE_COPY_DEST);
  commands->CopyBufferRegion(memory_.get(), offset, source.get(), 0, bytes.size());
  commands.run();
}

PointResult D3d12Host::drawScattered(std::span<const Point> points) {
  const std::uint64_t frame = frame_++;
  PointTextures& textures = texturesOf(frame);
  drawOpaque(commands_.get(), textures);
  begin(commands_.get(), frame, wholeArea());
  drawPoints(commands_.get(), commands_, textures, points);
  commands_.run();
  const std::vector<std::byte> memory = readMemory();
  std::vector<std::byte> copy(storage_.total);
  for (const auto part : kParts) {
    std::memcpy(copy.data() + (storage_.*part).offset, memory.data() + placeOf(storage_.*part), (storage_.*part).size);
  }
  scatterNodes(desc_, storage_, copy);
  for (const auto part : kParts) {
    writeMemory(placeOf(storage_.*part), std::span(copy).subspan((storage_.*part).offset, (storage_.*part).size));
  }
  vitrailD3d12Collected(target_, commands_.get());
  resolve(commands_.get(), textures, frame % kFramesTogether);
  vitrailD3d12End(target_, commands_.get());
  commands_.run();
  return read(textures, frame);
}

std::vector<std::uint32_t> D3d12Host::words(StoragePart StorageLayout::*part) {
  const std::vector<std::byte> memory = readMemory();
  std::vector<std::uint32_t> words((storage_.*part).size / sizeof(std::uint32_t));
  std::memcpy(words.data(), memory.data() + placeOf(storage_.*part), words.size() * sizeof(std::uint32_t));
  return words;
}

// All that is none of the library's three buffers: before, between and behind them.
bool D3d12Host::guardsUntouched() {
  const std::vector<std::byte> memory = readMemory();
  const std::array<std::uint64_t, kD3d12Parts> sizes = {kConstantsBytes, sizeof(layout::VitrailControl),
                                                        listsBytes(storage_)};
  std::uint64_t at = 0;
  bool untouched = true;
  const auto look = [&](std::uint64_t end) {
    for (; at < end; at += sizeof(std::uint32_t)) {
      std::uint32_t word = 0;
      std::memcpy(&word, memory.data() + at, sizeof(word));
      untouched = untouched && word == kGuard;
    }
  };
  for (std::size_t i = 0; i < kD3d12Parts; ++i) {
    look(kFirst + kHeapOffsets.at(i));
    at += (sizes.at(i) + 3) / 4 * 4;
  }
  look(memoryBytes_);
  return untouched;
}

// ---- Reading lists

void D3d12Host::walk(ID3D12GraphicsCommandList* commands, const VitrailRect& area, ID3D12Resource* buffer) {
  const std::array<std::uint32_t, 8> constants = {area.x, area.y, area.width, area.height, kMostWalked};
  commands->SetComputeRootSignature(backend_.walkRoot());
  commands->SetPipelineState(backend_.walk(desc_.resolve == VITRAIL_RESOLVE_HOST ? "walk_sorted" : "walk"));
  commands->SetComputeRoot32BitConstants(0, countOf(constants), constants.data(), 0);
  commands->SetComputeRootUnorderedAccessView(1, buffer->GetGPUVirtualAddress());
  vitrailD3d12BindLists(target_, commands, 2, 1);
  commands->Dispatch((area.width + 7) / 8, (area.height + 7) / 8, 1);
  vitrailD3d12UnbindLists(target_, commands);
}

ListsRead D3d12Host::drawAndRead(std::span<const Point> points, const VitrailRect& area, ReadBy by, bool afterResolve) {
  const std::uint64_t frame = frame_++;
  PointTextures& textures = texturesOf(frame);
  ID3D12GraphicsCommandList* commands = commands_.get();
  const std::uint64_t pixelCount = std::uint64_t{area.width} * area.height;
  const std::uint64_t bytes = by == ReadBy::Shader ? pixelCount * (2 + 8 * std::uint64_t{kMostWalked}) * 4
                                                   : vitrailD3d12CopySize(target_, area.width, area.height);
  const auto buffer = device().makeBuffer(bytes, D3D12_HEAP_TYPE_DEFAULT, D3D12_RESOURCE_FLAG_ALLOW_UNORDERED_ACCESS);
  const auto readLists = [&] {
    if (by == ReadBy::Shader) {
      transition(commands, buffer.get(), D3D12_RESOURCE_STATE_COMMON, D3D12_RESOURCE_STATE_UNORDERED_ACCESS);
      return walk(commands, area, buffer.get());
    }
    transition(commands, buffer.get(), D3D12_RESOURCE_STATE_COMMON, D3D12_RESOURCE_STATE_COPY_DEST);
    VitrailD3d12CopyInfo info{};
    info.area = area;
    info.buffer = buffer.get();
    info.size = bytes;
    vitrailD3d12CopyLists(target_, commands, &info);
  };
  update(frame);
  drawOpaque(commands, textures);
  begin(commands, frame, wholeArea());
  drawPoints(commands, commands_, textures, points);
  vitrailD3d12Collected(target_, commands);
  if (!afterResolve) readLists();
  resolve(commands, textures, frame % kFramesTogether);
  if (afterResolve) readLists();
  vitrailD3d12End(target_, commands);
  commands_.run();
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

// In a command list that is never executed.
void D3d12Host::drop(std::span<const Point> points) {
  const std::uint64_t frame = frame_++;
  update(frame);
  CommandList commands;
  PointTextures& textures = texturesOf(frame);
  const std::array states = {textures.color.state, textures.multisampled.state, textures.depth.state};
  drawOpaque(commands.get(), textures);
  drawFrame(commands.get(), commands, frame, textures, wholeArea(), points);
  textures.color.state = states[0];
  textures.multisampled.state = states[1];
  textures.depth.state = states[2];
}

} // namespace vitrail::tests::d3d12
