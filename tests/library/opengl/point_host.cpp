#include "point_host.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include "tapped.h"

namespace vitrail::tests::opengl {

namespace {

constexpr const char* kVersion = "#version 430 core\n";

constexpr const char* kPointsVertex = R"(#version 430 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;
layout(location = 2) in uint blend;
layout(location = 3) in uint word;
flat out vec4 outColor;
flat out uint outBlend;
flat out uint outWord;
void main() {
  gl_Position = vec4(position, 1.0);
  outColor = color;
  outBlend = blend;
  outWord = word;
}
)";

constexpr const char* kPointsFragment = R"(
flat in vec4 outColor;
flat in uint outBlend;
flat in uint outWord;
void main() { vitrailCollectWord(outColor, outBlend, outWord); }
)";

constexpr const char* kOpaqueVertex = R"(#version 430 core
uniform float depth;
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, depth, 1.0);
}
)";

constexpr const char* kOpaqueFragment = R"(#version 430 core
uniform vec4 color;
out vec4 outColor;
void main() { outColor = color; }
)";

// Writes down what lies under each pixel of an area, front to back, as tests/library/vulkan/shaders/walk.comp does.
constexpr const char* kWalk = R"(
layout(local_size_x = 8, local_size_y = 8) in;
uniform uvec4 area;
uniform uint most;
layout(binding = 7, std430) writeonly buffer WalkedBlock { uint walked[]; };
void main() {
  uvec2 place = gl_GlobalInvocationID.xy;
  if (place.x >= area.z || place.y >= area.w) return;
  uint first = (place.y * area.z + place.x) * (2u + 8u * most);
  VitrailList list = vitrailOpenList(ivec2(place + area.xy));
  VitrailLayer layer;
  uint count = 0u;
  while (vitrailNextLayer(list, layer)) {
    if (count < most) {
      uint at = first + 2u + 8u * count;
      for (uint i = 0u; i < 4u; ++i) walked[at + i] = floatBitsToUint(layer.color[i]);
      walked[at + 4u] = floatBitsToUint(layer.depth);
      walked[at + 5u] = layer.blend;
      walked[at + 6u] = layer.coverage;
      walked[at + 7u] = layer.word;
    }
    ++count;
  }
  walked[first] = count;
  walked[first + 1u] = vitrailListWasCut(list) ? 1u : 0u;
}
)";

struct Vertex {
  std::array<float, 3> position;
  std::array<float, 4> color;
  std::uint32_t blend;
  std::uint32_t word;
};

// The clip-space vertex whose point covers the pixel's centre. Depths are clipped to [0, 1] (glClipControl).
Vertex toVertex(const Point& point, const HostDesc& desc) {
  const auto clip = [](std::uint32_t pixel, std::uint32_t size) {
    return (static_cast<float>(pixel) + 0.5F) * 2.0F / static_cast<float>(size) - 1.0F;
  };
  return {{clip(point.x, desc.width), clip(point.y, desc.height), point.depth}, point.color, point.blend, point.word};
}

bool severalSamples(const HostDesc& desc) { return desc.samples > 1; }
bool perPixel(const HostDesc& desc) {
  return severalSamples(desc) && desc.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_PIXEL;
}
bool perSample(const HostDesc& desc) { return severalSamples(desc) && !perPixel(desc); }
GLenum colorFormat(const HostDesc& desc) { return desc.colorFormat == ColorFormat::Float16 ? GL_RGBA16F : GL_RGBA32F; }
float farthest(const HostDesc& desc) { return desc.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? 0.0F : 1.0F; }

GLuint makeTexture(GLenum target, GLenum format, const HostDesc& desc) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(target, texture);
  const auto width = static_cast<GLsizei>(desc.width);
  const auto height = static_cast<GLsizei>(desc.height);
  if (target == GL_TEXTURE_2D) {
    glTexStorage2D(target, 1, format, width, height);
  } else {
    glTexStorage2DMultisample(target, static_cast<GLsizei>(desc.samples), format, width, height, GL_TRUE);
  }
  glBindTexture(target, 0);
  return texture;
}

