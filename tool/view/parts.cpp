#include "parts.h"

#include <algorithm>

#include <imgui.h>

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kMostSiblings = 500; // that a list shows

} // namespace

void Parts::set(const std::shared_ptr<const SceneFacts>& scene, const ObjectChoice& choice) {
  if (scene == scene_ && choice == choice_) return;
  const bool isOther = scene != scene_;
  scene_ = scene;
  choice_ = choice;
  if (!scene_) return;
  const ObjectTree& objects = scene_->objects;
  shown_ = shownObjects(objects, choice);
  opacities_ = opacities(objects, choice);
  if (!isOther) return;
  firstRoot_ = ObjectTree::none;
  firstChild_.assign(objects.size(), ObjectTree::none);
  nextSibling_.assign(objects.size(), ObjectTree::none);
  for (std::uint32_t i = objects.size(); i-- > 0;) {
    std::uint32_t& first = objects.parent(i) == ObjectTree::none ? firstRoot_ : firstChild_[objects.parent(i)];
    nextSibling_[i] = first;
    first = i;
  }
}

void Parts::show(ObjectChoice& choice, std::uint32_t object, bool shown) const {
  const std::string path = scene_->objects.path(object);
  std::erase(choice.hide, path);
  std::erase(choice.show, path);
  if (shownObjects(scene_->objects, choice)[object] == shown) return;
  (shown ? choice.show : choice.hide).push_back(path);
}

void Parts::fade(ObjectChoice& choice, std::uint32_t object, float opacity) const {
  const std::string path = scene_->objects.path(object);
  std::erase_if(choice.fade, [&](const ObjectChoice::Fade& fade) { return fade.name == path; });
  if (opacities(scene_->objects, choice)[object] != opacity) choice.fade.push_back({path, opacity});
}

bool Parts::drawObject(ObjectChoice& choice, std::uint32_t object) {
  bool changed = false;
  ImGui::PushID(static_cast<int>(object));
  bool shown = shown_[object];
  if (ImGui::Checkbox("##shown", &shown)) {
    show(choice, object, shown);
    changed = true;
  }
  ImGui::SameLine();
  if (ImGui::SmallButton("only")) {
    choice.isolate = {scene_->objects.path(object)};
    choice.hide.clear();
    choice.show.clear();
    changed = true;
  }
  ImGui::SameLine();
  float opacity = opacities_[object];
  ImGui::SetNextItemWidth(4.0F * ImGui::GetFontSize());
  if (ImGui::SliderFloat("##opacity", &opacity, 0.004F, 1.0F, "%.2f")) {
    fade(choice, object, std::clamp(opacity, 0.004F, 1.0F));
    changed = true;
  }
  ImGui::SameLine();
  const bool isLeaf = firstChild_[object] == ObjectTree::none;
  const std::string name(scene_->objects.name(object));
  if (ImGui::TreeNodeEx("##name", isLeaf ? ImGuiTreeNodeFlags_Leaf : 0, "%s", name.c_str())) {
    changed = drawAll(choice, firstChild_[object]) || changed;
    ImGui::TreePop();
  }
  ImGui::PopID();
  return changed;
}

bool Parts::drawAll(ObjectChoice& choice, std::uint32_t first) {
  bool changed = false;
  std::uint32_t count = 0;
  for (std::uint32_t i = first; i != ObjectTree::none && !changed; i = nextSibling_[i]) {
    if (count++ == kMostSiblings) {
      ImGui::TextDisabled("and more: name them by --hide and --isolate");
      break;
    }
    changed = drawObject(choice, i);
  }
  return changed;
}

bool Parts::draw(ObjectChoice& choice) {
  if (!scene_ || !ImGui::CollapsingHeader("Objects")) return false;
  bool changed = false;
  if (!choice.isAll() && ImGui::SmallButton("show all")) {
    choice = {};
    return true;
  }
  ImGui::BeginChild("objects", ImVec2(0.0F, 12.0F * ImGui::GetTextLineHeightWithSpacing()), true);
  changed = drawAll(choice, firstRoot_);
  ImGui::EndChild();
  return changed;
}

} // namespace vitrail::tool
