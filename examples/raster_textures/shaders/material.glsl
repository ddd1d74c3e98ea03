// The materials: leaves whose texture cuts them out, and stained glass. Any shader may call this, because it is given
// how texture coordinates change from a pixel to the next: nothing in it is a fragment shader's own.
#define MATERIAL_LEAF 0u // a layer of the texture each
#define MATERIAL_GLASS 1u

layout(set = 0, binding = 0) uniform sampler2DArray materialTextures;

struct Point {
  vec3 position; // in the world, as the normal
  vec3 normal;
  vec2 texCoord;
  vec2 texCoordRight; // what it changes by a pixel to the right
  vec2 texCoordDown;
  bool front;
};

// Linear colour, straight alpha; of alpha 0 where the texture cuts the surface away.
vec4 materialColor(uint material, Point point) {
  vec4 texel = textureGrad(materialTextures, vec3(point.texCoord, material), point.texCoordRight, point.texCoordDown);
  if (material == MATERIAL_LEAF && texel.a < 0.3) return vec4(0.0);
  vec3 normal = normalize(point.front ? point.normal : -point.normal);
  float light = dot(normal, SCENE_LIGHT);
  if (material == MATERIAL_LEAF) {
    float lit = light > 0.0 ? light : -0.6 * light; // some of the light behind it comes through
    return vec4(min(texel.rgb * (SCENE_AMBIENT + lit), 1.0), texel.a);
  }
  vec3 halfway = normalize(normalize(SCENE_EYE - point.position) + SCENE_LIGHT);
  float glint = pow(max(dot(normal, halfway), 0.0), 60.0);
  vec3 color = texel.rgb * (SCENE_AMBIENT + max(light, 0.0));
  return vec4(min(mix(color, vec3(1.0), glint), 1.0), mix(texel.a, 1.0, glint));
}
