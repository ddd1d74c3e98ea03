// Creation, resizing and destruction of a target, and what it tells.
#include "target.h"

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

#include "core/target_common.h"

namespace vitrail {

namespace {

TargetInfo targetInfo(const VitrailD3d11TargetDesc& desc) {
  TargetInfo info = infoOf(desc);
  info.ownBuffer = desc.buffers != nullptr;
  info.bufferSize = UINT64_MAX; // D3d11Storage looks at each buffer
  info.canStoreColor = desc.views.color != nullptr;
  info.hasStencil = true; // the depth-stencil view may have one
  return info;
}

void keepViews(VitrailD3d11Target_T& target, const VitrailD3d11Views& views) {
  keepViewsOf(target.views, views);
  target.viewCount = views.count;
}

DXGI_FORMAT colorFormatOf(const VitrailD3d11TargetDesc& desc) {
  return desc.colorFormat != 0 ? static_cast<DXGI_FORMAT>(desc.colorFormat) : DXGI_FORMAT_R16G16B16A16_FLOAT;
}

// Whether the colour views are what a compute resolve of one sample copies from.
VitrailResult checkColors(const Log& log, const TargetInfo& info, DXGI_FORMAT format, const VitrailD3d11Views& views) {
  if (info.resolve != VITRAIL_RESOLVE_COMPUTE) return VITRAIL_SUCCESS;
  for (std::uint32_t i = 0; i < views.count; ++i) {
    D3D11_UNORDERED_ACCESS_VIEW_DESC view{};
    views.color[i]->GetDesc(&view);
    Com<ID3D11Resource> resource;
    views.color[i]->GetResource(resource.out());
    Com<ID3D11Texture2D> texture;
    if (FAILED(resource->QueryInterface(IID_PPV_ARGS(texture.out()))) ||
        view.ViewDimension != D3D11_UAV_DIMENSION_TEXTURE2D || view.Texture2D.MipSlice != 0) {
      return log.fail(VITRAIL_ERROR_INVALID, "views.color[%u] is not a view of level 0 of a 2D texture", i);
    }
    D3D11_TEXTURE2D_DESC desc{};
    texture->GetDesc(&desc);
    if (view.Format != format || desc.Format != format) {
      return log.fail(VITRAIL_ERROR_FORMAT,
                      "views.color[%u]: the view has format %d, its texture %d, colorFormat is %d", i,
                      static_cast<int>(view.Format), static_cast<int>(desc.Format), static_cast<int>(format));
    }
    if (desc.Width < info.width || desc.Height < info.height) {
      return log.fail(VITRAIL_ERROR_INVALID, "views.color[%u] has %ux%u pixels, the target %ux%u", i, desc.Width,
                      desc.Height, info.width, info.height);
    }
  }
  return VITRAIL_SUCCESS;
}

// What a target has beside the lists and the slots for statistics: small buffers, and what createBehind() makes.
std::uint64_t bytesBeside(const TargetInfo& info, DXGI_FORMAT format) {
  constexpr std::uint64_t kSmallBuffers =
      sizeof(layout::VitrailControl) + sizeof(D3d11Stamp) + sizeof(KernelConstants) + 16;
  if (info.resolve != VITRAIL_RESOLVE_COMPUTE || info.samples != 1) return kSmallBuffers;
  const std::uint64_t pixel = format == DXGI_FORMAT_R32G32B32A32_FLOAT ? 16 : 8;
  return kSmallBuffers + std::uint64_t{info.width} * info.height * pixel;
}

// The target with its defaults, and with what its budget leaves for its lists.
TargetInfo describe(const VitrailD3d11Context_T& context, const VitrailD3d11TargetDesc& desc) {
  const TargetInfo info = withDefaults(context.limits, targetInfo(desc));
  return underBudget(info, desc.memoryBudget, bytesBeside(info, colorFormatOf(desc)));
}

VitrailResult checkDesc(const VitrailD3d11Context_T& context, const VitrailD3d11TargetDesc& desc,
                        const TargetInfo& info) {
  VitrailResult result = checkTarget(context.limits, context.log, info);
  if (result != VITRAIL_SUCCESS) return result;
  const DXGI_FORMAT format = colorFormatOf(desc);
  if (info.resolve == VITRAIL_RESOLVE_COMPUTE && format != DXGI_FORMAT_R16G16B16A16_FLOAT &&
      format != DXGI_FORMAT_R32G32B32A32_FLOAT) {
    return context.log.fail(VITRAIL_ERROR_FORMAT,
                            "colorFormat %d: a compute resolve writes DXGI_FORMAT_R16G16B16A16_FLOAT or "
                            "DXGI_FORMAT_R32G32B32A32_FLOAT",
                            static_cast<int>(format));
  }
  if (desc.stencilMask > 0xffU) {
    return context.log.fail(VITRAIL_ERROR_INVALID, "stencilMask 0x%x: a stencil has 8 bits", desc.stencilMask);
  }
  result = checkViews(context.log, info, infoOfViews(desc.views));
  return result == VITRAIL_SUCCESS ? checkColors(context.log, info, format, desc.views) : result;
}

// ---- What a target is made of

VitrailResult refused(const Log& log, const char* what, HRESULT result) {
  return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "no %s: Direct3D says 0x%08lx", what,
                  static_cast<unsigned long>(result));
}

VitrailResult findShaders(VitrailD3d11Target_T& target) {
  VitrailD3d11Context_T& context = *target.context;
  const TargetInfo& info = target.info;
  for (const Pass& pass : target.plan.passes()) {
    D3d11Shader& shader = target.shaders.emplace_back();
    VitrailResult result = VITRAIL_SUCCESS;
    if (pass.action == Action::Dispatch) {
      const bool several = pass.call == Call::Resolve && info.samples > 1;
      result = findShader(context, kernelBytecode(pass.kernel, several, info.nodeFormat), kernelName(pass.kernel),
                          shader.compute);
    } else if (pass.action == Action::Draw || pass.action == Action::DrawPlain) {
      const FragmentResolve resolve = pass.action == Action::DrawPlain
                                          ? FragmentResolve::Plain
                                          : fragmentResolve(info, !target.severalRenderTargets);
      result = findShader(context, pixelBytecode(resolve, info.nodeFormat), "fragment resolve", shader.pixel);
    }
    if (result != VITRAIL_SUCCESS) return result;
  }
  return VITRAIL_SUCCESS;
}

VitrailResult createConstants(VitrailD3d11Target_T& target) {
  const TargetInfo& info = target.info;
  const KernelConstants constants{info.samples, info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? 1U : 0U,
                                  info.maxLayers, info.testsDepth() ? 1U : 0U};
  D3D11_BUFFER_DESC desc{};
  desc.ByteWidth = sizeof(constants);
  desc.Usage = D3D11_USAGE_IMMUTABLE;
  desc.BindFlags = D3D11_BIND_CONSTANT_BUFFER;
  return createBuffer(*target.context, desc, &constants, target.debugName.c_str(), "constants", target.constants);
}

// What a fragment resolve draws with.
VitrailResult createDrawState(VitrailD3d11Target_T& target, UINT stencilMask) {
  ID3D11Device* device = target.context->device.get();
  const TargetInfo& info = target.info;
  // C + T * d: one alpha for all channels, or a transmittance of their own. What is written whole is not blended.
  const bool dual = !target.severalRenderTargets;
  D3D11_BLEND_DESC blend{};
  blend.IndependentBlendEnable = TRUE; // other render targets: no channel is written
  D3D11_RENDER_TARGET_BLEND_DESC& first = blend.RenderTarget[0];
  first.BlendEnable = info.perPixel() ? FALSE : TRUE;
  first.SrcBlend = D3D11_BLEND_ONE;
  first.DestBlend = dual ? D3D11_BLEND_SRC1_COLOR : D3D11_BLEND_INV_SRC_ALPHA;
  first.BlendOp = D3D11_BLEND_OP_ADD;
  first.SrcBlendAlpha = D3D11_BLEND_ONE;
  first.DestBlendAlpha = dual ? D3D11_BLEND_SRC1_ALPHA : D3D11_BLEND_INV_SRC_ALPHA;
  first.BlendOpAlpha = D3D11_BLEND_OP_ADD;
  first.RenderTargetWriteMask = D3D11_COLOR_WRITE_ENABLE_ALL;
  for (std::size_t i = 1; i < D3D11_SIMULTANEOUS_RENDER_TARGET_COUNT; ++i) {
    blend.RenderTarget[i] = first;
    blend.RenderTarget[i].BlendEnable = FALSE;
    blend.RenderTarget[i].DestBlend = D3D11_BLEND_ZERO;
    blend.RenderTarget[i].DestBlendAlpha = D3D11_BLEND_ZERO;
    blend.RenderTarget[i].RenderTargetWriteMask = 0;
  }
  if (info.perPixel()) first.DestBlend = first.DestBlendAlpha = D3D11_BLEND_ZERO;
  D3D11_DEPTH_STENCIL_DESC test{};
  test.DepthFunc = D3D11_COMPARISON_ALWAYS;
  test.StencilEnable = info.stencilMark ? TRUE : FALSE;
  test.StencilReadMask = static_cast<UINT8>(stencilMask);
  test.FrontFace = {D3D11_STENCIL_OP_KEEP, D3D11_STENCIL_OP_KEEP, D3D11_STENCIL_OP_KEEP, D3D11_COMPARISON_NOT_EQUAL};
  test.BackFace = test.FrontFace;
  D3D11_RASTERIZER_DESC raster{};
  raster.FillMode = D3D11_FILL_SOLID;
  raster.CullMode = D3D11_CULL_NONE;
  raster.DepthClipEnable = TRUE;
  raster.ScissorEnable = TRUE;
  raster.MultisampleEnable = info.perSample() ? TRUE : FALSE;
  HRESULT result = device->CreateBlendState(&blend, target.blending.out());
  if (SUCCEEDED(result)) result = device->CreateDepthStencilState(&test, target.testing.out());
  if (SUCCEEDED(result)) result = device->CreateRasterizerState(&raster, target.rasterizing.out());
  return SUCCEEDED(result) ? VITRAIL_SUCCESS : refused(target.context->log, "state object", result);
}

// The texture that a compute resolve of one sample reads what is behind from.
VitrailResult createBehind(const VitrailD3d11Target_T& target, const TargetInfo& info, Com<ID3D11Texture2D>& texture,
                           Com<ID3D11ShaderResourceView>& view) {
  if (info.resolve != VITRAIL_RESOLVE_COMPUTE || info.samples != 1) return VITRAIL_SUCCESS;
  D3D11_TEXTURE2D_DESC desc{};
  desc.Width = info.width;
  desc.Height = info.height;
  desc.MipLevels = 1;
  desc.ArraySize = 1;
  desc.Format = target.colorFormat;
  desc.SampleDesc.Count = 1;
  desc.BindFlags = D3D11_BIND_SHADER_RESOURCE;
  ID3D11Device* device = target.context->device.get();
  HRESULT result = device->CreateTexture2D(&desc, nullptr, texture.out());
  if (SUCCEEDED(result)) result = device->CreateShaderResourceView(texture.get(), nullptr, view.out());
  if (FAILED(result)) return refused(target.context->log, "texture for the opaque colour", result);
  nameObject(texture.get(), target.debugName.c_str(), "opaque colour");
  return VITRAIL_SUCCESS;
}

VitrailResult createStats(VitrailD3d11Target_T& target) {
  const VitrailD3d11Context_T& context = *target.context;
  const char* name = target.debugName.c_str();
  D3D11_BUFFER_DESC desc{};
  desc.BindFlags = D3D11_BIND_SHADER_RESOURCE; // of which there must be one
  desc.MiscFlags = D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS;
  desc.ByteWidth = 16;
  VitrailResult result = createBuffer(context, desc, nullptr, name, "frame number", target.begun);
  if (result != VITRAIL_SUCCESS) return result;
  desc.ByteWidth = sizeof(D3d11Stamp);
  result = createBuffer(context, desc, nullptr, name, "frame facts", target.stamp);
  target.slots.resize(statisticsSlots(target.info.framesInFlight));
  target.statsBuffers.resize(target.slots.size());
  target.statsWritten.resize(target.slots.size());
  target.statsExpected.resize(target.slots.size());
  desc = {};
  desc.ByteWidth = sizeof(StatsSlot);
  desc.Usage = D3D11_USAGE_STAGING;
  desc.CPUAccessFlags = D3D11_CPU_ACCESS_READ;
  constexpr StatsSlot kNothing{};
  for (Com<ID3D11Buffer>& buffer : target.statsBuffers) {
    if (result != VITRAIL_SUCCESS) return result;
    result = createBuffer(context, desc, &kNothing, name, "statistics", buffer);
  }
  constexpr D3D11_QUERY_DESC kQuery{D3D11_QUERY_EVENT, 0};
  for (Com<ID3D11Query>& query : target.statsWritten) {
    if (result != VITRAIL_SUCCESS) return result;
    const HRESULT made = context.device->CreateQuery(&kQuery, query.out());
    if (FAILED(made)) return refused(context.log, "query for statistics", made);
  }
  return result;
}

VitrailResult replaceStorage(VitrailD3d11Target_T& target, const StorageNeeds& needs,
                             ID3D11Buffer* const* hostBuffers = nullptr) {
  D3d11Storage made;
  const VitrailResult result = made.create(*target.context, needs, hostBuffers, target.debugName.c_str());
  if (result != VITRAIL_SUCCESS) return result;
  target.storage = std::move(made); // frames in flight keep the old buffers as long as they need them
  target.sums.reset();
  return VITRAIL_SUCCESS;
}

VitrailResult buildTarget(VitrailD3d11Target_T& target, const VitrailD3d11TargetDesc& desc) {
  target.plan = FramePlan(planFacts(target.context->limits, target.info));
  VitrailResult result = findShaders(target);
  if (result == VITRAIL_SUCCESS) result = createConstants(target);
  if (result == VITRAIL_SUCCESS && target.info.resolve == VITRAIL_RESOLVE_FRAGMENT) {
    constexpr UINT kAllBits = 0xff;
    result = createDrawState(target, desc.stencilMask != 0 ? desc.stencilMask : kAllBits);
  }
  if (result == VITRAIL_SUCCESS) result = createBehind(target, target.info, target.behind, target.behindView);
  if (result == VITRAIL_SUCCESS) result = createStats(target);
  if (result != VITRAIL_SUCCESS) return result;
  return replaceStorage(target, storageNeeds(target.context->limits, target.info), desc.buffers);
}

std::unique_ptr<VitrailD3d11Target_T> makeTarget(VitrailD3d11Context context, const VitrailD3d11TargetDesc& desc,
                                                 const TargetInfo& info) {
  std::unique_ptr<VitrailD3d11Target_T> made(new (std::nothrow) VitrailD3d11Target_T);
  if (!made) return nullptr;
  made->context = context;
  ++context->owners;
  made->info = info;
  made->info.nodeCapacity = capacityWithin(context->limits, info);
  made->colorFormat = colorFormatOf(desc);
  made->memoryBudget = desc.memoryBudget;
  made->hostBuffers = desc.buffers != nullptr;
  made->severalRenderTargets = desc.severalRenderTargets != 0;
  made->debugName = desc.debugName != nullptr ? desc.debugName : "vitrail";
  keepViews(*made, desc.views);
  return made;
}

// ---- Statistics

void fetch(VitrailD3d11Target_T& target, std::size_t slot) {
  Com<ID3D11DeviceContext> immediate;
  target.context->device->GetImmediateContext(immediate.out());
  fetchStats(target, immediate.get(), slot, true);
}

bool readFrame(VitrailD3d11Target_T& target, std::uint64_t frame, VitrailStats& stats) {
  const std::size_t slot = target.slotOf(frame);
  fetch(target, slot);
  return readSlot(target.slots[slot], frame, {static_cast<std::uint32_t>(target.info.nodeFormat), target.info.samples},
                  stats);
}

// The statistics of the newest finished frame, of `frame` and those before it that still have a slot.
bool readNewest(VitrailD3d11Target_T& target, std::uint64_t frame, VitrailStats& stats) {
  return readNewestOf(frame, target.slots.size(), [&](std::uint64_t one) { return readFrame(target, one, stats); });
}

} // namespace

} // namespace vitrail

