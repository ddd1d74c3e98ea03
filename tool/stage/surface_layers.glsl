// What glTF's extensions lay over a surface, and the scene's own lights: docs/shading.md states each. A part of
// surface.glsl.
#ifndef VITRAIL_TOOL_SURFACE_LAYERS_GLSL
#define VITRAIL_TOOL_SURFACE_LAYERS_GLSL

// How strongly a light shines at the surface, and from where.
vec3 lightAt(LightData light, out vec3 l) {
  uint kind = uint(light.direction.w);
  l = -light.direction.xyz;
  if (kind == LIGHT_DIRECTIONAL) return light.intensity.rgb;
  vec3 way = light.position.xyz - inPosition;
  float squared = dot(way, way);
  l = direction(way, l);
  float relative = squared * light.position.w * light.position.w;
  float share = squared > 0.0 ? clamp(1.0 - relative * relative, 0.0, 1.0) / squared : 0.0;
  if (kind == LIGHT_SPOT) {
    float cone = clamp(dot(-l, light.direction.xyz) * light.cone.x + light.cone.y, 0.0, 1.0);
    share *= cone * cone;
  }
  return light.intensity.rgb * share;
}

// KHR_materials_clearcoat: a layer of varnish with an index of 1.5.
struct Coat {
  vec3 normal;
  float a2;
  float share; // of the light that it reflects, straight from the surface to the eye
};

Coat coatOf(vec3 normal, vec3 view, float factor, float roughness) {
  float r = clamp(material.clearcoatRoughness * roughness, 0.045, 1.0);
  float fresnel = 0.04 + 0.96 * grazing(max(dot(normal, view), 0.0001));
  return Coat(normal, r * r * r * r, clamp(material.clearcoat * factor, 0.0, 1.0) * fresnel);
}

float coatLobe(Coat coat, vec3 view, vec3 l) {
  float nl = dot(coat.normal, l);
  if (nl <= 0.0) return 0.0;
  vec3 h = direction(l + view, coat.normal);
  return nl * distribution(coat.normal, h, coat.a2) * visibility(nl, max(dot(coat.normal, view), 0.0001), coat.a2);
}

// KHR_materials_sheen: fibres that stand up.
struct Sheen {
  vec3 color;
  float roughness;
  float albedo; // what a white sheen reflects of light from everywhere
  float leaves; // the share of the light that is left to what is below
};

float sheenLobe(Sheen sheen, vec3 n, vec3 h, float nl, float nv) {
  float power = 1.0 / (sheen.roughness * sheen.roughness);
  float sine = min(length(cross(n, h)), 1.0);
  return (2.0 + power) * pow(sine, power) / (2.0 * PI) / (4.0 * (nl + nv - nl * nv));
}

// What a white sheen reflects of light from everywhere, by roughness (0, 1/7, ... 1) and the cosine from the normal
// (the same, two vectors).
const vec4 SHEEN_ALBEDO[16] = vec4[](
    vec4(1.000, 0.316, 0.014, 0.000), vec4(0.000, 0.000, 0.000, 0.000), vec4(1.000, 0.646, 0.170, 0.037),
    vec4(0.006, 0.001, 0.000, 0.000), vec4(1.000, 0.667, 0.353, 0.182), vec4(0.086, 0.035, 0.010, 0.001),
    vec4(1.000, 0.598, 0.392, 0.257), vec4(0.163, 0.095, 0.048, 0.016), vec4(0.848, 0.543, 0.394, 0.289),
    vec4(0.209, 0.144, 0.092, 0.049), vec4(0.741, 0.504, 0.388, 0.303), vec4(0.236, 0.179, 0.129, 0.085),
    vec4(0.675, 0.478, 0.381, 0.310), vec4(0.252, 0.202, 0.158, 0.116), vec4(0.633, 0.460, 0.376, 0.314),
    vec4(0.263, 0.219, 0.179, 0.141));

// By the weights of linear interpolation: an index into an array would take drivers on CPUs longer to compile.
float sheenAlbedo(float roughness, float cosine) {
  vec4 low = max(1.0 - abs(7.0 * cosine - vec4(0.0, 1.0, 2.0, 3.0)), 0.0);
  vec4 high = max(1.0 - abs(7.0 * cosine - vec4(4.0, 5.0, 6.0, 7.0)), 0.0);
  float sum = 0.0;
  for (int r = 0; r < 8; ++r) {
    float weight = max(1.0 - abs(7.0 * roughness - float(r)), 0.0);
    sum += weight * (dot(low, SHEEN_ALBEDO[2 * r]) + dot(high, SHEEN_ALBEDO[2 * r + 1]));
  }
  return sum;
}

