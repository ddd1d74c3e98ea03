// Surfaces that are blended into the picture by fixed function, as they are drawn: what methods do that only choose an
// order. Transmissive surfaces take dual-source blending: one draw both tints what is behind and adds the reflection.
#pragma once

#include <string>

#include "../method.h"

namespace vitrail::tool {

// Throws GpuError where the scene has transmissive surfaces and the device has no dual-source blending; `method` is who
// needs it.
SurfacePipelines makeBlendedSurfaces(const MethodHost& host, const MethodOptions& options, const std::string& method);
// The same for a program whose name is the method's. `adjust` changes what the pipelines are, all but the blending.
SurfacePipelines makeBlendedSurfaces(const MethodHost& host, const MethodOptions& options,
                                     const SurfaceProgram& program, const SurfacePipelines::Describe& adjust);

// Begins the scope that they are drawn in, over the whole picture: drawn(), tested against the opaque depth. No depth
// is written.
void cmdBeginBlending(Frame& frame);

} // namespace vitrail::tool
