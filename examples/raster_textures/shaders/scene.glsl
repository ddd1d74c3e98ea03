// What all shaders know of the scene: the camera, the light, and where objects are.
#define SCENE_EYE vec3(1.9, 1.45, 3.3)
#define SCENE_LOOK_AT vec3(0.0, -0.22, 0.0)
#define SCENE_FOCAL 2.6     // 1 / tan(half the vertical angle)
#define SCENE_ASPECT 1.3333333
#define SCENE_NEAR 0.1      // there is no far plane
#define SCENE_LIGHT normalize(vec3(-0.5, 1.0, 0.6))
#define SCENE_HORIZON vec3(0.70, 0.77, 0.84)
#define SCENE_AMBIENT 0.35

layout(set = 0, binding = 2, std430) readonly buffer InstanceBlock { mat4 instances[]; };

vec3 toWorld(uint instance, vec3 position) { return (instances[instance] * vec4(position, 1.0)).xyz; }
vec3 turned(uint instance, vec3 normal) { return mat3(instances[instance]) * normal; } // not stretched

vec4 toClip(vec3 position) {
  vec3 back = normalize(SCENE_EYE - SCENE_LOOK_AT);
  vec3 right = normalize(cross(vec3(0.0, 1.0, 0.0), back));
  vec3 view = (position - SCENE_EYE) * mat3(right, cross(back, right), back);
  return vec4(SCENE_FOCAL / SCENE_ASPECT * view.x, -SCENE_FOCAL * view.y, -view.z - SCENE_NEAR, -view.z);
}