GLuint makeFramebuffer(GLuint color, GLuint depth, bool stencil, bool draws) {
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, color, 0);
  if (depth != 0) {
    glFramebufferTexture(GL_FRAMEBUFFER, stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, depth, 0);
  }
  glDrawBuffer(draws ? GL_COLOR_ATTACHMENT0 : GL_NONE);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) throw HostError("an incomplete framebuffer");
  return framebuffer;
}

void clearColor(const FloatColor& color) { glClearBufferfv(GL_COLOR, 0, color.data()); }

// What the library copied out.
void decodeCopy(const std::vector<std::byte>& copy, std::uint32_t pixels, ListsRead& read) {
  VitrailGlCopyHeader header{};
  std::memcpy(&header, copy.data(), sizeof(header));
  read.layers = header.layers;
  std::vector<VitrailGlCopiedList> lists(pixels);
  std::memcpy(lists.data(), copy.data() + sizeof(header), pixels * sizeof(VitrailGlCopiedList));
  const std::byte* layers = copy.data() + sizeof(header) + pixels * sizeof(VitrailGlCopiedList);
  for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const VitrailGlCopiedList& list = lists[pixel];
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

GLuint makeBuffer(std::uint64_t size) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(size), nullptr, GL_DYNAMIC_READ);
  return buffer;
}

std::vector<std::byte> readBuffer(GLuint buffer, std::uint64_t offset, std::uint64_t size) {
  std::vector<std::byte> bytes(size);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // writers: shaders
  glBindBuffer(GL_COPY_READ_BUFFER, buffer);
  glGetBufferSubData(GL_COPY_READ_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(size), bytes.data());
  return bytes;
}

} // namespace

// ---- Textures

PointTextures::PointTextures(const HostDesc& desc) {
  color = makeTexture(GL_TEXTURE_2D, colorFormat(desc), desc);
  const GLenum target = severalSamples(desc) ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
  if (severalSamples(desc)) multisampled = makeTexture(target, colorFormat(desc), desc);
  if (desc.stencilMark) {
    depth = makeTexture(target, GL_DEPTH32F_STENCIL8, desc);
  } else if (severalSamples(desc) || !desc.opaqueDepth.empty()) {
    depth = makeTexture(target, GL_DEPTH_COMPONENT32F, desc);
  }
  const GLuint shown = severalSamples(desc) ? multisampled : color;
  drawn = makeFramebuffer(shown, depth, desc.stencilMark, true);
  collecting = makeFramebuffer(shown, depth, desc.stencilMark, false);
  resolved = makeFramebuffer(color, 0, false, true);
}

PointTextures::~PointTextures() {
  const std::array<GLuint, 3> textures = {color, multisampled, depth};
  const std::array<GLuint, 3> framebuffers = {drawn, resolved, collecting};
  if (color == 0) return;
  glDeleteFramebuffers(framebuffers.size(), framebuffers.data());
  glDeleteTextures(textures.size(), textures.data());
}

PointTextures& PointTextures::operator=(PointTextures&& other) noexcept {
  std::swap(color, other.color);
  std::swap(multisampled, other.multisampled);
  std::swap(depth, other.depth);
  std::swap(drawn, other.drawn);
  std::swap(resolved, other.resolved);
  std::swap(collecting, other.collecting);
  return *this;
}

// ---- The host

