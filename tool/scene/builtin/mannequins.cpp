// Jointed artist's mannequins of coloured glass, in rows on a round stage, with opaque teapots between them. Every
// figure has its own pose and colour; all of them share the meshes of one body.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

#include "parts.h"
#include "random.h"
#include "shapes.h"
#include "teapot.h"

namespace vitrail::tool {
namespace {

// In metres.
constexpr float spacing = 0.95F; // between figures
constexpr float hipToKnee = 0.445F;
constexpr float kneeToAnkle = 0.42F;
constexpr float ankleHeight = 0.071F;

const glm::mat4 identity(1.0F);

glm::mat4 moved(const glm::mat4& frame, float x, float y, float z) { return glm::translate(frame, glm::vec3(x, y, z)); }

// Turned around one of the axes, in degrees.
glm::mat4 pitched(const glm::mat4& frame, float degrees) {
  return glm::rotate(frame, glm::radians(degrees), glm::vec3(1.0F, 0.0F, 0.0F));
}
glm::mat4 yawed(const glm::mat4& frame, float degrees) {
  return glm::rotate(frame, glm::radians(degrees), glm::vec3(0.0F, 1.0F, 0.0F));
}
glm::mat4 rolled(const glm::mat4& frame, float degrees) {
  return glm::rotate(frame, glm::radians(degrees), glm::vec3(0.0F, 0.0F, 1.0F));
}
glm::mat4 scaled(const glm::mat4& frame, float x, float y, float z) { return glm::scale(frame, glm::vec3(x, y, z)); }

// A smooth closed body of revolution through radii at heights, from the top down: Catmull-Rom between them.
Mesh turnedBody(std::span<const glm::vec2> radiusAtHeight, std::uint32_t segments) {
  constexpr std::uint32_t steps = 6;
  const auto at = [&](std::size_t k) { return radiusAtHeight[std::min(k, radiusAtHeight.size() - 1)]; };
  std::vector<ProfilePoint> profile;
  for (std::size_t k = 0; k + 1 < radiusAtHeight.size(); ++k) {
    // Mirrored ends make the curve cross the axis at a right angle.
    const glm::vec2 before = k == 0 ? at(1) * glm::vec2(-1.0F, 1.0F) : at(k - 1);
    const glm::vec2 after = k + 2 == radiusAtHeight.size() ? at(k) * glm::vec2(-1.0F, 1.0F) : at(k + 2);
    const bool last = k + 2 == radiusAtHeight.size();
    for (std::uint32_t i = 0; i < steps + (last ? 1 : 0); ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(steps);
      const glm::vec2 a = 0.5F * (after - before + 3.0F * (at(k) - at(k + 1)));
      const glm::vec2 b = before - 2.5F * at(k) + 2.0F * at(k + 1) - 0.5F * after;
      const glm::vec2 c = 0.5F * (at(k + 1) - before);
      const glm::vec2 point = ((a * t + b) * t + c) * t + at(k);
      const glm::vec2 along = (3.0F * a * t + 2.0F * b) * t + c;
      const bool onAxis = (k == 0 && i == 0) || (last && i == steps);
      profile.push_back({onAxis ? 0.0F : point.x, point.y, {-along.y, along.x}});
    }
  }
  return lathe(profile, segments);
}

// The meshes of a body, shared by all figures. Limbs hang down from their joint at the origin.
struct Body {
  std::uint32_t ball, head, chest, hips, upperArm, foreArm, hand, thigh, shin, foot;
};

Mesh limb(float topRadius, float bottomRadius, float length) {
  Mesh mesh = capsule(topRadius, bottomRadius, 0.5F * (length - topRadius - bottomRadius), 20, 6);
  const float shift = -topRadius - 0.5F * (length - topRadius - bottomRadius);
  for (glm::vec3& position : mesh.positions) position.y += shift;
  return mesh;
}

Body addBody(Scene& scene) {
  constexpr std::array<glm::vec2, 6> head{
      {{0.0F, 0.25F}, {0.062F, 0.225F}, {0.089F, 0.15F}, {0.074F, 0.06F}, {0.04F, 0.012F}, {0.0F, 0.0F}}};
  constexpr std::array<glm::vec2, 7> chest{{{0.0F, 0.37F},
                                            {0.10F, 0.345F},
                                            {0.165F, 0.27F},
                                            {0.155F, 0.17F},
                                            {0.118F, 0.07F},
                                            {0.07F, 0.012F},
                                            {0.0F, 0.0F}}};
  constexpr std::array<glm::vec2, 6> hips{
      {{0.0F, 0.0F}, {0.075F, -0.012F}, {0.125F, -0.07F}, {0.135F, -0.13F}, {0.085F, -0.185F}, {0.0F, -0.2F}}};
  Body body{};
  body.ball = addMesh(scene, uvSphere(20, 12));
  body.head = addMesh(scene, turnedBody(head, 24));
  body.chest = addMesh(scene, turnedBody(chest, 28));
  body.hips = addMesh(scene, turnedBody(hips, 28));
  body.upperArm = addMesh(scene, limb(0.05F, 0.036F, 0.29F));
  body.foreArm = addMesh(scene, limb(0.04F, 0.026F, 0.25F));
  body.hand = addMesh(scene, limb(0.034F, 0.022F, 0.17F));
  body.thigh = addMesh(scene, limb(0.078F, 0.05F, 0.41F));
  body.shin = addMesh(scene, limb(0.055F, 0.034F, 0.40F));
  body.foot = addMesh(scene, limb(0.04F, 0.034F, 0.25F));
  return body;
}

// Joint angles in degrees. Positive pitches swing a limb forward, lifts swing it outward.
struct Posture {
  float lean, twist, headTurn, headNod;
  std::array<float, 2> shoulderPitch, shoulderLift, elbow, hipPitch, knee;
};

// Standing or striding, with arms anywhere between hanging and raised. Both feet stay near the floor.
Posture randomPose(Random& random) {
  Posture pose{};
  pose.lean = random.range(-4.0F, 6.0F);
  pose.twist = random.range(-18.0F, 18.0F);
  pose.headTurn = random.range(-40.0F, 40.0F);
  pose.headNod = random.range(-15.0F, 12.0F);
  const float stride = random.range(-26.0F, 26.0F);
  for (std::size_t side = 0; side < 2; ++side) {
    const bool raised = random.below(4) == 0;
    pose.shoulderLift[side] = raised ? random.range(60.0F, 150.0F) : random.range(6.0F, 28.0F);
    pose.shoulderPitch[side] = raised ? random.range(-10.0F, 30.0F) : random.range(-25.0F, 45.0F);
    pose.elbow[side] = random.range(8.0F, 85.0F);
    pose.hipPitch[side] = side == 0 ? stride : -stride;
    pose.knee[side] = random.range(2.0F, 8.0F) + std::max(-pose.hipPitch[side], 0.0F) * 0.6F;
  }
  return pose;
}

// Builds one figure out of draws.
class Figure {
 public:
  Figure(Scene& scene, const Body& body, std::uint32_t material) : scene_(scene), body_(body), material_(material) {}

