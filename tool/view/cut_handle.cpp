#include "cut_handle.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <imgui.h>

#include "../scene/turn.h"

namespace vitrail::tool {

namespace {

constexpr ImU32 kLine = IM_COL32(255, 160, 0, 255);
constexpr ImU32 kFill = IM_COL32(255, 160, 0, 40);

// A plane in the scene: points with dot(normal, point) + offset >= 0 are kept.
struct CutPlane {
  glm::dvec3 normal;
  double offset;
};

// Where it cuts the edges of a box, around their middle.
std::vector<glm::dvec3> outlineOf(const CutPlane& plane, const Bounds& bounds) {
  std::vector<glm::dvec3> points;
  const auto corner = [&](unsigned i) {
    const glm::vec3& low = bounds.min;
    const glm::vec3& high = bounds.max;
    return glm::dvec3((i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y, (i & 4U) != 0 ? high.z : low.z);
  };
  for (unsigned i = 0; i < 8; ++i) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if ((i & axis) != 0) continue;
      const glm::dvec3 a = corner(i);
      const glm::dvec3 b = corner(i | axis);
      const double atA = glm::dot(plane.normal, a) + plane.offset;
      const double atB = glm::dot(plane.normal, b) + plane.offset;
      if ((atA < 0.0) != (atB < 0.0)) points.push_back(a + (b - a) * (atA / (atA - atB)));
    }
  }
  if (points.size() < 3) return {};
  glm::dvec3 middle(0.0);
  for (const glm::dvec3& point : points) middle += point / static_cast<double>(points.size());
  const glm::dvec3 u = glm::normalize(points[0] - middle);
  const glm::dvec3 v = glm::cross(plane.normal, u);
  std::ranges::sort(points, {}, [&](const glm::dvec3& point) {
    return std::atan2(glm::dot(point - middle, v), glm::dot(point - middle, u));
  });
  return points;
}

// From the scene to the display; nothing for what is behind the camera.
class Projector {
 public:
  Projector(const View& view, const glm::vec2& display)
      : clip_(glm::dmat4(projectionMatrix(view, display.x / display.y)) * glm::dmat4(viewMatrix(view))),
        display_(display) {}
  [[nodiscard]] const glm::vec2& display() const { return display_; }
  [[nodiscard]] std::optional<glm::vec2> at(const glm::dvec3& point) const {
    const glm::dvec4 clip = clip_ * glm::dvec4(point, 1.0);
    if (clip.w <= 1.0e-6) return {};
    return glm::vec2((glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(display_));
  }

 private:
  glm::dmat4 clip_;
  glm::vec2 display_;
};

// Where the plane's handle is: in the middle of its outline, or, beside the model, as near to it as can be; and a point
// ahead of it along its normal. Nothing where either is behind the camera.
struct Handle {
  glm::vec2 at;
  glm::vec2 ahead;
};
constexpr double kAhead = 0.05; // of the model's size

std::optional<Handle> handleOf(const CutPlane& plane, const std::vector<glm::dvec3>& outline, const Bounds& bounds,
                               const Projector& projector) {
  glm::dvec3 middle(0.0);
  for (const glm::dvec3& point : outline) middle += point / static_cast<double>(outline.size());
  if (outline.empty()) {
    middle = 0.5 * glm::dvec3(bounds.min + bounds.max);
    middle -= plane.normal * (glm::dot(plane.normal, middle) + plane.offset);
  }
  const auto at = projector.at(middle);
  const auto ahead = projector.at(middle + plane.normal * (kAhead * glm::length(glm::dvec3(bounds.max - bounds.min))));
  if (!at || !ahead) return {};
  return Handle{*at, *ahead};
}

// Moves the plane until the handle is at a place of the display, whatever frames have come since it was moved last: in
// steps, as what is far away moves less in the picture. Seen along its normal the plane comes nearer with a move
// downwards. False: it is there.
bool drag(glm::dvec4& cut, CutPlane plane, const Bounds& bounds, const glm::vec2& target, const Projector& projector) {
  constexpr int kMostSteps = 8;
  const double size = glm::length(glm::dvec3(bounds.max - bounds.min));
  const double height = static_cast<double>(projector.display().y);
  const double least = 0.1 * height / size;
  bool hasMoved = false;
  for (int i = 0; i < kMostSteps; ++i) {
    const auto handle = handleOf(plane, outlineOf(plane, bounds), bounds, projector);
    if (!handle) break;
    const glm::dvec2 moved(target - handle->at);
    const glm::dvec2 step = glm::dvec2(handle->ahead - handle->at) / (kAhead * size); // for a unit of length
    const bool isSeen = glm::length(step) > least;
    const double way = isSeen ? glm::dot(moved, step) / glm::dot(step, step) : moved.y * size / height;
    if (std::abs(way) * std::max(glm::length(step), least) < 0.5) break; // less than a pixel
    cut.w += way * glm::length(glm::dvec3(cut));
    plane.offset -= way;
    hasMoved = true;
    if (!isSeen) break; // the handle stays where it is
  }
  return hasMoved;
}

} // namespace

bool CutHandle::draw(ImDrawList& list, RenderArguments& arguments, const SceneFacts& scene, const View& view,
                     const glm::vec2& display, const glm::vec2& pressed) {
  place_.reset();
  if (arguments.clipPlanes.size() != 1) {
    isDragged_ = false;
    return false;
  }
  glm::dvec4& cut = arguments.clipPlanes[0]; // in the file's coordinates
  const double length = glm::length(glm::dvec3(cut));
  CutPlane plane{turnOf(arguments.up) * glm::dvec3(cut) / length,
                 -cut.w / length}; // kept: dot(cut.xyz, point) >= cut.w
  plane.offset += glm::dot(plane.normal, scene.origin);
  const Projector projector(view, display);
  const std::vector<glm::dvec3> outline = outlineOf(plane, scene.bounds);
  std::vector<ImVec2> drawn;
  for (const glm::dvec3& point : outline) {
    if (const auto place = projector.at(point)) drawn.emplace_back(place->x, place->y);
  }
  if (drawn.size() == outline.size() && !drawn.empty()) {
    list.AddConvexPolyFilled(drawn.data(), static_cast<int>(drawn.size()), kFill);
    list.AddPolyline(drawn.data(), static_cast<int>(drawn.size()), kLine, ImDrawFlags_Closed, 1.5F);
  }
  const auto handle = handleOf(plane, outline, scene.bounds, projector);
  if (!handle) return false;
  const glm::vec2 at = handle->at;
  place_ = at;
  const float scale = ImGui::GetFontSize() / 13.0F;
  list.AddLine(ImVec2(at.x, at.y), ImVec2(handle->ahead.x, handle->ahead.y), kLine, 3.0F * scale);
  list.AddCircleFilled(ImVec2(at.x, at.y), 7.0F * scale, kLine);
  list.AddCircle(ImVec2(at.x, at.y), 7.0F * scale, IM_COL32(255, 255, 255, 255), 0, 1.5F * scale);

  const ImGuiIO& io = ImGui::GetIO();
  const float reach = 10.0F * scale;
  const glm::vec2 mouse(io.MousePos.x, io.MousePos.y);
  const bool isNear = glm::length(mouse - at) < reach && !io.WantCaptureMouse;
  if (isNear || isDragged_) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  if (ImGui::IsMouseClicked(0) && glm::length(pressed - at) < reach && !io.WantCaptureMouse) {
    isDragged_ = true;
    grip_ = pressed - at;
  }
  if (!isDragged_) return false;
  isDragged_ = ImGui::IsMouseDown(0); // a move that is heard of together with the release came before it
  if (!ImGui::IsMousePosValid(&io.MousePos)) return false;
  return drag(cut, plane, scene.bounds, mouse - grip_, projector);
}

} // namespace vitrail::tool
