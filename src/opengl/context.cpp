// Creation and destruction of a context: loads functions, reads limits.
#include "context.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include "core/target_rules.h"
#include "source.h"

namespace vitrail {

namespace {

// GL_KHR_shader_subgroup, which glcorearb.h of Debian 12 may lack.
constexpr GLenum kSubgroupSize = 0x9532;
constexpr GLenum kSubgroupStages = 0x9533;
constexpr GLenum kSubgroupFeatures = 0x9534;
constexpr GLint kSubgroupCompute = 0x20;
constexpr GLint kSubgroupShuffle = 0x10;
// GL_NVX_gpu_memory_info: KiB.
constexpr GLenum kDedicatedMemory = 0x9047;

GLint integer(const GlFunctions& gl, GLenum what) {
  GLint value = 0;
  gl.GetIntegerv(what, &value);
  return value;
}

bool hasExtension(const GlFunctions& gl, std::string_view name) {
  const GLint count = integer(gl, GL_NUM_EXTENSIONS);
  for (GLint i = 0; i < count; ++i) {
    const auto* text = reinterpret_cast<const char*>(gl.GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
    if (text != nullptr && name == text) return true;
  }
  return false;
}

// The sum of 1, 2, 4 and 8, as far as multisample textures of that format have them.
std::uint32_t sampleCountsOf(const GlFunctions& gl, GLenum format) {
  GLint count = 0;
  gl.GetInternalformativ(GL_TEXTURE_2D_MULTISAMPLE, format, GL_NUM_SAMPLE_COUNTS, 1, &count);
  std::vector<GLint> counts(static_cast<std::size_t>(std::max(count, 0)));
  if (count > 0) gl.GetInternalformativ(GL_TEXTURE_2D_MULTISAMPLE, format, GL_SAMPLES, count, counts.data());
  std::uint32_t sum = 1;
  for (const GLint samples : counts) {
    if (samples == 2 || samples == 4 || samples == 8) sum |= static_cast<std::uint32_t>(samples);
  }
  return sum;
}

bool contains(const char* text, const char* part) { return std::strstr(text, part) != nullptr; }

void readLimits(VitrailGlContext_T& context) {
  const GlFunctions& gl = context.gl;
  DeviceLimits& limits = context.limits;
  GLint64 block = 0;
  gl.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
  limits.storageBufferRange = static_cast<std::uint64_t>(std::max<GLint64>(block, 0));
  // OpenGL does not tell how much memory there is: where an extension does not either, creating a buffer will.
  constexpr std::uint64_t kUnknown = std::uint64_t{1} << 40U;
  const GLint kibibytes = hasExtension(gl, "GL_NVX_gpu_memory_info") ? integer(gl, kDedicatedMemory) : 0;
  limits.heapSize = kibibytes > 0 ? static_cast<std::uint64_t>(kibibytes) * 1024 : kUnknown;
  limits.allocationSize = limits.heapSize;
  constexpr std::uint64_t kLeastAlignment = 256;
  limits.alignment =
      std::max({static_cast<std::uint64_t>(integer(gl, GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT)),
                static_cast<std::uint64_t>(integer(gl, GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT)), kLeastAlignment});
  limits.sampleCounts = sampleCountsOf(gl, GL_RGBA16F) & sampleCountsOf(gl, GL_DEPTH_COMPONENT32F);
  const auto* renderer = reinterpret_cast<const char*>(gl.GetString(GL_RENDERER));
  if (renderer == nullptr) renderer = "";
  limits.isCpu = contains(renderer, "llvmpipe") || contains(renderer, "softpipe") || contains(renderer, "SwiftShader");
  limits.fillsSlowly = true; // NVIDIA: 31 GB/s (docs/notes/opengl.md)
  limits.networks = !limits.isCpu;
  // NVIDIA's GH100, as in src/vulkan/context.cpp.
  limits.fewFragmentCores = contains(renderer, "H100") || contains(renderer, "H200") || contains(renderer, "H800");
  limits.dualSourceBlending = true;
  limits.sampleShading = true;
  if (hasExtension(gl, "GL_KHR_shader_subgroup")) {
    limits.exchangesInGroups = integer(gl, kSubgroupSize) >= 8 &&
                               (integer(gl, kSubgroupStages) & kSubgroupCompute) != 0 &&
                               (integer(gl, kSubgroupFeatures) & kSubgroupShuffle) != 0;
  }
}

VitrailResult checkVersion(const VitrailGlContext_T& context) {
  const auto* version = reinterpret_cast<const char*>(context.gl.GetString(GL_VERSION));
  if (version == nullptr) {
    if (takeErrors(context.gl).lost) return contextIsLost(context);
    return context.log.fail(VITRAIL_ERROR_UNSUPPORTED, "vitrailGlCreateContext: no OpenGL context is current");
  }
  const GLint major = integer(context.gl, GL_MAJOR_VERSION);
  const GLint minor = integer(context.gl, GL_MINOR_VERSION);
  const bool embedded = contains(version, "OpenGL ES");
  if (embedded || major * 10 + minor < 43) {
    return context.log.fail(VITRAIL_ERROR_UNSUPPORTED,
                            "the context has version %.40s: create one for OpenGL 4.3 or later", version);
  }
  if (major * 10 + minor < 45 && !hasExtension(context.gl, "GL_EXT_shader_integer_mix")) {
    return context.log.fail(VITRAIL_ERROR_UNSUPPORTED,
                            "the driver has no GL_EXT_shader_integer_mix, which is needed before OpenGL 4.5");
  }
  constexpr GLint kBlocks = 7; // of a collecting shader that knows every node format
  const GLint blocks = integer(context.gl, GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS);
  if (blocks < kBlocks) {
    return context.log.fail(VITRAIL_ERROR_UNSUPPORTED,
                            "fragment shaders have %d storage blocks here; collecting takes %d", blocks, kBlocks);
  }
  const auto last = context.bindingBase + VITRAIL_GL_BINDINGS;
  const auto most = static_cast<std::uint32_t>(std::min(integer(context.gl, GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS),
                                                        integer(context.gl, GL_MAX_UNIFORM_BUFFER_BINDINGS)));
  if (last > most) {
    return context.log.fail(VITRAIL_ERROR_INVALID, "bindingBase %u: the last binding would be %u, the most is %u",
                            context.bindingBase, last - 1, most - 1);
  }
  return VITRAIL_SUCCESS;
}

const char* compilerThreadsName(const GlFunctions& gl) {
  if (hasExtension(gl, "GL_KHR_parallel_shader_compile")) return "glMaxShaderCompilerThreadsKHR";
  return hasExtension(gl, "GL_ARB_parallel_shader_compile") ? "glMaxShaderCompilerThreadsARB" : nullptr;
}

// NVIDIA's compiler makes faster code of SPIR-V than of GLSL. Mesa's refuses blocks that share a binding, as the forms
// of the node pool do, so that it would be asked in vain (docs/notes/opengl.md).
bool gainsByModules(const GlFunctions& gl) {
  const auto* vendor = reinterpret_cast<const char*>(gl.GetString(GL_VENDOR));
  return vendor != nullptr && contains(vendor, "NVIDIA") && hasExtension(gl, "GL_ARB_gl_spirv");
}

std::string sourceFor(const char* name) { return kSourcePrefix + flattened(name) + "#line 1\n"; }

} // namespace

void releaseContext(VitrailGlContext context) {
  if (context->owners.fetch_sub(1) > 1) return;
  const std::unique_ptr<VitrailGlContext_T> owned(context);
  for (const auto& [key, program] : context->programs) context->gl.DeleteProgram(program);
}

ErrorFlags takeErrors(const GlFunctions& gl) {
  ErrorFlags flags;
  // There may be one flag of each kind, and the one of a lost context comes again and again.
  constexpr int kMostFlags = 16;
  for (int i = 0; i < kMostFlags && !flags.lost; ++i) {
    const GLenum error = gl.GetError();
    if (error == GL_NO_ERROR) break;
    flags.any = true;
    flags.lost = error == GL_CONTEXT_LOST;
  }
  return flags;
}

VitrailResult contextIsLost(const VitrailGlContext_T& context) {
  return context.log.fail(VITRAIL_ERROR_DEVICE_LOST,
                          "the OpenGL context is lost: destroy what was made in it, and begin anew in another one");
}

VitrailResult nullArgument(const VitrailGlContext_T* context, const char* call) {
  if (context != nullptr) context->log.error("%s: an argument is null", call);
  return VITRAIL_ERROR_INVALID;
}

} // namespace vitrail

void VitrailGlContext_T::label(GLenum kind, GLuint object, const char* prefix, const char* what) const {
  char text[96];
  std::snprintf(text, sizeof(text), "%.40s %s", prefix, what);
  gl.ObjectLabel(kind, object, -1, text);
}

extern "C" VitrailResult vitrailGlCreateContext(const VitrailGlContextDesc* desc, VitrailGlContext* context) {
  using namespace vitrail;
  if (context != nullptr) *context = nullptr;
  const Log log = desc != nullptr ? Log{desc->log, desc->logUser} : Log{};
  if (desc == nullptr || context == nullptr) {
    return log.fail(VITRAIL_ERROR_INVALID, "vitrailGlCreateContext: an argument is null");
  }
  if (checkNoNext(log, desc->next, "VitrailGlContextDesc") != VITRAIL_SUCCESS) return VITRAIL_ERROR_INVALID;
  if (desc->getProcAddress == nullptr) {
    return log.fail(VITRAIL_ERROR_INVALID, "VitrailGlContextDesc needs getProcAddress");
  }
  std::unique_ptr<VitrailGlContext_T> made(new (std::nothrow) VitrailGlContext_T);
  if (!made) return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "no memory for a context");
  made->log = log;
  made->bindingBase = desc->bindingBase;
  if (const char* missing = made->gl.load(desc->getProcAddress, desc->loaderUser)) {
    return log.fail(VITRAIL_ERROR_UNSUPPORTED, "the driver has no %s: create a context for OpenGL 4.3 or later",
                    missing);
  }
  const VitrailResult result = checkVersion(*made);
  if (result != VITRAIL_SUCCESS) return result;
  const GLint version = integer(made->gl, GL_MAJOR_VERSION) * 10 + integer(made->gl, GL_MINOR_VERSION);
  if (version >= 44 || hasExtension(made->gl, "GL_ARB_buffer_storage")) {
    made->gl.BufferStorage =
        reinterpret_cast<PFNGLBUFFERSTORAGEPROC>(desc->getProcAddress("glBufferStorage", desc->loaderUser));
  }
  if (const char* name = compilerThreadsName(made->gl)) {
    made->gl.MaxShaderCompilerThreads =
        reinterpret_cast<PFNGLMAXSHADERCOMPILERTHREADSKHRPROC>(desc->getProcAddress(name, desc->loaderUser));
  }
  if (gainsByModules(made->gl)) {
    made->gl.SpecializeShader =
        reinterpret_cast<PFNGLSPECIALIZESHADERPROC>(desc->getProcAddress("glSpecializeShaderARB", desc->loaderUser));
    made->gl.ShaderBinary =
        reinterpret_cast<PFNGLSHADERBINARYPROC>(desc->getProcAddress("glShaderBinary", desc->loaderUser));
    made->takesModules = made->gl.SpecializeShader != nullptr && made->gl.ShaderBinary != nullptr;
  }
  readLimits(*made);
  made->collectSource = sourceFor("vitrail/collect.glsl");
  made->listSource = sourceFor("vitrail/list.glsl");
  *context = made.release();
  return VITRAIL_SUCCESS;
}