  // floor: a frame with the floor's height between the feet; the figure faces its +Z.
  void add(const glm::mat4& floor, const Posture& pose) {
    const glm::mat4 pelvis = moved(floor, 0.0F, hipHeight(pose), 0.0F);
    place(body_.hips, scaled(moved(pelvis, 0.0F, 0.12F, 0.0F), 1.0F, 1.0F, 0.75F));
    ball(moved(pelvis, 0.0F, 0.155F, 0.0F), 0.055F);
    const glm::mat4 waist = yawed(pitched(moved(pelvis, 0.0F, 0.155F, 0.0F), pose.lean), pose.twist);
    place(body_.chest, scaled(moved(waist, 0.0F, 0.04F, 0.0F), 1.0F, 1.0F, 0.68F));
    ball(moved(waist, 0.0F, 0.435F, 0.0F), 0.042F);
    const glm::mat4 neck = pitched(yawed(moved(waist, 0.0F, 0.435F, 0.0F), pose.headTurn), pose.headNod);
    place(body_.head, scaled(moved(neck, 0.0F, 0.035F, 0.01F), 0.95F, 1.0F, 1.1F));
    for (std::size_t side = 0; side < 2; ++side) {
      addArm(waist, pose, side);
      addLeg(pelvis, pose, side);
    }
  }

 private:
  void place(std::uint32_t mesh, const glm::mat4& transform) { scene_.draws.push_back({mesh, material_, transform}); }
  void ball(const glm::mat4& frame, float radius) { place(body_.ball, scaled(frame, radius, radius, radius)); }

  // The hips sink with the stride, so that the lower foot stands on the floor.
  static float hipHeight(const Posture& pose) {
    float reach = 0.0F;
    for (std::size_t side = 0; side < 2; ++side) {
      const float hip = glm::radians(pose.hipPitch[side]);
      const float knee = glm::radians(pose.hipPitch[side] - pose.knee[side]);
      reach = std::max(reach, hipToKnee * std::cos(hip) + kneeToAnkle * std::cos(knee));
    }
    return reach + ankleHeight;
  }

  void addArm(const glm::mat4& waist, const Posture& pose, std::size_t side) {
    const float outward = side == 0 ? 1.0F : -1.0F;
    glm::mat4 frame = moved(waist, outward * 0.215F, 0.33F, 0.0F);
    ball(frame, 0.05F);
    frame = pitched(rolled(frame, outward * pose.shoulderLift[side]), -pose.shoulderPitch[side]);
    place(body_.upperArm, moved(frame, 0.0F, -0.045F, 0.0F));
    frame = moved(frame, 0.0F, -0.36F, 0.0F);
    ball(frame, 0.034F);
    frame = pitched(frame, -pose.elbow[side]);
    place(body_.foreArm, moved(frame, 0.0F, -0.03F, 0.0F));
    frame = moved(frame, 0.0F, -0.3F, 0.0F);
    ball(frame, 0.025F);
    place(body_.hand, scaled(moved(frame, 0.0F, -0.02F, 0.0F), 0.7F, 1.0F, 1.3F));
  }