extern "C" VitrailResolve vitrailD3d11DefaultResolve(VitrailD3d11Context context, const VitrailD3d11TargetDesc* desc) {
  if (context == nullptr || desc == nullptr) {
    vitrail::nullArgument(context, "vitrailD3d11DefaultResolve");
    return VITRAIL_RESOLVE_DEFAULT;
  }
  return vitrail::defaultResolve(vitrail::targetInfo(*desc));
}

extern "C" VitrailListBuild vitrailD3d11DefaultListBuild(VitrailD3d11Context context,
                                                         const VitrailD3d11TargetDesc* desc) {
  if (context == nullptr || desc == nullptr) {
    vitrail::nullArgument(context, "vitrailD3d11DefaultListBuild");
    return VITRAIL_LIST_BUILD_DEFAULT;
  }
  return vitrail::defaultListBuild(context->limits, vitrail::targetInfo(*desc));
}

extern "C" VitrailResult vitrailD3d11TargetRequirements(VitrailD3d11Context context, const VitrailD3d11TargetDesc* desc,
                                                        VitrailD3d11Requirements* requirements) {
  using namespace vitrail;
  if (requirements != nullptr) clearKeepingNext(*requirements);
  if (context == nullptr || desc == nullptr || requirements == nullptr) {
    return nullArgument(context, "vitrailD3d11TargetRequirements");
  }
  VitrailResult result = checkNoNext(context->log, desc->next, "VitrailD3d11TargetDesc");
  if (result != VITRAIL_SUCCESS) return result;
  const TargetInfo info = describe(*context, *desc);
  result = checkMemory(context->limits, context->log, info);
  if (result != VITRAIL_SUCCESS) return result;
  const auto sizes = bufferSizes(layoutStorage(storageNeeds(context->limits, info)));
  std::copy(sizes.begin(), sizes.end(), requirements->sizes);
  return VITRAIL_SUCCESS;
}

