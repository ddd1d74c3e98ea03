#include "functions.h"

namespace vitrail {

const char* GlFunctions::load(VitrailGlGetProcAddress getProcAddress, void* user) {
#define VITRAIL_LOAD(type, name)                                     \
  (name) = reinterpret_cast<type>(getProcAddress("gl" #name, user)); \
  if ((name) == nullptr) return "gl" #name;
  VITRAIL_GL_FUNCTIONS(VITRAIL_LOAD)
#undef VITRAIL_LOAD
  MapBufferRange = reinterpret_cast<PFNGLMAPBUFFERRANGEPROC>(getProcAddress("glMapBufferRange", user));
  return nullptr;
}

} // namespace vitrail
