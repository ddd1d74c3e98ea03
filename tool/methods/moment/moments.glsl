// Four power moments of the absorbance along a pixel's ray, and the transmittance that they tell of. From the papers
// cited in moment.cpp: the quadrature is that of Peters and Klein, "Moment Shadow Mapping" (I3D 2015), whose
// Cholesky factorization solves for the polynomial whose roots are the other nodes.
#ifndef VITRAIL_TOOL_MOMENTS_GLSL
#define VITRAIL_TOOL_MOMENTS_GLSL

layout(push_constant) uniform Depths {
  float scale; // view depth, or with perspective its logarithm, to [-1, 1]
  float offset;
  uint logarithmic;
};

const float BIAS = 5e-7; // towards moments that are always those of some distribution: the paper's for 32 bits
const vec4 BIAS_MOMENTS = vec4(0.0, 0.375, 0.0, 0.375);
const float OVERESTIMATION = 0.25; // of the transmittance between its bounds: the paper's
const float LEAST_TRANSMITTANCE = 1.0 / 4096.0; // that absorbance stays finite

float warpedDepth(float depth) {
  float z = logarithmic != 0u ? log(max(depth, 1e-30)) : depth;
  return clamp(z * scale + offset, -1.0, 1.0);
}

// Of what a surface lets through; with a tint, of the mean over channels.
float absorbance(vec3 transmittance) {
  float mean = dot(transmittance, vec3(1.0 / 3.0));
  return -log(clamp(mean, LEAST_TRANSMITTANCE, 1.0));
}

vec4 powers(float z) {
  float squared = z * z;
  return vec4(z, squared, squared * z, squared * squared);
}

// How much light a surface at `z` sends to the viewer, of one that nothing is before. `total` is the whole absorbance,
// `sums` those of absorbance times the powers of depth.
float transmittanceAt(float z, float total, vec4 sums) {
  if (total <= 0.0) return 1.0;
  vec4 b = mix(sums / total, BIAS_MOMENTS, BIAS);

  // L D L^T of the matrix with rows (1, b1, b2), (b1, b2, b3), (b2, b3, b4).
  float d1 = b.y - b.x * b.x;
  float l1d1 = b.z - b.x * b.y;
  float l1 = l1d1 / d1;
  float d2 = b.w - b.y * b.y - l1d1 * l1;
  // The polynomial c0 + c1 x + c2 x^2 that it maps to (1, z, z^2).
  float c1 = z - b.x;
  float c2 = (z * z - b.y - l1 * c1) / d2;
  c1 = c1 / d1 - l1 * c2;
  float c0 = 1.0 - dot(vec2(c1, c2), b.xy);
  // Its roots, ascending: the nodes beside z. Without c2 one of them is infinitely far away.
  float halfSum = -0.5 * c1 / c2;
  float spread = sqrt(max(halfSum * halfSum - c0 / c2, 0.0));
  float low = halfSum - spread;
  float high = halfSum + spread;

  // The part of the absorbance that lies before z: 0 beyond it, 1 before it, and between the bounds at z itself. The
  // quadratic through the three nodes, by divided differences, is integrated by the moments.
  float atLow = low < z ? 1.0 : 0.0;
  float atHigh = high < z ? 1.0 : 0.0;
  float slopeLow = (atLow - OVERESTIMATION) / (low - z);
  float slopeHigh = (atHigh - atLow) / (high - low);
  float bend = (slopeHigh - slopeLow) / (high - z);
  // OVERESTIMATION + slopeLow (x - z) + bend (x - z) (x - low), in powers of x.
  float part = OVERESTIMATION - slopeLow * z + bend * z * low + (slopeLow - bend * (z + low)) * b.x + bend * b.y;
  return exp(-total * clamp(part, 0.0, 1.0));
}

#endif
