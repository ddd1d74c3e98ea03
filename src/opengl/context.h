// What the library keeps for one OpenGL context, or one group of them: functions, programs, limits, sources.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "core/device_limits.h"
#include "core/log.h"
#include "core/structures.h"
#include "functions.h"
#include "programs.h"
#include "vitrail/gl.h"

struct VitrailGlContext_T {
  vitrail::GlFunctions gl;
  vitrail::Log log;
  vitrail::DeviceLimits limits;
  std::uint32_t bindingBase = 0;
  std::string collectSource;
  std::string listSource;
  std::mutex programsMutex;  // guards what follows
  bool takesModules = false; // SPIR-V; not after the driver refused one
  std::map<vitrail::ProgramKey, GLuint> programs;
  // The handle and its targets: what the context has is freed with the last of them.
  std::atomic<std::uint32_t> owners{1};

  // Names an object for debuggers.
  void label(GLenum kind, GLuint object, const char* prefix, const char* what) const;
};

namespace vitrail {

// One owner less.
void releaseContext(VitrailGlContext context);

// What the error flags of OpenGL held, which are clear now.
struct ErrorFlags {
  bool any = false;
  bool lost = false; // the context: GL_CONTEXT_LOST
};
ErrorFlags takeErrors(const GlFunctions& gl);

// Logs that the context of OpenGL is lost.
VitrailResult contextIsLost(const VitrailGlContext_T& context);

// Logs that an argument of a call is null.
VitrailResult nullArgument(const VitrailGlContext_T* context, const char* call);

} // namespace vitrail