  void addLeg(const glm::mat4& pelvis, const Posture& pose, std::size_t side) {
    const float outward = side == 0 ? 1.0F : -1.0F;
    glm::mat4 frame = moved(pelvis, outward * 0.092F, 0.0F, 0.0F);
    ball(moved(frame, 0.0F, -0.005F, 0.0F), 0.05F);
    frame = pitched(frame, -pose.hipPitch[side]);
    place(body_.thigh, moved(frame, 0.0F, -0.035F, 0.0F));
    frame = moved(frame, 0.0F, -hipToKnee, 0.0F);
    ball(frame, 0.045F);
    frame = pitched(frame, pose.knee[side]);
    place(body_.shin, moved(frame, 0.0F, -0.03F, 0.0F));
    frame = moved(frame, 0.0F, -kneeToAnkle, 0.0F);
    ball(frame, 0.032F);
    // The foot lies flat on the floor, whatever the leg does.
    frame = pitched(frame, pose.hipPitch[side] - pose.knee[side]);
    place(body_.foot, scaled(pitched(moved(frame, 0.0F, -0.035F, -0.07F), -90.0F), 1.1F, 1.0F, 0.85F));
  }

  Scene& scene_;
  const Body& body_;
  std::uint32_t material_;
};

Material opaqueMaterial(const std::string& name, const glm::vec3& srgb, float roughness) {
  Material material;
  material.name = name;
  material.baseColor = glm::vec4(linearFromSrgb(srgb), 1.0F);
  material.metallic = 0.0F;
  material.roughness = roughness;
  return material;
}

// Where the rows of figures stand: `side` of them, around the middle.
float rowPosition(float row, std::uint32_t side) { return (row - 0.5F * static_cast<float>(side - 1)) * spacing; }

// Teapots stand in every other gap between four figures.
void addTeapots(Scene& scene, std::uint32_t side, Random& random) {
  constexpr std::array<glm::vec3, 3> colors{{{0.92F, 0.90F, 0.84F}, {0.80F, 0.36F, 0.22F}, {0.20F, 0.42F, 0.52F}}};
  constexpr float size = 0.115F; // metres in one of Newell's units
  const std::uint32_t mesh = addMesh(scene, teapot(12));
  std::array<std::uint32_t, 3> materials{};
  for (std::size_t i = 0; i < colors.size(); ++i) {
    Material material = opaqueMaterial("teapot " + std::to_string(i), colors[i], 0.25F);
    material.doubleSided = true;
    materials[i] = addMaterial(scene, std::move(material));
  }
  const std::uint32_t gaps = std::max(side - 1, 1U);
  for (std::uint32_t z = 0; z < gaps; ++z) {
    for (std::uint32_t x = z % 2; x < gaps; x += 2) {
      // Just above the floor: no two opaque surfaces share a plane.
      const glm::mat4 place = moved(identity, rowPosition(static_cast<float>(x) + 0.5F, side), 0.001F,
                                    rowPosition(static_cast<float>(z) + 0.5F, side));
      const std::uint32_t material = materials[random.below(3)];
      scene.draws.push_back({mesh, material, scaled(yawed(place, random.range(0.0F, 360.0F)), size, size, size)});
    }
  }
}

void addStage(Scene& scene, float radius) {
  const std::uint32_t stage = addMesh(scene, disc(radius, 0.1F, 0.04F, 128));
  const std::uint32_t material = addMaterial(scene, opaqueMaterial("stage", {0.62F, 0.60F, 0.57F}, 0.8F));
  scene.draws.push_back({stage, material, moved(identity, 0.0F, -0.1F, 0.0F)});
}

} // namespace

Scene makeMannequins(std::uint32_t count, std::uint32_t seed) {
  Random random(seed);
  Scene scene;
  scene.name = "mannequins";
  scene.background = Background{Background::Kind::Sky, glm::vec3(1.0F)};
  const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<float>(count))));
  addStage(scene, static_cast<float>(side - 1) * std::numbers::sqrt2_v<float> * 0.5F * spacing + 0.95F);
  addTeapots(scene, side, random);

  const Body body = addBody(scene);
  const float firstHue = random.uniform();
  for (std::uint32_t i = 0; i < count; ++i) {
    const float hue = firstHue + 0.61803399F * static_cast<float>(i);
    const float saturation = random.range(0.45F, 0.85F);
    Material material = glassMaterial(colorFromHue(hue, saturation, 0.95F), random.range(0.3F, 0.65F), 0.3F);
    material.name = "figure " + std::to_string(i);
    const float facing = random.range(-35.0F, 35.0F);
    const float height = random.range(0.92F, 1.04F);
    const std::uint32_t row = i / side;
    const std::uint32_t column = i % side;
    const glm::mat4 floor = moved(identity, rowPosition(static_cast<float>(column), side), 0.0F,
                                  rowPosition(static_cast<float>(row), side));
    const std::uint32_t index = addMaterial(scene, std::move(material));
    Figure(scene, body, index).add(scaled(yawed(floor, facing), height, height, height), randomPose(random));
  }
  return scene;
}

} // namespace vitrail::tool
