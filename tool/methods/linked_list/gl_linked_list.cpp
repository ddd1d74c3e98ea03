// The method linked-list (linked_list.cpp) with OpenGL: libvitrail as any host of vitrail/gl.h embeds it.
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <epoxy/egl.h>

#include "../../opengl/bindings.h"
#include "../gl_method.h"
#include "../methods.h"
#include "../shared/library_log.h"
#include "files/gl_collect.frag.h"
#include "files/gl_collect_media.frag.h"
#include "gl_media.h"
#include "list_picture.h"

namespace vitrail::tool {

namespace {

void* functionNamed(const char* name, void* /*user*/) { return reinterpret_cast<void*>(eglGetProcAddress(name)); }

class GlLinkedList final : public GlMethod, private ListPicture {
 public:
  GlLinkedList(const GlMethodHost& host, const MethodOptions& options);
  ~GlLinkedList() override;

  GlImageNeeds needs() const override { return needs_; }
  void setTarget(const GlMethodTarget& target) override;
  void releaseTarget() override;
  void draw(GlFrame& frame) override;
  bool finish() override { return finishPicture(); }
  FrameStats stats() const override;

 private:
  bool makeTarget(const ListPool& pool) override;
  VitrailResult updateTarget() override;
  std::optional<VitrailMemory> memory() const override;
  std::uint64_t mostNodes() const override { return context_.maxNodeCapacity(options_.nodes, options_.samples); }
  VitrailTileLimits tileLimits() const override;
  void drawArea(const VitrailRect& area, std::span<const SurfaceRun> runs) override;
  void wait() override { drawn_->wait(); }
  VitrailStats readStats() const override;

  void makeContext();
  void chooseResolve();
  void makeSurfaces();
  VitrailGlTargetDesc targetDesc() const;
  void countMemory();
  bool writesEveryPixel() const { return options_.samples > 1 && !needs_.perSample; }
  bool coverageIsTested() const { return options_.samples > 1 && gl_.limits().postDepthCoverage; }
  void collect(std::span<const SurfaceRun> runs);
  void resolve(const VitrailRect& area);

