// What the shaders of the method stochastic and C++ share. This file is both GLSL and C++.
#ifndef VITRAIL_TOOL_STOCHASTIC_SHARED_H
#define VITRAIL_TOOL_STOCHASTIC_SHARED_H

#include "gpu/glsl.h"

VITRAIL_SHARED_BEGIN

const uint STOCHASTIC_ALL_CHANNELS = 3u; // the component of a transmittance that is alpha's, then that of all

// Push constants.
struct StochasticPass {
  uint number;
  uint channel; // 0, 1, 2 where each has passes of its own, else STOCHASTIC_ALL_CHANNELS
  float share;  // of the pass in the mean
};

VITRAIL_SHARED_END

#endif
