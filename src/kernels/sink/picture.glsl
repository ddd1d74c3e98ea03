// How the compute resolve writes the picture: one pixel of the colour image, from its list or its sums and the opaque
// colour. VITRAIL_COLOR_FORMAT is the image's format.
#ifndef VITRAIL_PICTURE_GLSL
#define VITRAIL_PICTURE_GLSL

#include "list/deep.glsl"
#include "list/walk.glsl"
#include "missing.glsl"
#include "sink/samples.glsl"
#include "sink/blend.glsl"
#include "list/sums.glsl"

layout(VITRAIL_BOUND(1, VITRAIL_VIEW_BINDING_COLOR), VITRAIL_COLOR_FORMAT) uniform image2D colorImage;

uvec2 imagePixel(uint pixelIndex) {
  uint width = vitrailParameters.width;
  return uvec2(vitrailParameters.x, vitrailParameters.y) + uvec2(pixelIndex % width, pixelIndex / width);
}

// Before a list of this pixel is looked at.
void beginPixel(uvec2 pixel) {
#ifdef VITRAIL_MULTISAMPLED
  shownPixel = ivec2(pixel);
#endif
}

void writePixel(uvec2 pixel, VitrailSink r) {
#ifdef VITRAIL_MULTISAMPLED
  precise vec4 sum = vec4(0.0);
#define VITRAIL_ADD_SAMPLE(s) if (s < kSamples) sum += over(r.pairs[s], texelFetch(opaqueImage, ivec2(pixel), s));
  VITRAIL_EACH_SAMPLE(VITRAIL_ADD_SAMPLE)
  imageStore(colorImage, ivec2(pixel), sum / float(kSamples));
#else
#ifdef VITRAIL_NO_IMAGE_LOADS
  vec4 behind = texelFetch(opaqueImage, ivec2(pixel), 0);
#else
  vec4 behind = imageLoad(colorImage, ivec2(pixel));
#endif
  imageStore(colorImage, ivec2(pixel), over(r.pairs[0], behind));
#endif
}

// A list that the first dispatch left, and counted, if it followed it to the end.
void writeDeepPixel(uint pixelIndex, VitrailSink r) {
  writePixel(imagePixel(pixelIndex), r);
  if (!r.complete) atomicAdd(vitrailControl.cutPixels, 1u);
#ifndef VITRAIL_GROUPS
  countLayers(r.layers);
  if (kMaxLayers != 0u && r.layers > kMaxLayers) atomicAdd(vitrailControl.approximatePixels, 1u);
#endif
}

// A pixel of a frame that overflowed: all fragments by their sums, which it clears. Returns how many are stored.
uint writeSums(uvec2 local) {
  uint pixelIndex = pixelIndexOf(local);
  VitrailSink r = vitrailSummed(vitrailHeads[pixelIndex], nodesInUse(), readMissing(pixelIndex));
  clearMissing(pixelIndex);
  writePixel(uvec2(vitrailParameters.x, vitrailParameters.y) + local, r);
  return r.layers;
}

#endif