  Gl& gl_;
  const GlSurfaces& source_;
  MethodOptions options_;
  GlImageNeeds needs_;
  opengl::Context context_;
  std::optional<GlMedia> media_; // where objects absorb light: what resolves the lists then
  VitrailListBuild listBuild_ = VITRAIL_LIST_BUILD_DEFAULT;
  bool depthFromW_ = false; // collect.frag
  std::optional<GlSurfacePrograms> surfaces_;
  opengl::Target target_;
  std::uint64_t frame_ = 0; // of the target: rises with every area
  ListPool made_;           // what target_ was made for
  const GlImages* images_ = nullptr;
  std::optional<std::uint64_t> memoryBudget_;
  GlFrame* drawn_ = nullptr;  // the frame at hand
  std::uint64_t counted_ = 0; // the target's bytes, as the Gl counts them
};

GlLinkedList::GlLinkedList(const GlMethodHost& host, const MethodOptions& options)
    : ListPicture(host.surfaces.list(), options_), gl_(host.gl), source_(host.surfaces), options_(options) {
  makeContext();
  // With a bound on the layers only the nearest are drawn as they are: then objects are as thick as their files say.
  if (source_.scene().solids().any() && options_.maxLayers == 0) {
    media_.emplace(host, context_.listSource(), options_.samples);
  }
  chooseResolve();
}

GlLinkedList::~GlLinkedList() { gl_.memoryFreed(counted_); }

void GlLinkedList::makeContext() {
  VitrailGlContextDesc desc{};
  desc.getProcAddress = functionNamed;
  desc.log = rememberError;
  desc.logUser = &reason();
  check(opengl::Context::create(desc, context_), "vitrailGlCreateContext");
}

void GlLinkedList::chooseResolve() {
  if (media_) {
    requireWalk(options_);
    options_.resolve = VITRAIL_RESOLVE_COMPUTE;
    options_.msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
    return;
  }
  needs_.perSample = options_.samples > 1 && options_.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  if (options_.resolve == VITRAIL_RESOLVE_DEFAULT) {
    VitrailGlTargetDesc target = targetDesc();
    const std::uint32_t any = 1;
    target.textures = {1, &any, nullptr, nullptr}; // the picture can be written by compute
    options_.resolve = context_.defaultResolve(target);
  }
  const bool drawn = options_.resolve == VITRAIL_RESOLVE_FRAGMENT;
  requireMark(options_, drawn);
  needs_.stencil = drawn && (options_.samples == 1 || needs_.perSample) && options_.stencilMark == StencilMark::On;
}

// The programs for the picture that is wanted, where there are none yet or others.
void GlLinkedList::makeSurfaces() {
  VitrailGlTargetDesc desc = targetDesc();
  desc.listBuild =
      options_.listBuild != VITRAIL_LIST_BUILD_DEFAULT ? options_.listBuild : context_.defaultListBuild(desc);
  // As linked_list.cpp has it.
  const bool spares = !gl_.isCpu() || desc.listBuild == VITRAIL_LIST_BUILD_COMPUTE;
  const bool depthFromW =
      spares && !media_ && source_.view().eye.w < 0.5F && (options_.samples == 1 || coverageIsTested());
  if (surfaces_ && listBuild_ == desc.listBuild && depthFromW_ == depthFromW) return;
  listBuild_ = desc.listBuild;
  depthFromW_ = depthFromW;
  std::string library;
  if (coverageIsTested())
    library += "#extension GL_ARB_post_depth_coverage : require\n#define VITRAIL_POST_DEPTH_COVERAGE\n";
  if (gl_.isCpu()) library += "#define VITRAIL_CPU_DRIVER\n";
  library += context_.collectSpecialization(desc).defines;
  library += context_.collectSource();
  surfaces_.emplace(
      source_, source_.scene().transparentDraws(), "collect",
      [&](std::uint32_t /*features*/) {
        ShaderText text{files::gl_collect_frag, library, constantLine("bool kDepthFromW", depthFromW)};
        if (media_) text.file = files::gl_collect_media_frag;
        return text;
      },
      media_.has_value());
}

// All but the memory and the textures.
VitrailGlTargetDesc GlLinkedList::targetDesc() const {
  VitrailGlTargetDesc desc{};
  desc.width = images_ != nullptr ? images_->info().width : 1;
  desc.height = images_ != nullptr ? images_->info().height : 1;
  desc.samples = options_.samples;
  desc.nodeFormat = options_.nodes;
  desc.depthOrder = VITRAIL_DEPTH_NEAREST_IS_ONE;
  desc.resolve = media_ ? VITRAIL_RESOLVE_HOST : options_.resolve;
  desc.userWords = media_ ? 1 : 0;
  desc.msaaResolve = options_.msaaResolve;
  desc.postDepthCoverage = coverageIsTested() ? 1 : 0;
  desc.maxLayers = options_.maxLayers;
  desc.listBuild = listBuild_;
  // Skipped, the picture is drawn again, with a larger pool or in tiles.
  desc.overflow = options_.nodeCapacity > 0 ? VITRAIL_OVERFLOW_APPROXIMATE : VITRAIL_OVERFLOW_SKIP;
  desc.colorFormat = GL_RGBA16F;
  desc.stencilMark = needs_.stencil ? 1 : 0;
  desc.framesInFlight = 1;
  return desc;
}

void GlLinkedList::setTarget(const GlMethodTarget& target) {
  if (media_) media_->setView(source_.view(), options_.samples == 1 || coverageIsTested());
  if (images_ != nullptr && memoryBudget_ == target.memoryBudget) {
    setOnTile(target.onTile);
    return makeSurfaces();
  }
  releaseTarget();
  images_ = target.images;
  memoryBudget_ = target.memoryBudget;
  makeSurfaces();
  start({.width = images_->info().width,
         .height = images_->info().height,
         .memoryBudget = target.memoryBudget,
         .surfaces = target.surfaces,
         .writesEveryPixel = writesEveryPixel(),
         .words = media_.has_value(),
         .listBuild = listBuild_,
         .onTile = target.onTile});
}

bool GlLinkedList::makeTarget(const ListPool& pool) {
  if (target_ && made_ == pool) return true; // the images are the same until releaseTarget()
  target_ = opengl::Target();                // first: the old pool and the new one need not fit together
  gl_.memoryFreed(std::exchange(counted_, 0));
  VitrailGlTargetDesc desc = targetDesc();
  desc.nodeCapacity = pool.nodeCapacity;
  desc.memoryBudget = pool.memoryBudget;
  desc.areaPixels = pool.areaPixels;
  const std::uint32_t color = images_->color();
  const std::uint32_t opaque = images_->multisampled();
  const std::uint32_t depth = images_->depth();
  if (!media_) {
    desc.textures.count = 1;
    desc.textures.color = &color;
    if (options_.samples > 1 && !needs_.perSample) desc.textures.opaque = &opaque;
    if (options_.samples > 1 && !coverageIsTested()) desc.textures.depth = &depth;
  }
  const VitrailResult result = opengl::Target::create(context_, desc, target_);
  if (result == VITRAIL_ERROR_OUT_OF_MEMORY) return false; // the reason stays, in case that it ends the program
  check(result, "vitrailGlCreateTarget");
  reason().clear();
  made_ = pool;
  countMemory();
  return true;
}

VitrailResult GlLinkedList::updateTarget() {
  const VitrailResult result = target_.update(frame_ + 1);
  countMemory();
  return result;
}

// What the target holds now, a pool that was replaced included.
void GlLinkedList::countMemory() {
  gl_.memoryFreed(std::exchange(counted_, target_.memory().totalBytes));
  gl_.memoryAllocated(counted_);
}

std::optional<VitrailMemory> GlLinkedList::memory() const {
  return target_ ? std::optional(target_.memory()) : std::nullopt;
}

VitrailTileLimits GlLinkedList::tileLimits() const {
  VitrailTileLimits limits{};
  check(context_.tileLimits(options_.nodes, options_.samples, limits), "vitrailGlTileLimits");
  return limits;
}

void GlLinkedList::releaseTarget() {
  target_ = opengl::Target();
  images_ = nullptr;
  gl_.memoryFreed(std::exchange(counted_, 0));
}

void GlLinkedList::draw(GlFrame& frame) {
  drawn_ = &frame;
  drawPicture();
}

void GlLinkedList::drawArea(const VitrailRect& area, std::span<const SurfaceRun> runs) {
  VitrailGlBeginInfo begin{};
  begin.frame = ++frame_;
  begin.area = area;
  target_.begin(begin);
  drawn_->endPass("clear");
  images_->bindDepthAlone();
  glEnable(GL_SCISSOR_TEST); // fragments beside the area are not collected, and not shaded
  glScissor(static_cast<GLint>(area.x), static_cast<GLint>(area.y), static_cast<GLsizei>(area.width),
            static_cast<GLsizei>(area.height));
  target_.bind();
  collect(runs);
  if (listBuild_ == VITRAIL_LIST_BUILD_COMPUTE) drawn_->endPass("collect");
  target_.collected();
  drawn_->endPass(listBuild_ == VITRAIL_LIST_BUILD_COMPUTE ? "build lists" : "collect");
  resolve(area);
  glDisable(GL_SCISSOR_TEST);
  drawn_->endPass("resolve");
  target_.end();
  drawn_->endPass("statistics");
}

void GlLinkedList::collect(std::span<const SurfaceRun> runs) {
  if (needs_.stencil) {
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 0, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
  }
  if (media_ && media_->objects().anyNear()) {
    drawn_->drawSurfaces(*surfaces_, media_->objects().part(runs, false));
    glDepthFunc(GL_ALWAYS);
    drawn_->drawSurfaces(*surfaces_, media_->objects().part(runs, true));
    glDepthFunc(GL_GEQUAL);
  } else {
    drawn_->drawSurfaces(*surfaces_, runs);
  }
  glDisable(GL_STENCIL_TEST);
}

void GlLinkedList::resolve(const VitrailRect& area) {
  if (options_.resolve == VITRAIL_RESOLVE_FRAGMENT) {
    needs_.perSample || options_.samples == 1 ? images_->bindDrawn() : images_->bindColor();
  }
  target_.resolve();
  if (!media_) return;
  target_.bind();
  media_->resolve(*images_, area.width, area.height);
}

VitrailStats GlLinkedList::readStats() const {
  VitrailStats stats{};
  check(target_.readStats(frame_, stats), "vitrailGlReadStats");
  return stats;
}

FrameStats GlLinkedList::stats() const {
  FrameStats result = totals();
  result.resolve = nameOf(options_.resolve);
  result.listBuild = nameOf(listBuild_);
  if (options_.resolve == VITRAIL_RESOLVE_FRAGMENT && (options_.samples == 1 || needs_.perSample)) {
    result.stencilMark = needs_.stencil ? "on" : "off";
  }
  return result;
}

} // namespace

std::unique_ptr<GlMethod> makeGlLinkedList(const GlMethodHost& host, const MethodOptions& options) {
  return std::make_unique<GlLinkedList>(host, options);
}

} // namespace vitrail::tool
