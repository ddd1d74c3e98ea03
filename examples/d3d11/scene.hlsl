// What all shaders know of the scene: the camera, the sky, and the panes.
static const float3 kEye = float3(2.3, 2.15, 4.3);
static const float3 kLookAt = float3(0.0, -0.12, 0.0);
static const float3 kHorizon = float3(0.70, 0.77, 0.84);
static const float kFocal = 2.75;
static const float kNear = 0.1; // there is no far plane

struct Corner {
  float4 clip : SV_Position;
  float3 position : POSITION;
  float2 place : PLACE; // in the square, -1 to 1
  nointerpolation int axis : AXIS;
};

float4 toClip(float3 position) {
  float3 back = normalize(kEye - kLookAt);
  float3 right = normalize(cross(float3(0.0, 1.0, 0.0), back));
  float3 away = position - kEye;
  float3 view = float3(dot(away, right), dot(away, cross(back, right)), dot(away, back));
  return float4(kFocal * 0.75 * view.x, kFocal * view.y, -view.z - kNear, -view.z);
}

float3 skyColor(float3 direction) {
  float3 sky = lerp(kHorizon, float3(0.20, 0.38, 0.75), saturate(direction.y));
  return sky * (direction.y < 0.0 ? 0.5 : 1.0);
}

// Pane -1 is a wide floor; the nine others are square panes, three across each axis, each cutting through six others.
Corner corner(uint vertex, int pane) {
  Corner c;
  c.axis = pane < 0 ? 1 : int(uint(pane) / 3u);
  c.place = float2(vertex & 1u, vertex >> 1) * 2.0 - 1.0;
  float across = pane < 0 ? -1.0 : 0.62 * (float(uint(pane) % 3u) - 1.0);
  float2 spread = c.place * (pane < 0 ? 60.0 : 1.0);
  c.position = float3(across, spread.x, spread.y); // turned to its axis
  if (c.axis == 1) c.position = c.position.zxy;
  if (c.axis == 2) c.position = c.position.yzx;
  c.clip = toClip(c.position);
  return c;
}