OpenGlHost::OpenGlHost(OpenGlBackend& backend, const HostDesc& desc, bool hostBarriers)
    : backend_(backend),
      desc_(desc),
      hostBarriers_(hostBarriers),
      postDepthCoverage_(severalSamples(desc) && desc.postDepthCoverage && backend.features().postDepthCoverage) {
  makeTextures();
  VitrailGlTargetDesc target = targetDesc();
  if (desc.guarded) guard(target);
  const VitrailResult result = vitrailGlCreateTarget(backend.context(), &target, &target_);
  if (result != VITRAIL_SUCCESS) {
    std::string reason = "vitrailGlCreateTarget: VitrailResult " + std::to_string(result);
    for (const LogLine& line : backend.takeLog()) reason += ": " + line.text;
    throw HostError(reason);
  }
  points_ = programFor(target, desc.specialized);
  if (desc.strangersFor) {
    target.overflow = *desc.strangersFor;
    strangers_ = programFor(target, true);
  }
  glGenBuffers(1, &vertices_);
  glGenVertexArrays(1, &vertexArray_);
  glBindVertexArray(vertexArray_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), reinterpret_cast<void*>(offsetof(Vertex, position)));
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, sizeof(Vertex), reinterpret_cast<void*>(offsetof(Vertex, color)));
  glVertexAttribIPointer(2, 1, GL_UNSIGNED_INT, sizeof(Vertex), reinterpret_cast<void*>(offsetof(Vertex, blend)));
  glVertexAttribIPointer(3, 1, GL_UNSIGNED_INT, sizeof(Vertex), reinterpret_cast<void*>(offsetof(Vertex, word)));
  for (GLuint i = 0; i < 4; ++i) glEnableVertexAttribArray(i);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
}

OpenGlHost::~OpenGlHost() {
  vitrailGlDestroyTarget(target_);
  glDeleteVertexArrays(1, &vertexArray_);
  glDeleteBuffers(1, &vertices_);
  glDeleteBuffers(1, &memory_);
}

void OpenGlHost::makeTextures() {
  for (std::size_t i = 0; i < textures_.size(); ++i) {
    textures_[i] = PointTextures(desc_);
    colorViews_[i] = textures_[i].color;
    opaqueViews_[i] = textures_[i].multisampled;
    depthViews_[i] = textures_[i].depth;
  }
}

VitrailGlTextures OpenGlHost::views() {
  VitrailGlTextures views{};
  if (desc_.resolve == VITRAIL_RESOLVE_HOST) return views;
  if (desc_.resolve != VITRAIL_RESOLVE_FRAGMENT) views.color = colorViews_.data();
  if (perPixel(desc_)) views.opaque = opaqueViews_.data();
  if (severalSamples(desc_) && !postDepthCoverage_) views.depth = depthViews_.data();
  const bool any = views.color != nullptr || views.opaque != nullptr || views.depth != nullptr;
  views.count = any ? kFramesTogether : 0;
  return views;
}

VitrailGlTargetDesc OpenGlHost::targetDesc() {
  VitrailGlTargetDesc desc{};
  desc.width = desc_.width;
  desc.height = desc_.height;
  desc.samples = desc_.samples;
  desc.nodeFormat = desc_.nodes;
  desc.depthOrder = desc_.depthOrder;
  desc.resolve = desc_.resolve;
  desc.msaaResolve = desc_.msaaResolve;
  desc.postDepthCoverage = postDepthCoverage_ ? 1 : 0;
  desc.maxLayers = desc_.maxLayers;
  desc.overflow = desc_.overflow;
  desc.listBuild = desc_.listBuild;
  desc.nodeCapacity = desc_.capacity;
  desc.memoryBudget = desc_.memoryBudget;
  desc.areaPixels = desc_.areaPixels;
  desc.userWords = desc_.userWords ? 1 : 0;
  desc.copyLayers = desc_.copyLayers;
  desc.colorFormat = colorFormat(desc_);
  desc.textures = views();
  desc.hostBarriers = hostBarriers_ ? 1 : 0;
  desc.severalDrawBuffers = desc_.dualSourceBlending ? 0 : 1;
  desc.stencilMark = desc_.stencilMark && !perPixel(desc_) ? 1 : 0;
  desc.debugName = "points";
  return desc;
}

