// The OpenGL functions that the library calls, loaded through the host's getProcAddress: the library links no loader
// and keeps no global function pointers.
#pragma once

#include <GL/glcorearb.h>

#include "vitrail/gl.h"

namespace vitrail {

#define VITRAIL_GL_FUNCTIONS(X)                                \
  X(PFNGLACTIVETEXTUREPROC, ActiveTexture)                     \
  X(PFNGLATTACHSHADERPROC, AttachShader)                       \
  X(PFNGLBINDBUFFERPROC, BindBuffer)                           \
  X(PFNGLBINDBUFFERRANGEPROC, BindBufferRange)                 \
  X(PFNGLBINDBUFFERBASEPROC, BindBufferBase)                   \
  X(PFNGLBINDIMAGETEXTUREPROC, BindImageTexture)               \
  X(PFNGLBINDSAMPLERPROC, BindSampler)                         \
  X(PFNGLBINDTEXTUREPROC, BindTexture)                         \
  X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                 \
  X(PFNGLBLENDEQUATIONSEPARATEIPROC, BlendEquationSeparatei)   \
  X(PFNGLBLENDFUNCSEPARATEIPROC, BlendFuncSeparatei)           \
  X(PFNGLBUFFERDATAPROC, BufferData)                           \
  X(PFNGLBUFFERSUBDATAPROC, BufferSubData)                     \
  X(PFNGLCLEARBUFFERSUBDATAPROC, ClearBufferSubData)           \
  X(PFNGLCLIENTWAITSYNCPROC, ClientWaitSync)                   \
  X(PFNGLCOLORMASKIPROC, ColorMaski)                           \
  X(PFNGLCOMPILESHADERPROC, CompileShader)                     \
  X(PFNGLCOPYBUFFERSUBDATAPROC, CopyBufferSubData)             \
  X(PFNGLCREATEPROGRAMPROC, CreateProgram)                     \
  X(PFNGLCREATESHADERPROC, CreateShader)                       \
  X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                     \
  X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                     \
  X(PFNGLDELETESHADERPROC, DeleteShader)                       \
  X(PFNGLDELETESYNCPROC, DeleteSync)                           \
  X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)           \
  X(PFNGLDISABLEPROC, Disable)                                 \
  X(PFNGLDISABLEIPROC, Disablei)                               \
  X(PFNGLDISPATCHCOMPUTEPROC, DispatchCompute)                 \
  X(PFNGLDISPATCHCOMPUTEINDIRECTPROC, DispatchComputeIndirect) \
  X(PFNGLDRAWARRAYSINDIRECTPROC, DrawArraysIndirect)           \
  X(PFNGLENABLEPROC, Enable)                                   \
  X(PFNGLENABLEIPROC, Enablei)                                 \
  X(PFNGLFENCESYNCPROC, FenceSync)                             \
  X(PFNGLGENBUFFERSPROC, GenBuffers)                           \
  X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)                 \
  X(PFNGLGETBOOLEANI_VPROC, GetBooleani_v)                     \
  X(PFNGLGETBUFFERSUBDATAPROC, GetBufferSubData)               \
  X(PFNGLGETERRORPROC, GetError)                               \
  X(PFNGLGETFLOATI_VPROC, GetFloati_v)                         \
  X(PFNGLGETINTEGERVPROC, GetIntegerv)                         \
  X(PFNGLGETINTEGER64VPROC, GetInteger64v)                     \
  X(PFNGLGETINTEGERI_VPROC, GetIntegeri_v)                     \
  X(PFNGLGETINTEGER64I_VPROC, GetInteger64i_v)                 \
  X(PFNGLGETINTERNALFORMATIVPROC, GetInternalformativ)         \
  X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)             \
  X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                       \
  X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)               \
  X(PFNGLGETSHADERIVPROC, GetShaderiv)                         \
  X(PFNGLGETSTRINGPROC, GetString)                             \
  X(PFNGLGETSTRINGIPROC, GetStringi)                           \
  X(PFNGLISENABLEDPROC, IsEnabled)                             \
  X(PFNGLISENABLEDIPROC, IsEnabledi)                           \
  X(PFNGLISPROGRAMPROC, IsProgram)                             \
  X(PFNGLLINKPROGRAMPROC, LinkProgram)                         \
  X(PFNGLMEMORYBARRIERPROC, MemoryBarrier)                     \
  X(PFNGLOBJECTLABELPROC, ObjectLabel)                         \
  X(PFNGLPIXELSTOREIPROC, PixelStorei)                         \
  X(PFNGLPOLYGONMODEPROC, PolygonMode)                         \
  X(PFNGLSCISSORINDEXEDPROC, ScissorIndexed)                   \
  X(PFNGLSHADERSOURCEPROC, ShaderSource)                       \
  X(PFNGLSTENCILFUNCSEPARATEPROC, StencilFuncSeparate)         \
  X(PFNGLSTENCILOPSEPARATEPROC, StencilOpSeparate)             \
  X(PFNGLUSEPROGRAMPROC, UseProgram)                           \
  X(PFNGLVIEWPORTINDEXEDFPROC, ViewportIndexedf)

struct GlFunctions {
#define VITRAIL_DECLARE(type, name) type name = nullptr;
  VITRAIL_GL_FUNCTIONS(VITRAIL_DECLARE)
#undef VITRAIL_DECLARE
  // Null before OpenGL 4.4 without GL_ARB_buffer_storage.
  PFNGLBUFFERSTORAGEPROC BufferStorage = nullptr;
  PFNGLMAPBUFFERRANGEPROC MapBufferRange = nullptr;
  // Null without GL_KHR_parallel_shader_compile or the extension of ARB.
  PFNGLMAXSHADERCOMPILERTHREADSKHRPROC MaxShaderCompilerThreads = nullptr;
  // Null where the kernels are compiled from GLSL.
  PFNGLSHADERBINARYPROC ShaderBinary = nullptr;
  PFNGLSPECIALIZESHADERARBPROC SpecializeShader = nullptr;

  // Fills the table. Returns the name of a function that is missing, or null where all are there.
  const char* load(VitrailGlGetProcAddress getProcAddress, void* user);
};

} // namespace vitrail