extern "C" VitrailResult vitrailD3d11CreateTarget(VitrailD3d11Context context, const VitrailD3d11TargetDesc* desc,
                                                  VitrailD3d11Target* target) {
  using namespace vitrail;
  if (target != nullptr) *target = nullptr;
  if (context == nullptr || desc == nullptr || target == nullptr) {
    return nullArgument(context, "vitrailD3d11CreateTarget");
  }
  VitrailResult result = checkNoNext(context->log, desc->next, "VitrailD3d11TargetDesc");
  if (result != VITRAIL_SUCCESS) return result;
  const TargetInfo info = describe(*context, *desc);
  result = checkDesc(*context, *desc, info);
  if (result != VITRAIL_SUCCESS) return result;
  std::unique_ptr<VitrailD3d11Target_T> made = makeTarget(context, *desc, info);
  if (!made) return context->log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "no memory for a target");
  result = buildTarget(*made, *desc);
  if (result != VITRAIL_SUCCESS) {
    vitrailD3d11DestroyTarget(made.release());
    return result; // the log has the reason
  }
  *target = made.release();
  return VITRAIL_SUCCESS;
}

extern "C" void vitrailD3d11DestroyTarget(VitrailD3d11Target target) {
  if (target == nullptr) return;
  const VitrailD3d11Context context = target->context;
  delete target; // before what it has of the context
  vitrail::releaseContext(context);
}

