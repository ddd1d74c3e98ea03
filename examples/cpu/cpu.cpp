// A complete host without a GPU or a graphics API (cpu PICTURE.ppm): the cube of glass panes that examples/minimal
// draws with Vulkan. What concerns Vitrail is in the shade functions, in drawOf() and in draw().
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <vector>

#include <vitrail/cpu.h>

constexpr uint32_t kWidth = 800, kHeight = 600;
using Vec = std::array<float, 3>;
Vec operator+(Vec a, Vec b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec operator-(Vec a, Vec b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec operator*(float s, Vec a) { return {s * a[0], s * a[1], s * a[2]}; }
float dot(Vec a, Vec b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec cross(Vec a, Vec b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
Vec unit(Vec a) { return 1 / std::sqrt(dot(a, a)) * a; }
Vec mix(Vec a, Vec b, float t) { return a + t * (b - a); }
float smooth(float x) { return x <= 0 ? 0 : x >= 1 ? 1 : x * x * (3 - 2 * x); }

constexpr Vec kEye{2.3F, 2.15F, 4.3F}, kLookAt{0, -0.12F, 0};
constexpr Vec kHorizon{0.70F, 0.77F, 0.84F}, kZenith{0.20F, 0.38F, 0.75F};
constexpr Vec kTints[3] = {{0.60F, 0.90F, 0.95F}, {0.98F, 0.86F, 0.52F}, {0.96F, 0.64F, 0.76F}};
Vec sky(Vec ray) { return (ray[1] < 0 ? 0.5F : 1.0F) * mix(kHorizon, kZenith, std::clamp(ray[1], 0.0F, 1.0F)); }

using Corners = std::vector<Vec>; // three a triangle

// A square across an axis, as two triangles.
void addSquare(Corners& corners, int axis, float offset, float size) {
  for (const int i : {0, 1, 2, 2, 1, 3}) {
    Vec p{};
    p[axis] = offset;
    p[(axis + 1) % 3] = i % 2 == 0 ? -size : size;
    p[(axis + 2) % 3] = i / 2 == 0 ? -size : size;
    corners.push_back(p);
  }
}

// Where fragment i is in the world. Whatever stands at the corners is interpolated like this.
Vec positionOf(void* user, const VitrailCpuFragments& f, int i) {
  const Vec* corner = static_cast<Corners*>(user)->data() + 3 * size_t{f.triangle[i]};
  return corner[0] + f.second[i] * (corner[1] - corner[0]) + f.third[i] * (corner[2] - corner[0]);
}

// A chequered floor that is darker below the cube and fades into the distance.
void shadeFloor(void* corners, VitrailCpuFragments* f) {
  for (int i = 0; i < VITRAIL_CPU_LANES; ++i) {
    const Vec p = positionOf(corners, *f, i);
    const float square = std::floor(2 * p[0]) + std::floor(2 * p[2]);
    const Vec color = std::fmod(square, 2.0F) == 0 ? Vec{0.74F, 0.72F, 0.68F} : Vec{0.28F, 0.29F, 0.32F};
    const float away = std::hypot(std::max(std::abs(p[0]) - 0.8F, 0.0F), std::max(std::abs(p[2]) - 0.8F, 0.0F));
    const float fog = smooth((std::sqrt(dot(p - kEye, p - kEye)) - 7) / 13);
    const Vec shaded = mix((0.55F + 0.45F * smooth(away / 1.2F)) * color, kHorizon, fog);
    for (int c = 0; c < 3; ++c) f->color[c][i] = shaded[c];
  }
}

// Tinted glass: what it reflects itself, in front of a filter for what is behind it.
void shadeGlass(void* corners, VitrailCpuFragments* f) {
  for (int i = 0; i < VITRAIL_CPU_LANES; ++i) {
    const int axis = static_cast<int>(f->triangle[i] / 6); // two triangles a pane, three panes across each axis
    const Vec p = positionOf(corners, *f, i);
    Vec ray = unit(p - kEye);
    const bool isRim = std::max(std::abs(p[(axis + 1) % 3]), std::abs(p[(axis + 2) % 3])) >= 0.965F;   // ground glass
    const float reflectance = isRim ? 0.55F : 0.04F + 0.96F * std::pow(1 - std::abs(ray[axis]), 5.0F); // Schlick's
    ray[axis] = -ray[axis];
    for (int c = 0; c < 3; ++c) f->color[c][i] = reflectance * sky(ray)[c];
    f->color[3][i] = reflectance;
    for (int c = 0; c < 3; ++c) f->filter[c][i] = kTints[axis][c];
  }
}

VitrailCpuDraw drawOf(Corners& corners, const std::vector<float>& camera, VitrailCpuShade shade) {
  VitrailCpuDraw draw{.positions = corners[0].data(), .components = 3, .transform = camera.data(), .shade = shade};
  draw.vertexCount = static_cast<uint32_t>(corners.size());
  draw.shadeUser = &corners;
  return draw;
}

// Draws the scene over a plain sky: false, and a line on standard error, where that fails.
bool draw(std::vector<uint8_t>& pixels) {
  Corners floor, glass;
  addSquare(floor, 1, -1, 60);
  for (int pane = 0; pane < 9; ++pane) addSquare(glass, pane / 3, 0.62F * static_cast<float>(pane % 3 - 1), 1);
  // World to clip space: the camera's axes, 1 / tan(half the vertical angle), the near plane at 0.1, and no far plane.
  const Vec back = unit(kEye - kLookAt), right = unit(cross({0, 1, 0}, back)), up = cross(back, right);
  std::vector<float> camera;
  for (int i = 0; i < 4; ++i) {
    const auto along = [&](Vec axis) { return i < 3 ? axis[i] : -dot(axis, kEye); };
    const float depth = -along(back), near = i < 3 ? 0 : 0.1F;
    camera.insert(camera.end(), {2.75F * kHeight / kWidth * along(right), -2.75F * along(up), depth - near, depth});
  }
  VitrailCpuDraw draws[2] = {drawOf(floor, camera, shadeFloor), drawOf(glass, camera, shadeGlass)};
  draws[0].surface = VITRAIL_CPU_OPAQUE;
  draws[1].blend = VITRAIL_BLEND_PREMULTIPLIED;
  draws[1].shadeFlags = VITRAIL_CPU_SHADE_FILTER;
  const uint8_t horizon[4] = {218, 227, 236, 255}; // kHorizon on the sRGB curve
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = horizon[i % 4];
  VitrailCpuFrame frame{.width = kWidth, .height = kHeight, .samples = 4, .colorFormat = VITRAIL_CPU_RGBA8_SRGB};
  frame.color = pixels.data();
  const VitrailLog log = [](VitrailLogSeverity, const char* text, void*) { std::fprintf(stderr, "cpu: %s\n", text); };
  const VitrailCpuContextDesc desc{.log = log};
  VitrailCpuContext context = nullptr;
  VitrailResult result = vitrailCpuCreateContext(&desc, &context);
  if (result == VITRAIL_SUCCESS) result = vitrailCpuRender(context, &frame, draws, 2, nullptr);
  vitrailCpuDestroyContext(context);
  return result == VITRAIL_SUCCESS;
}

int main(int argc, char** argv) {
  std::vector<uint8_t> pixels(size_t{4} * kWidth * kHeight);
  if (argc != 2 || !draw(pixels)) return 1;
  std::ofstream file(argv[1], std::ios::binary);
  file << "P6 " << kWidth << ' ' << kHeight << " 255\n";
  for (size_t i = 0; i < pixels.size(); i += 4) file.write(reinterpret_cast<const char*>(&pixels[i]), 3);
  return file.flush() ? 0 : 1;
}