// Makes the target's memory, between guard words and full of them.
void OpenGlHost::guard(VitrailGlTargetDesc& desc) {
  VitrailGlRequirements needs{};
  if (vitrailGlTargetRequirements(backend_.context(), &desc, &needs) != VITRAIL_SUCCESS) {
    throw HostError("vitrailGlTargetRequirements");
  }
  guardBytes_ = (kGuardWords * sizeof(std::uint32_t) + needs.alignment - 1) / needs.alignment * needs.alignment;
  memory_ = makeBuffer(needs.size + 2 * guardBytes_);
  const std::vector<std::uint32_t> words((needs.size + 2 * guardBytes_) / sizeof(std::uint32_t), kGuard);
  glBufferSubData(GL_COPY_WRITE_BUFFER, 0, static_cast<GLsizeiptr>(words.size() * sizeof(std::uint32_t)), words.data());
  storage_ = layoutOf(desc_, needs.alignment);
  desc.buffer = memory_;
  desc.bufferOffset = guardBytes_;
  desc.bufferSize = needs.size;
}

// The program of points for a target, or for what HostDesc says in its place.
GLuint OpenGlHost::programFor(VitrailGlTargetDesc target, bool specialized) {
  std::string text = kVersion;
  if (specialized) {
    target.nodeFormat = desc_.specializedFor.value_or(target.nodeFormat);
    target.overflow = desc_.specializedForOverflow.value_or(target.overflow);
    target.listBuild = desc_.specializedForListBuild.value_or(target.listBuild);
    VitrailGlSpecialization specialization{};
    vitrailGlCollectSpecialization(backend_.context(), &target, &specialization);
    text += specialization.defines;
  }
  if (desc_.shaderPostDepth.value_or(postDepthCoverage_)) text += "#define VITRAIL_POST_DEPTH_COVERAGE\n";
  if (desc_.shader == ShaderKind::ForCpu) text += "#define VITRAIL_CPU_DRIVER\n";
  if (desc_.shader == ShaderKind::Narrow && !specialized) {
    text +=
        "#define VITRAIL_ONLY_FORMAT 0\n#define VITRAIL_ONLY_SAMPLES 1\n#define VITRAIL_ONLY_OVERFLOW 1\n"
        "#define VITRAIL_ONLY_LIST_BUILD 1\n#define VITRAIL_ONLY_USER_WORDS 0\n";
  }
  text += vitrailGlCollectSource(backend_.context());
  return backend_.program(kPointsVertex, text + kPointsFragment);
}

// ---- Frames

void OpenGlHost::barrier(VitrailGlBarrierPoint point) const {
  if (!hostBarriers_) return;
  const GLbitfield bits = vitrailGlBarriers(target_, point);
  if (bits == 0) return;
  glMemoryBarrier(bits);
  tap.calls.push_back({"MemoryBarrier", bits});
}