extern "C" void vitrailGlDestroyContext(VitrailGlContext context) {
  if (context == nullptr) return;
  const std::uint32_t targets = context->owners.load() - 1;
  if (targets > 0) {
    context->log.error(
        "vitrailGlDestroyContext: targets are left (%u): destroy them first; the context is freed with the last of "
        "them",
        targets);
  }
  vitrail::releaseContext(context);
}

extern "C" const char* vitrailGlCollectSource(VitrailGlContext context) {
  return context != nullptr ? context->collectSource.c_str() : "";
}

extern "C" const char* vitrailGlListSource(VitrailGlContext context) {
  return context != nullptr ? context->listSource.c_str() : "";
}

extern "C" uint32_t vitrailGlMaxNodeCapacity(VitrailGlContext context, VitrailNodeFormat format, uint32_t samples) {
  if (context == nullptr) return 0;
  return vitrail::maxNodeCapacity(context->limits, format, samples, false);
}

extern "C" VitrailResult vitrailGlTileLimits(VitrailGlContext context, VitrailNodeFormat format, uint32_t samples,
                                             VitrailTileLimits* limits) {
  using namespace vitrail;
  if (limits != nullptr) clearKeepingNext(*limits);
  if (context == nullptr || limits == nullptr) return nullArgument(context, "vitrailGlTileLimits");
  return tileLimits(context->limits, context->log, format, samples, *limits);
}