Sheen sheenOf(vec3 color, float roughness, float nv) {
  Sheen sheen;
  sheen.color = material.sheen.rgb * color;
  sheen.roughness = clamp(material.sheen.a * roughness, 0.07, 1.0);
  sheen.albedo = sheenAlbedo(sheen.roughness, min(nv, 1.0));
  sheen.leaves = 1.0 - min(max(sheen.color.r, max(sheen.color.g, sheen.color.b)), 1.0) * sheen.albedo;
  return sheen;
}

// KHR_materials_anisotropy: fine grooves, which stretch the highlight across them.
struct Grooves {
  vec3 tangent;
  vec3 bitangent;
  float along; // the roughness a along the tangent and across it
  float across;
};

// `texel`: the direction in red and green, the strength in blue.
Grooves groovesOf(vec4 tangent, vec3 normal, float roughness, vec3 texel) {
  vec2 turned = texel.rg * 2.0 - 1.0;
  float c = material.anisotropy.y;
  float s = material.anisotropy.z;
  turned = vec2(turned.x * c - turned.y * s, turned.x * s + turned.y * c);
  vec3 bitangent = cross(normal, tangent.xyz) * tangent.w;
  vec3 t = direction(tangent.xyz * turned.x + bitangent * turned.y, tangent.xyz);
  float a = roughness * roughness;
  float strength = clamp(material.anisotropy.x * texel.b, 0.0, 1.0);
  return Grooves(t, cross(normal, t), mix(a, 1.0, strength * strength), a);
}

float groovesLobe(Grooves g, vec3 n, vec3 v, vec3 l, vec3 h) {
  float nl = max(dot(n, l), 0.0);
  float nv = max(dot(n, v), 0.0001);
  float both = g.along * g.across;
  // As distribution() does, without the difference that cancels near the highlight's centre.
  vec3 f = vec3(g.across * dot(g.tangent, h), g.along * dot(g.bitangent, h), both * dot(n, h));
  float w = both / dot(f, f);
  float masked = nl * length(vec3(g.along * dot(g.tangent, v), g.across * dot(g.bitangent, v), nv));
  float shadowed = nv * length(vec3(g.along * dot(g.tangent, l), g.across * dot(g.bitangent, l), nl));
  return both * w * w / PI * 0.5 / (masked + shadowed);
}

// What the eye makes of light that a path difference (nanometres) and a shift of its phase leave.
vec3 interference(float difference, vec3 shift) {
  float phase = 2.0 * PI * difference * 1.0e-9;
  vec3 height = vec3(5.4856e-13, 4.4201e-13, 5.2481e-13);
  vec3 middle = vec3(1.6810e+06, 1.7953e+06, 2.2084e+06);
  vec3 width = vec3(4.3278e+09, 9.3046e+09, 6.6121e+09);
  vec3 xyz = height * sqrt(2.0 * PI * width) * cos(middle * phase + shift) * exp(-phase * phase * width);
  xyz.x += 9.7470e-14 * sqrt(2.0 * PI * 4.5282e+09) * cos(2.2399e+06 * phase + shift.x) *
           exp(-4.5282e+09 * phase * phase);
  mat3 toRgb = mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560,
                    1.0572252);
  return toRgb * (xyz / 1.0685e-7);
}

// KHR_materials_iridescence: what a film of some nanometres reflects, over a surface that reflects `f0`, seen at a
// cosine from its normal.
vec3 filmReflection(vec3 f0, float cosine, float filmIndex, float thickness) {
  float index = mix(1.0, filmIndex, smoothstep(0.0, 0.03, thickness));
  float below = 1.0 - (1.0 - cosine * cosine) / (index * index);
  if (below < 0.0) return vec3(1.0);
  below = sqrt(below);
  float top0 = (index - 1.0) / (index + 1.0);
  top0 *= top0;
  float top = top0 + (1.0 - top0) * grazing(cosine);
  vec3 root = sqrt(clamp(f0, 0.0, 0.9999));
  vec3 base = (1.0 + root) / (1.0 - root); // its index
  vec3 bottom0 = (base - index) / (base + index);
  bottom0 *= bottom0;
  vec3 bottom = bottom0 + (1.0 - bottom0) * grazing(below);
  vec3 shift = vec3(index < 1.0 ? 0.0 : PI) + mix(vec3(0.0), vec3(PI), lessThan(base, vec3(index)));
  float difference = 2.0 * index * thickness * below;
  vec3 both = clamp(top * bottom, 1.0e-5, 0.9999);
  vec3 passed = (1.0 - top) * (1.0 - top) * bottom / (1.0 - both);
  vec3 sum = top + passed;
  vec3 order = passed - (1.0 - top);
  for (int m = 1; m <= 2; ++m) {
    order *= sqrt(both);
    sum += order * 2.0 * interference(float(m) * difference, float(m) * shift);
  }
  return clamp(sum, 0.0, 1.0);
}

#endif