void OpenGlHost::drawOpaque(PointTextures& textures) {
  glViewport(0, 0, static_cast<GLsizei>(desc_.width), static_cast<GLsizei>(desc_.height));
  glDisable(GL_SAMPLE_MASK);
  if (severalSamples(desc_) && !perSample(desc_)) {
    glBindFramebuffer(GL_FRAMEBUFFER, textures.resolved);
    clearColor(desc_.beforeResolve);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, textures.drawn);
  clearColor(desc_.behind);
  glDepthMask(GL_TRUE);
  glStencilMask(0xff);
  const float depth = farthest(desc_);
  if (textures.depth != 0) glClearBufferfv(GL_DEPTH, 0, &depth);
  constexpr GLint kNoMark = 0;
  if (desc_.stencilMark) glClearBufferiv(GL_STENCIL, 0, &kNoMark);
  if (desc_.behindSamples.empty() && desc_.opaqueDepth.empty()) return;
  const GLuint program = backend_.program(kOpaqueVertex, kOpaqueFragment);
  glUseProgram(program);
  glBindVertexArray(vertexArray_);
  for (GLuint i = 0; i < 4; ++i) glDisableVertexAttribArray(i);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  glEnable(GL_SAMPLE_MASK);
  for (std::uint32_t s = 0; s < desc_.samples; ++s) {
    const FloatColor here = behindAt(desc_, s);
    glSampleMaski(0, severalSamples(desc_) ? 1U << s : 0xffffffffU);
    glUniform4fv(glGetUniformLocation(program, "color"), 1, here.data());
    glUniform1f(glGetUniformLocation(program, "depth"), desc_.opaqueDepth.empty() ? depth : desc_.opaqueDepth.at(s));
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glDisable(GL_SAMPLE_MASK);
  for (GLuint i = 0; i < 4; ++i) glEnableVertexAttribArray(i);
}

void OpenGlHost::begin(std::uint64_t frame, const VitrailRect& area) {
  VitrailGlBeginInfo info{};
  info.frame = desc_.numbersFrames ? frame : 0;
  info.area = area;
  barrier(VITRAIL_GL_BARRIER_BEGIN);
  vitrailGlBegin(target_, &info);
  if (desc_.requestedBefore > 0) {
    glBindBuffer(GL_COPY_WRITE_BUFFER, memory_);
    glBufferSubData(
        GL_COPY_WRITE_BUFFER,
        static_cast<GLintptr>(guardBytes_ + storage_.control.offset + offsetof(layout::VitrailControl, requested)),
        sizeof(std::uint32_t), &desc_.requestedBefore);
  }
  barrier(VITRAIL_GL_BARRIER_COLLECT);
}

// Points that follow each other and cover the same samples, strangers or not, are one draw.
void OpenGlHost::drawPoints(PointTextures& textures, std::span<const Point> points) {
  if (points.empty()) return;
  std::vector<Vertex> vertices;
  vertices.reserve(points.size());
  for (const Point& point : points) vertices.push_back(toVertex(point, desc_));
  glBindFramebuffer(GL_FRAMEBUFFER, textures.collecting);
  glBindVertexArray(vertexArray_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
               GL_STREAM_DRAW);
  if (textures.depth != 0) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(desc_.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? GL_GEQUAL : GL_LEQUAL);
    glDepthMask(GL_FALSE);
  } else {
    glDisable(GL_DEPTH_TEST);
  }
  if (desc_.stencilMark) {
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 0, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
  }
  vitrailGlBind(target_);
  if (severalSamples(desc_)) glEnable(GL_SAMPLE_MASK);
  const std::uint32_t all = (1U << desc_.samples) - 1U;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t end = first + 1;
    const Point& point = points[first];
    const auto isAlike = [&](const Point& other) {
      return ((other.coverage ^ point.coverage) & all) == 0 && other.stranger == point.stranger;
    };
    while (end < points.size() && isAlike(points[end])) ++end;
    const bool covers = severalSamples(desc_) || (point.coverage & all) != 0;
    if (severalSamples(desc_)) glSampleMaski(0, point.coverage & all);
    glUseProgram(point.stranger ? strangers_ : points_);
    if (covers) glDrawArrays(GL_POINTS, static_cast<GLint>(first), static_cast<GLsizei>(end - first));
    first = end;
  }
  glDisable(GL_SAMPLE_MASK);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_DEPTH_TEST);
}

void OpenGlHost::collected() {
  barrier(VITRAIL_GL_BARRIER_COLLECTED);
  vitrailGlCollected(target_);
}

void OpenGlHost::resolve(PointTextures& textures, std::uint64_t view) {
  VitrailGlResolveInfo info{};
  if (views().count > 0) info.view = static_cast<std::uint32_t>(view);
  barrier(VITRAIL_GL_BARRIER_RESOLVE);
  glBindFramebuffer(GL_FRAMEBUFFER, perPixel(desc_) ? textures.resolved : textures.drawn);
  vitrailGlResolve(target_, &info);
  if (hostBarriers_) glMemoryBarrier(GL_ALL_BARRIER_BITS); // writer: the resolve; readers: this host
}