extern "C" VitrailResult vitrailD3d11UpdateTarget(VitrailD3d11Target target, uint64_t frame) {
  using namespace vitrail;
  if (target == nullptr) return VITRAIL_ERROR_INVALID;
  // A number that is too large says nothing of frames that were never begun.
  const std::uint64_t number = std::min(target->frames.numberOf(frame), target->frames.numberOf(0));
  const std::uint32_t wanted =
      wantedCapacity(target->growth, target->context->limits, target->info, target->storage.needs.nodeCapacity,
                     [&](VitrailStats& stats) { return readNewest(*target, number, stats); });
  if (wanted == target->storage.needs.nodeCapacity) return VITRAIL_SUCCESS;
  StorageNeeds needs = target->storage.needs;
  needs.nodeCapacity = wanted;
  const VitrailResult result = replaceStorage(*target, needs);
  if (result != VITRAIL_SUCCESS) return result;
  target->order.drop(target->context->log, "vitrailD3d11UpdateTarget() gives the target another pool");
  return VITRAIL_SUCCESS;
}

extern "C" VitrailResult vitrailD3d11ResizeTarget(VitrailD3d11Target target, const VitrailD3d11ResizeInfo* info) {
  using namespace vitrail;
  if (target == nullptr || info == nullptr) {
    return nullArgument(target != nullptr ? target->context : nullptr, "vitrailD3d11ResizeTarget");
  }
  const VitrailD3d11Context_T& context = *target->context;
  VitrailResult result = checkNoNext(context.log, info->next, "VitrailD3d11ResizeInfo");
  if (result != VITRAIL_SUCCESS) return result;
  if (target->hostBuffers) {
    return context.log.fail(VITRAIL_ERROR_INVALID, "a target in the host's memory cannot be resized: make another one");
  }
  TargetInfo present = target->info;
  present.width = info->width; // as far as the budget is concerned
  present.height = info->height;
  present = underBudget(present, target->memoryBudget, bytesBeside(present, target->colorFormat));
  present.width = target->info.width;
  present.height = target->info.height;
  TargetInfo wanted = resized(present, target->storage.needs.nodeCapacity, info->width, info->height,
                              info->nodeCapacity, info->areaPixels);
  result = checkTarget(context.limits, context.log, wanted);
  if (result == VITRAIL_SUCCESS) result = checkViews(context.log, wanted, infoOfViews(info->views));
  if (result == VITRAIL_SUCCESS) result = checkColors(context.log, wanted, target->colorFormat, info->views);
  Com<ID3D11Texture2D> behind;
  Com<ID3D11ShaderResourceView> behindView;
  if (result == VITRAIL_SUCCESS) result = createBehind(*target, wanted, behind, behindView);
  if (result != VITRAIL_SUCCESS) return result;
  wanted.nodeCapacity = capacityWithin(context.limits, wanted);
  result = replaceStorage(*target, storageNeeds(context.limits, wanted));
  if (result != VITRAIL_SUCCESS) return result;
  target->order.drop(context.log, "vitrailD3d11ResizeTarget()");
  target->info = wanted;
  target->behind = std::move(behind);
  target->behindView = std::move(behindView);
  keepViews(*target, info->views);
  target->growth.forget();
  return VITRAIL_SUCCESS;
}

