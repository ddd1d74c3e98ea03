// What both passes know of the scene: the camera and the sky.
#define SCENE_EYE vec3(2.3, 2.15, 4.3)
#define SCENE_LOOK_AT vec3(0.0, -0.12, 0.0)
#define SCENE_FOCAL 2.75    // 1 / tan(half the vertical angle)
#define SCENE_ASPECT 1.3333333
#define SCENE_NEAR 0.1      // there is no far plane
#define SCENE_HORIZON vec3(0.70, 0.77, 0.84)

vec4 toClip(vec3 position) {
  vec3 back = normalize(SCENE_EYE - SCENE_LOOK_AT);
  vec3 right = normalize(cross(vec3(0.0, 1.0, 0.0), back));
  vec3 view = (position - SCENE_EYE) * mat3(right, cross(back, right), back);
  return vec4(SCENE_FOCAL / SCENE_ASPECT * view.x, -SCENE_FOCAL * view.y, -view.z - SCENE_NEAR, -view.z);
}

vec3 skyColor(vec3 direction) {
  return mix(SCENE_HORIZON, vec3(0.20, 0.38, 0.75), clamp(direction.y, 0.0, 1.0)) * (direction.y < 0.0 ? 0.5 : 1.0);
}