void OpenGlHost::end() {
  barrier(VITRAIL_GL_BARRIER_END);
  vitrailGlEnd(target_);
}

void OpenGlHost::drawFrame(std::uint64_t frame, PointTextures& textures, const VitrailRect& area,
                           std::span<const Point> points) {
  begin(frame, area);
  drawPoints(textures, points);
  collected();
  resolve(textures, static_cast<std::uint64_t>(&textures - textures_.data()));
  end();
}

std::vector<FloatColor> OpenGlHost::pixels(const PointTextures& textures) const {
  const auto width = static_cast<GLsizei>(desc_.width);
  const auto height = static_cast<GLsizei>(desc_.height);
  if (perSample(desc_)) { // the box filter
    glBindFramebuffer(GL_READ_FRAMEBUFFER, textures.drawn);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, textures.resolved);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
  std::vector<FloatColor> result(std::size_t{desc_.width} * desc_.height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, textures.resolved);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, result.data());
  return result;
}

PointResult OpenGlHost::read(const PointTextures& textures, std::uint64_t frame) const {
  std::vector<FloatColor> picture = pixels(textures); // which waits for the frame
  glFinish();
  const std::optional<VitrailStats> counted = stats(frame);
  if (!counted) throw HostError("the statistics of frame " + std::to_string(frame) + " are not there");
  return {std::move(picture), *counted};
}

std::optional<VitrailStats> OpenGlHost::stats(std::uint64_t frame) const {
  VitrailStats stats{};
  if (vitrailGlReadStats(target_, frame, &stats) != VITRAIL_SUCCESS) return {};
  return stats;
}

VitrailMemory OpenGlHost::memory() const {
  VitrailMemory memory{};
  vitrailGlTargetMemory(target_, &memory);
  return memory;
}

void OpenGlHost::update(std::uint64_t frame) {
  if (vitrailGlUpdateTarget(target_, desc_.numbersFrames ? frame : 0) != VITRAIL_SUCCESS)
    throw HostError("vitrailGlUpdateTarget");
}

std::vector<PointResult> OpenGlHost::drawTogether(const std::vector<std::vector<Point>>& frames) {
  const std::uint64_t first = frame_;
  frame_ += frames.size();
  update(first);
  for (std::uint64_t frame = first; frame < frame_; ++frame) {
    drawOpaque(texturesOf(frame));
    drawFrame(frame, texturesOf(frame), wholeArea(), frames[frame - first]);
  }
  std::vector<PointResult> results;
  for (std::uint64_t frame = first; frame < frame_; ++frame) results.push_back(read(texturesOf(frame), frame));
  return results;
}

std::array<PointResult, 2> OpenGlHost::drawAcrossResize(std::span<const Point> first, Extent extent,
                                                        std::span<const Point> second, std::uint32_t capacity) {
  const std::uint64_t frame = frame_;
  frame_ += 2;
  update(frame);
  drawOpaque(texturesOf(frame));
  drawFrame(frame, texturesOf(frame), wholeArea(), first);
  std::array<PointTextures, kFramesTogether> old;
  std::swap(old, textures_);
  const HostDesc before = desc_;
  desc_.width = extent.width;
  desc_.height = extent.height;
  makeTextures();
  VitrailGlResizeInfo info{};
  info.width = extent.width;
  info.height = extent.height;
  info.nodeCapacity = capacity;
  info.textures = views();
  if (vitrailGlResizeTarget(target_, &info) != VITRAIL_SUCCESS) throw HostError("vitrailGlResizeTarget");
  drawOpaque(texturesOf(frame + 1));
  drawFrame(frame + 1, texturesOf(frame + 1), wholeArea(), second);
  PointResult after = read(texturesOf(frame + 1), frame + 1);
  const HostDesc now = std::exchange(desc_, before);
  PointResult earlier = read(old[frame % kFramesTogether], frame);
  desc_ = now;
  return {std::move(earlier), std::move(after)};
}

