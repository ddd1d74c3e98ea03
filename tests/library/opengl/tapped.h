// A loader that stands between the library and OpenGL: it writes down the calls, and can behave as OpenGL does once the
// context is lost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include <vitrail/gl.h>

namespace vitrail::tests::opengl {

struct TappedCall {
  std::string_view name;   // without "gl"
  std::uint32_t first = 0; // the first argument, where that is an integer of 32 bits
};

// What becomes of fences once the context is lost: drivers differ. `AsEver`: they are made and passed as if the
// commands before them had run.
enum class LostFence { Failed, Signaled, AsEver };

// Every loader of a process is the same one.
struct Tap {
  VitrailGlGetProcAddress real = nullptr;
  std::string_view missing;     // the function that the driver does not have; kept by reset()
  const char* vendor = nullptr; // whom the driver says it is of, where that is not its own; kept by reset()
  std::vector<TappedCall> calls;
  // From this call on (its number in `calls`) the context is lost: commands have no effect and raise GL_CONTEXT_LOST,
  // what is asked for is left as it is.
  std::size_t lostFrom = std::numeric_limits<std::size_t>::max();
  LostFence fence = LostFence::Failed;
  // A call to glMemoryBarrier() that is left out; its number among those calls.
  std::size_t leftOutBarrier = std::numeric_limits<std::size_t>::max();
  std::size_t barriers = 0;
  // A shader whose text is spoiled; its number among those that are compiled.
  std::size_t spoiledShader = std::numeric_limits<std::size_t>::max();
  std::size_t shaders = 0;

  [[nodiscard]] bool isLost() const { return calls.size() > lostFrom; }
  // Nothing written down, nothing lost, nothing left out.
  void reset();
};
extern Tap tap;

// For VitrailGlContextDesc.
void* tappedLoader(const char* name, void* user);

} // namespace vitrail::tests::opengl
