// The finished picture: linear premultiplied colour to 8-bit or 16-bit sRGB with straight alpha (IEC 61966-2-1), or
// handed on as it is.
#version 460

layout(local_size_x = 8, local_size_y = 8) in;

// Of image/picture.h's Encoding.
layout(constant_id = 0) const uint kEncoding = 0u;
const uint SRGB_8 = 0u;
const uint SRGB_16 = 1u;

layout(set = 0, binding = 0, rgba16f) uniform readonly image2D colorImage;
#ifdef ENCODE_IMAGE // whose texels are the same codes, of SRGB_8
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D pixelImage;
#else
layout(set = 0, binding = 1, std430) writeonly buffer PixelBlock { uint pixels[]; }; // one band of rows
#endif

layout(push_constant) uniform Band {
  uint width;
  uint height;   // of the picture
  uint firstRow; // of the band
  uint rows;
};

// Clamps to [0, 1]; a NaN fails the comparison and becomes 0.
float saturate(float v) { return v > 0.0 ? min(v, 1.0) : 0.0; }

float encode(float linear) {
  float v = saturate(linear);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
}

uint quantize(float v, float most) { return uint(v * most + 0.5); }

#ifdef ENCODE_IMAGE
void store8(uvec2 pixel, uint at, uvec4 codes) { imageStore(pixelImage, ivec2(pixel), vec4(codes) / 255.0); }
#else
void store8(uvec2 pixel, uint at, uvec4 codes) {
  pixels[at] = codes.r | codes.g << 8 | codes.b << 16 | codes.a << 24;
}
#endif

void main() {
  uvec2 local = gl_GlobalInvocationID.xy;
  uvec2 pixel = uvec2(local.x, firstRow + local.y);
  if (pixel.x >= width || local.y >= rows || pixel.y >= height) return;
  vec4 color = imageLoad(colorImage, ivec2(pixel));
  uint at = local.y * width + pixel.x;
#ifndef ENCODE_IMAGE
  if (kEncoding > SRGB_16) {
    pixels[2u * at] = packHalf2x16(color.rg);
    pixels[2u * at + 1u] = packHalf2x16(color.ba);
    return;
  }
#endif
  float alpha = saturate(color.a);
  vec3 straight = alpha > 0.0 ? color.rgb / alpha : vec3(0.0);
  float most = kEncoding == SRGB_16 ? 65535.0 : 255.0;
  vec3 coded = vec3(encode(straight.r), encode(straight.g), encode(straight.b));
  // Light beyond alpha, of a reflection on glass or a flame, shines from what alpha leaves free. What rounding puts
  // between the two is not beyond.
  vec3 beyond = max(color.rgb - 1.002 * alpha, 0.0) / max(1.0 - alpha, 1.0e-6);
  vec3 light = vec3(encode(beyond.r), encode(beyond.g), encode(beyond.b));
  float brightest = max(light.r, max(light.g, light.b));
  if (brightest > 0.0) {
    float raised = ceil(mix(alpha, 1.0, brightest) * most) / most;
    coded = mix(light, coded, alpha) / raised;
    alpha = raised;
  }
  uvec4 codes = uvec4(quantize(coded.r, most), quantize(coded.g, most), quantize(coded.b, most), quantize(alpha, most));
#ifndef ENCODE_IMAGE
  if (kEncoding == SRGB_16) {
    pixels[2u * at] = codes.r | codes.g << 16;
    pixels[2u * at + 1u] = codes.b | codes.a << 16;
    return;
  }
#endif
  store8(pixel, at, codes);
}