class OpenGlHost::Calls : public FrameCalls {
 public:
  Calls(OpenGlHost& host, PointTextures& textures) : host_(host), textures_(textures) {}
  ~Calls() override { glDeleteBuffers(1, &copied_); }

  void begin(const VitrailRect& area) override {
    begun = host_.frame_++;
    host_.begin(*begun, area);
  }
  void draw(std::span<const Point> points) override { host_.drawPoints(textures_, points); }
  void collected() override { host_.collected(); }
  void copyLists(const CopyAttempt& attempt) override {
    if (copied_ == 0) {
      bytes_ = vitrailGlCopySize(host_.target_, 4, 4);
      copied_ = makeBuffer(bytes_);
      glBindBuffer(GL_COPY_WRITE_BUFFER, copied_);
      glClearBufferData(GL_COPY_WRITE_BUFFER, GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, &kUntouched);
    }
    VitrailGlCopyInfo info{};
    info.area = attempt.area;
    if (attempt.hasBuffer) info.buffer = copied_;
    info.offset = attempt.offset;
    info.size = attempt.size.value_or(bytes_ - attempt.offset);
    vitrailGlCopyLists(host_.target_, &info);
  }
  void resolve(std::optional<std::uint32_t> view) override {
    const auto own = static_cast<std::uint64_t>(&textures_ - host_.textures_.data());
    host_.resolve(textures_, view ? *view : own);
  }
  void end() override { host_.end(); }
  void resize() override {
    VitrailGlResizeInfo info{};
    info.width = host_.desc_.width;
    info.height = host_.desc_.height;
    info.textures = host_.views();
    if (vitrailGlResizeTarget(host_.target_, &info) != VITRAIL_SUCCESS) throw HostError("vitrailGlResizeTarget");
  }

  [[nodiscard]] bool hasCopied() const {
    if (copied_ == 0) return false;
    const std::vector<std::byte> bytes = readBuffer(copied_, 0, bytes_);
    return std::any_of(bytes.begin(), bytes.end(), [](std::byte byte) { return byte != std::byte{kUntouched}; });
  }

  std::optional<std::uint64_t> begun;

 private:
  static constexpr std::uint8_t kUntouched = 0x5a;

  OpenGlHost& host_;
  PointTextures& textures_;
  GLuint copied_ = 0;
  std::uint64_t bytes_ = 0;
};

CallsResult OpenGlHost::drawCalls(const std::function<void(FrameCalls&)>& make) {
  PointTextures& textures = texturesOf(frame_);
  drawOpaque(textures);
  Calls calls(*this, textures);
  make(calls);
  std::vector<FloatColor> picture = pixels(textures);
  glFinish();
  return {std::move(picture), calls.begun ? stats(*calls.begun) : std::nullopt, calls.hasCopied()};
}

PointResult OpenGlHost::drawAreas(std::span<const Point> points, const NextArea& next) {
  PointTextures& textures = textures_[0];
  drawOpaque(textures);
  VitrailStats stats{};
  VitrailRect area{};
  for (bool more = next(nullptr, area); more; more = next(&stats, area)) {
    const std::uint64_t frame = frame_++;
    drawFrame(frame, textures, area, points);
    stats = read(textures, frame).stats;
  }
  return {pixels(textures), stats};
}

PointResult OpenGlHost::drawScattered(std::span<const Point> points) {
  const std::uint64_t frame = frame_++;
  PointTextures& textures = texturesOf(frame);
  drawOpaque(textures);
  begin(frame, wholeArea());
  drawPoints(textures, points);
  std::vector<std::byte> copy = readBuffer(memory_, guardBytes_, storage_.total);
  scatterNodes(desc_, storage_, copy);
  glBindBuffer(GL_COPY_WRITE_BUFFER, memory_);
  glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(guardBytes_), static_cast<GLsizeiptr>(copy.size()),
                  copy.data());
  collected();
  resolve(textures, frame % kFramesTogether);
  end();
  return read(textures, frame);
}