extern "C" VitrailResolve vitrailD3d11TargetResolve(VitrailD3d11Target target) {
  return target != nullptr ? target->info.resolve : VITRAIL_RESOLVE_DEFAULT;
}

extern "C" VitrailListBuild vitrailD3d11TargetListBuild(VitrailD3d11Target target) {
  return target != nullptr ? target->info.listBuild : VITRAIL_LIST_BUILD_DEFAULT;
}

extern "C" uint64_t vitrailD3d11TargetFrame(VitrailD3d11Target target) {
  return target != nullptr ? target->frames.newest() : 0;
}

extern "C" void vitrailD3d11TargetMemory(VitrailD3d11Target target, VitrailMemory* memory) {
  if (memory != nullptr) vitrail::clearKeepingNext(*memory);
  if (target == nullptr || memory == nullptr) {
    vitrail::nullArgument(target != nullptr ? target->context : nullptr, "vitrailD3d11TargetMemory");
    return;
  }
  const std::uint64_t beside =
      vitrail::statisticsBytes(target->info.framesInFlight) + vitrail::bytesBeside(target->info, target->colorFormat);
  vitrail::tellMemory(*memory, target->storage.needs, target->storage.layout, beside, 0);
}

extern "C" uint64_t vitrailD3d11CopySize(VitrailD3d11Target target, uint32_t width, uint32_t height) {
  if (target == nullptr) return 0;
  return vitrail::copyBytes(std::uint64_t{width} * height, target->info.copyLayers);
}

extern "C" void vitrailD3d11TilePlanTarget(VitrailTilePlan plan, VitrailD3d11TargetDesc* desc) {
  vitrail::tilePlanTarget(plan, desc);
}

extern "C" VitrailResult vitrailD3d11ReadStats(VitrailD3d11Target target, uint64_t frame, VitrailStats* stats) {
  using namespace vitrail;
  if (target == nullptr || stats == nullptr) {
    if (stats != nullptr) clearKeepingNext(*stats);
    return nullArgument(target != nullptr ? target->context : nullptr, "vitrailD3d11ReadStats");
  }
  const bool newest = frame == 0 && !target->frames.areGiven();
  const bool read = newest ? readNewest(*target, target->frames.newest(), *stats) : readFrame(*target, frame, *stats);
  return read ? VITRAIL_SUCCESS : VITRAIL_INCOMPLETE;
}
