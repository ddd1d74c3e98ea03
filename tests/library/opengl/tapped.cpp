#include "tapped.h"

#include <array>
#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

#include "opengl/functions.h"

namespace vitrail::tests::opengl {

Tap tap;

void Tap::reset() {
  const Tap kept = std::exchange(*this, {});
  real = kept.real;
  missing = kept.missing;
  vendor = kept.vendor;
}

namespace {

#define VITRAIL_ALL_FUNCTIONS(X)                       \
  VITRAIL_GL_FUNCTIONS(X)                              \
  X(PFNGLBUFFERSTORAGEPROC, BufferStorage)             \
  X(PFNGLMAPBUFFERRANGEPROC, MapBufferRange)           \
  X(PFNGLSHADERBINARYPROC, ShaderBinary)               \
  X(PFNGLSPECIALIZESHADERARBPROC, SpecializeShaderARB) \
  X(PFNGLMAXSHADERCOMPILERTHREADSKHRPROC, MaxShaderCompilerThreadsKHR)

enum class Function : std::size_t {
#define VITRAIL_NAME(type, name) name,
  VITRAIL_ALL_FUNCTIONS(VITRAIL_NAME)
#undef VITRAIL_NAME
};

constexpr std::array kNames = {
#define VITRAIL_NAME(type, name) std::string_view(#name),
    VITRAIL_ALL_FUNCTIONS(VITRAIL_NAME)
#undef VITRAIL_NAME
};

std::array<void*, kNames.size()> realFunctions{};

// What a function of a lost context returns.
template <typename Result>
Result lostResult(Function function) {
  if constexpr (std::is_same_v<Result, GLenum>) {
    if (function == Function::GetError) return GL_CONTEXT_LOST;
    if (function == Function::ClientWaitSync) {
      return tap.fence == LostFence::Failed ? GL_WAIT_FAILED : GL_ALREADY_SIGNALED;
    }
  }
  if constexpr (!std::is_void_v<Result>) return Result{};
}

std::uint32_t firstOf() { return 0; }
template <typename First, typename... Rest>
std::uint32_t firstOf(First first, Rest... /*rest*/) {
  if constexpr (std::same_as<First, GLuint> || std::same_as<First, GLint>) return static_cast<std::uint32_t>(first);
  return 0;
}

bool hasEffect(Function function) {
  if (!tap.isLost()) return true;
  const bool fence =
      function == Function::FenceSync || function == Function::ClientWaitSync || function == Function::DeleteSync;
  return fence && tap.fence == LostFence::AsEver;
}

// The vendor that the driver says it is of.
template <typename Result>
Result answered(Function function, std::uint32_t first, Result result) {
  if constexpr (std::is_same_v<Result, const GLubyte*>) {
    if (function == Function::GetString && first == GL_VENDOR && tap.vendor != nullptr) {
      return reinterpret_cast<const GLubyte*>(tap.vendor);
    }
  }
  return result;
}

// Another text for the shader that is about to be compiled.
void spoil(Function function, GLuint shader) {
  if (function != Function::CompileShader || tap.shaders++ != tap.spoiledShader) return;
  const GLchar* text = "#version 430 core\nthis is no GLSL\n";
  const auto set =
      reinterpret_cast<PFNGLSHADERSOURCEPROC>(realFunctions[static_cast<std::size_t>(Function::ShaderSource)]);
  set(shader, 1, &text, nullptr);
}

bool isLeftOut(Function function) {
  return function == Function::MemoryBarrier && tap.barriers++ == tap.leftOutBarrier;
}

template <typename Type>
struct Tapped;
template <typename Result, typename... Arguments>
struct Tapped<Result(APIENTRYP)(Arguments...)> {
  template <Function kFunction>
  static Result APIENTRY call(Arguments... arguments) {
    constexpr auto kIndex = static_cast<std::size_t>(kFunction);
    tap.calls.push_back({kNames[kIndex], firstOf(arguments...)});
    if (!hasEffect(kFunction) || isLeftOut(kFunction)) return lostResult<Result>(kFunction);
    spoil(kFunction, firstOf(arguments...));
    const auto real = reinterpret_cast<Result(APIENTRYP)(Arguments...)>(realFunctions[kIndex]);
    if constexpr (std::is_void_v<Result>) {
      real(arguments...);
    } else {
      return answered(kFunction, firstOf(arguments...), real(arguments...));
    }
  }
};

} // namespace

void* tappedLoader(const char* name, void* user) {
  if (tap.missing == name) return nullptr;
  void* real = tap.real(name, user);
  const std::string_view wanted = name;
#define VITRAIL_FIND(type, function)                                         \
  if (wanted == "gl" #function && real != nullptr) {                         \
    realFunctions[static_cast<std::size_t>(Function::function)] = real;      \
    return reinterpret_cast<void*>(&Tapped<type>::call<Function::function>); \
  }
  VITRAIL_ALL_FUNCTIONS(VITRAIL_FIND)
#undef VITRAIL_FIND
  return real;
}

} // namespace vitrail::tests::opengl