void OpenGlHost::walk(const VitrailRect& area, GLuint buffer) {
  std::string text = kVersion;
  if (desc_.resolve == VITRAIL_RESOLVE_HOST) text += "#define VITRAIL_SORTED_LISTS\n";
  text += vitrailGlListSource(backend_.context());
  const GLuint program = backend_.program(text + kWalk, "");
  vitrailGlBind(target_);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, buffer);
  glUseProgram(program);
  glUniform4ui(glGetUniformLocation(program, "area"), area.x, area.y, area.width, area.height);
  glUniform1ui(glGetUniformLocation(program, "most"), kMostWalked);
  glDispatchCompute((area.width + 7) / 8, (area.height + 7) / 8, 1);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, 0);
}

ListsRead OpenGlHost::drawAndRead(std::span<const Point> points, const VitrailRect& area, ReadBy by,
                                  bool afterResolve) {
  const std::uint64_t frame = frame_++;
  PointTextures& textures = texturesOf(frame);
  const std::uint64_t pixelCount = std::uint64_t{area.width} * area.height;
  const std::uint64_t bytes = by == ReadBy::Shader ? pixelCount * (2 + 8 * std::uint64_t{kMostWalked}) * 4
                                                   : vitrailGlCopySize(target_, area.width, area.height);
  const GLuint buffer = makeBuffer(bytes);
  const auto readLists = [&] {
    if (by == ReadBy::Shader) return walk(area, buffer);
    VitrailGlCopyInfo info{};
    info.area = area;
    info.buffer = buffer;
    info.size = bytes;
    vitrailGlCopyLists(target_, &info);
  };
  update(frame);
  drawOpaque(textures);
  begin(frame, wholeArea());
  drawPoints(textures, points);
  collected();
  if (!afterResolve) readLists();
  resolve(textures, frame % kFramesTogether);
  if (afterResolve) readLists();
  end();
  ListsRead result;
  result.frame = read(textures, frame);
  result.pixels.resize(pixelCount);
  const std::vector<std::byte> copy = readBuffer(buffer, 0, bytes);
  glDeleteBuffers(1, &buffer);
  if (by == ReadBy::Shader) {
    decodeWalk(copy, result);
  } else {
    decodeCopy(copy, static_cast<std::uint32_t>(pixelCount), result);
  }
  return result;
}

void OpenGlHost::drop(std::span<const Point> points) {
  const std::uint64_t frame = frame_++;
  update(frame);
  drawOpaque(texturesOf(frame));
  drawFrame(frame, texturesOf(frame), wholeArea(), points);
}

std::vector<std::uint32_t> OpenGlHost::wordsAt(std::uint64_t offset, std::uint64_t size) const {
  const std::vector<std::byte> bytes = readBuffer(memory_, offset, size);
  std::vector<std::uint32_t> words(size / sizeof(std::uint32_t));
  std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t));
  return words;
}

std::vector<std::uint32_t> OpenGlHost::words(StoragePart StorageLayout::*part) {
  return wordsAt(guardBytes_ + (storage_.*part).offset, (storage_.*part).size);
}

bool OpenGlHost::guardsUntouched() {
  std::vector<std::uint32_t> guards = wordsAt(0, guardBytes_);
  const std::vector<std::uint32_t> behind = wordsAt(guardBytes_ + storage_.total, guardBytes_);
  guards.insert(guards.end(), behind.begin(), behind.end());
  return std::all_of(guards.begin(), guards.end(), [](std::uint32_t word) { return word == kGuard; });
}

} // namespace vitrail::tests::opengl
