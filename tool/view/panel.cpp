#include "panel.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "../image/encode.h"
#include "../methods/methods.h"
#include "../scene/turn.h"

namespace vitrail::tool {

namespace {

constexpr float kWidth = 300.0F; // at the size of an ordinary screen

template <typename Value>
bool choose(const char* label, Value& value, std::initializer_list<std::pair<const char*, Value>> choices) {
  bool changed = false;
  const char* now = "";
  for (const auto& [name, choice] : choices) {
    if (choice == value) now = name;
  }
  if (!ImGui::BeginCombo(label, now)) return false;
  for (const auto& [name, choice] : choices) {
    if (ImGui::Selectable(name, choice == value)) {
      changed = choice != value;
      value = choice;
    }
  }
  ImGui::EndCombo();
  return changed;
}

void showMethods(const PanelState& state) {
  RenderArguments& arguments = state.arguments;
  if (ImGui::BeginCombo("method", arguments.method.name.c_str(), ImGuiComboFlags_HeightLarge)) {
    for (const std::string& name : methodsOf(state.device)) {
      if (ImGui::Selectable(name.c_str(), name == arguments.method.name)) chooseMethod(arguments, name);
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(traitsOf(name).help).c_str());
    }
    for (const MissingMethod& missing : missingMethodsOf(state.device)) {
      ImGui::Selectable(missing.name.c_str(), false, ImGuiSelectableFlags_Disabled);
      if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", missing.reason.c_str());
    }
    ImGui::EndCombo();
  }
  if (Sorting::isChoice(state.device)) {
    bool sorted = Sorting::isOn(arguments);
    if (ImGui::Checkbox("sorting", &sorted)) state.sorting.set(arguments, sorted);
  }
  MethodOptions& method = arguments.method;
  const MethodTraits& traits = traitsOf(method.name);
  if (traits.takes(kTakesLayers) && method.sorted && arguments.peel.value_or(0) == 0) {
    auto layers = static_cast<int>(method.maxLayers);
    if (ImGui::SliderInt("sorted layers", &layers, 0, 64, layers == 0 ? "all" : "%d")) {
      method.maxLayers = static_cast<std::uint32_t>(std::max(layers, 0));
    }
  }
  if (traits.takes(kTakesSamples)) {
    choose<std::uint32_t>("samples", method.samples, {{"1", 1}, {"2", 2}, {"4", 4}, {"8", 8}});
  }
  if (traits.takes(kTakesNodes)) {
    choose<VitrailNodeFormat>(
        "nodes", method.nodes,
        {{"hdr", VITRAIL_NODE_HDR}, {"standard", VITRAIL_NODE_STANDARD}, {"compact", VITRAIL_NODE_COMPACT}});
  }
  if (traits.takes(kTakesResolve)) {
    choose<VitrailResolve>("resolve", method.resolve,
                           {{"the device's", VITRAIL_RESOLVE_DEFAULT},
                            {"compute", VITRAIL_RESOLVE_COMPUTE},
                            {"fragment", VITRAIL_RESOLVE_FRAGMENT}});
  }
  if (traits.takes(kTakesMemoryBudget)) {
    auto mebibytes = static_cast<int>(arguments.memoryBudget.value_or(0));
    if (ImGui::SliderInt("memory", &mebibytes, 0, 4096, mebibytes == 0 ? "all" : "%d MiB",
                         ImGuiSliderFlags_Logarithmic)) {
      arguments.memoryBudget.reset();
      if (mebibytes > 0) arguments.memoryBudget = static_cast<std::uint32_t>(mebibytes);
    }
  }
}

void showBackground(RenderArguments& arguments, const SceneFacts* scene) {
  Background background =
      arguments.background.value_or(scene != nullptr ? scene->background.value_or(Background{}) : Background{});
  bool changed = choose<Background::Kind>("background", background.kind,
                                          {{"colour", Background::Kind::Color},
                                           {"sky", Background::Kind::Sky},
                                           {"transparent", Background::Kind::Transparent}});
  if (background.kind == Background::Kind::Color) {
    // Codes, so that the command line says the same colour.
    int gray =
        static_cast<int>(std::lround(255.0F * (background.srgb.r + background.srgb.g + background.srgb.b) / 3.0F));
    if (ImGui::SliderInt("grey", &gray, 0, 255)) {
      background.srgb = glm::vec3(static_cast<float>(std::clamp(gray, 0, 255)) / 255.0F);
      changed = true;
    }
  }
  if (changed) arguments.background = background;
}

void showLook(const PanelState& state, const SceneFacts* scene, PanelActions& actions) {
  RenderArguments& arguments = state.arguments;
  float opacity = arguments.opacity.value_or(1.0F);
  bool isXray = arguments.opacity.has_value();
  if (ImGui::Checkbox("X-ray", &isXray)) {
    arguments.opacity.reset();
    if (isXray) arguments.opacity = opacity < 1.0F ? opacity : 0.25F;
  }
  if (isXray) {
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-ImGui::CalcTextSize("opacity").x - 10.0F);
    if (ImGui::SliderFloat("opacity", &opacity, 0.004F, 1.0F, "%.3f")) {
      arguments.opacity = std::clamp(opacity, 0.004F, 1.0F);
    }
  }
  showBackground(arguments, scene);
  ImGui::Checkbox("automatic rotation", &state.rotates);
  ImGui::Checkbox("vertical synchronisation", &state.vsync);
  actions.frame = ImGui::Button("Frame (F)");
  ImGui::SameLine();
  actions.reset = ImGui::Button("Reset (R)");
}

// A cut at right angles to an axis of the file: what is beyond the place is left out.
void showCut(RenderArguments& arguments, const SceneFacts& scene) {
  std::vector<glm::dvec4>& planes = arguments.clipPlanes;
  if (planes.size() > 1) return; // of the command line
  int axis = 0;
  for (int i = 0; i < 3 && !planes.empty(); ++i) {
    if (planes[0][i] != 0.0) axis = i + 1;
  }
  int chosen = axis;
  if (choose<int>("cut", chosen, {{"none", 0}, {"x", 1}, {"y", 2}, {"z", 3}}) && chosen == 0) planes.clear();
  if (chosen == 0) return;
  // The box in the file's axes, which only swap coordinates.
  const glm::dmat3 toFile = glm::transpose(turnOf(arguments.up));
  const glm::dvec3 a = toFile * (glm::dvec3(scene.bounds.min) + scene.origin);
  const glm::dvec3 b = toFile * (glm::dvec3(scene.bounds.max) + scene.origin);
  const double low = std::min(a[chosen - 1], b[chosen - 1]);
  const double high = std::max(a[chosen - 1], b[chosen - 1]);
  if (!(high > low)) return;
  double place = chosen == axis ? -planes[0].w : high;
  auto share = static_cast<float>((place - low) / (high - low));
  const bool moved = ImGui::SliderFloat("##cut", &share, 0.0F, 1.0F, "");
  ImGui::SameLine();
  ImGui::Text("%.4g", place);
  if (!moved && chosen == axis) return;
  if (moved) place = low + static_cast<double>(std::clamp(share, 0.0F, 1.0F)) * (high - low);
  glm::dvec4 plane(0.0);
  plane[chosen - 1] = -1.0;
  plane.w = -place;
  planes.assign(1, plane);
}

void showBeside(const PanelState& state) {
  Beside& beside = state.beside;
  using Kind = Beside::Kind;
  std::string now = "nothing";
  if (beside.kind == Kind::Method) now = beside.method;
  if (beside.kind == Kind::Complexity) now = "depth complexity";
  if (beside.kind == Kind::Error) now = "error";
  if (beside.kind == Kind::Overflow) now = "overflow";
  if (beside.kind == Kind::Tiles) now = "tiles";
  if (!ImGui::BeginCombo("beside it", now.c_str(), ImGuiComboFlags_HeightLarge)) return;
  if (ImGui::Selectable("nothing")) beside = {};
  if (ImGui::Selectable("depth complexity")) beside = {Kind::Complexity, {}};
  if (ImGui::Selectable("error")) beside = {Kind::Error, {}};
  if (ImGui::Selectable("overflow")) beside = {Kind::Overflow, {}};
  if (ImGui::Selectable("tiles")) beside = {Kind::Tiles, {}};
  for (const std::string& name : methodsOf(state.device)) {
    if (ImGui::Selectable(name.c_str())) beside = {Kind::Method, name};
  }
  ImGui::EndCombo();
}

void showInside(const PanelState& state, PanelActions& actions) {
  RenderArguments& arguments = state.arguments;
  auto peel = static_cast<int>(arguments.peel.value_or(0));
  if (ImGui::SliderInt("peel", &peel, 0, 32, peel == 0 ? "nothing" : "%d nearest")) {
    choosePeel(arguments, static_cast<std::uint32_t>(std::clamp(peel, 0, 1000)));
  }
  if (state.scene != nullptr) showCut(arguments, *state.scene);
  actions.objects = state.parts.draw(arguments.objects);
}

void showPicked(const PanelState& state) {
  if (state.picked == nullptr) return;
  const Picked& picked = *state.picked;
  const SceneFacts& scene = *picked.scene;
  if (!ImGui::CollapsingHeader("Picked", ImGuiTreeNodeFlags_DefaultOpen)) return;
  ImGui::Text("pixel %u,%u: %zu layers, %.2f ms", picked.x, picked.y, picked.layers.size(), picked.milliseconds);
  const float height = static_cast<float>(std::clamp<std::size_t>(picked.layers.size(), 1, 10));
  ImGui::BeginChild("layers", ImVec2(0.0F, (height + 1.0F) * ImGui::GetTextLineHeightWithSpacing()), true);
  for (std::size_t i = 0; i < picked.layers.size(); ++i) {
    const PickedLayer& layer = picked.layers[i];
    const float linear[4] = {layer.color.r, layer.color.g, layer.color.b, 1.0F};
    std::uint8_t codes[4] = {};
    encodePixels(linear, 1, codes);
    ImGui::PushID(static_cast<int>(i));
    ImGui::ColorButton("##color", ImColor(codes[0], codes[1], codes[2]), ImGuiColorEditFlags_NoTooltip,
                       ImVec2(ImGui::GetFontSize(), ImGui::GetFontSize()));
    ImGui::SameLine();
    const std::string name(scene.objects.name(layer.object));
    // Those behind the file's are of faded objects.
    const std::string material = layer.material < scene.materials.size() ? scene.materials[layer.material] : "faded";
    ImGui::Text("%.5g  %s  %.0f%%", layer.distance, name.c_str(), 100.0 * static_cast<double>(layer.alpha));
    if (ImGui::IsItemHovered()) {
      ImGui::SetTooltip("%s\nmaterial %s\n%s", scene.objects.path(layer.object).c_str(), material.c_str(),
                        layer.blend.c_str());
    }
    ImGui::PopID();
  }
  ImGui::EndChild();
  if (state.pickedBefore != nullptr && !picked.layers.empty() && !state.pickedBefore->layers.empty()) {
    ImGui::Text("%.6g from what was picked before",
                glm::length(picked.layers[0].point - state.pickedBefore->layers[0].point));
  }
}

// A line for the whole picture and one for each pass, over the last pictures, all on one scale.
void showTimes(const PanelState& state, const Drawn& drawn) {
  if (state.times.empty()) return;
  const auto timeOf = [](const PassTimes& passes, const std::string& pass) {
    double sum = 0.0;
    for (const auto& [name, milliseconds] : passes) sum += pass.empty() || name == pass ? milliseconds : 0.0;
    return static_cast<float>(sum);
  };
  std::vector<float> values(state.times.size());
  const auto plot = [&](const std::string& pass, const std::string& text, float height, float most) {
    std::ranges::transform(state.times, values.begin(), [&](const PassTimes& passes) { return timeOf(passes, pass); });
    if (most <= 0.0F) most = 1.1F * std::max(*std::ranges::max_element(values), 1.0e-6F);
    ImGui::PlotLines(("##" + text).c_str(), values.data(), static_cast<int>(values.size()), 0, text.c_str(), 0.0F, most,
                     ImVec2(ImGui::GetContentRegionAvail().x, height));
    return most;
  };
  const float most = plot({}, fmt::format("{:.3f} ms a picture", drawn.milliseconds), 50.0F, 0.0F);
  for (const auto& [name, milliseconds] : drawn.report.passesMs) {
    plot(name, fmt::format("{}: {:.3f} ms", name, milliseconds), 1.6F * ImGui::GetFontSize(), most);
  }
}

void showReport(const PanelState& state) {
  if (state.drawn == nullptr) return;
  const Drawn& drawn = *state.drawn;
  const FrameReport& report = drawn.report;
  if (report.peeled > 0) {
    ImGui::TextColored(ImVec4(0.9F, 0.9F, 0.4F, 1.0F), "without the %u nearest surfaces:", report.peeled);
  }
  if (isExact(report)) {
    ImGui::TextColored(ImVec4(0.4F, 0.9F, 0.4F, 1.0F), "exact: within 1/255");
  } else if (report.complete) {
    ImGui::TextColored(ImVec4(0.9F, 0.9F, 0.4F, 1.0F), "complete: within %.3g/255", report.errorBound);
  } else {
    ImGui::TextColored(ImVec4(1.0F, 0.5F, 0.4F, 1.0F), "not exact");
  }
  if (drawn.wanted.coarse > 1) {
    ImGui::SameLine();
    ImGui::TextDisabled("(coarse while moving)");
  }
  // Names of processors are long: the panel is to leave room for the picture.
  ImGui::PushTextWrapPos(kWidth * ImGui::GetFontSize() / 13.0F);
  ImGui::Text("%ux%u on %s", report.width, report.height, report.device.c_str());
  ImGui::PopTextWrapPos();
  if (report.counted) {
    ImGui::Text("%llu fragments, at most %u in a pixel", static_cast<unsigned long long>(report.fragmentsRequested),
                report.layersMax);
    if (report.fragmentsMissing > 0) {
      ImGui::Text("%llu of them without room", static_cast<unsigned long long>(report.fragmentsMissing));
    }
    if (report.tiles > 1) ImGui::Text("drawn in %u tiles", report.tiles);
    if (report.nodeCapacity > 0) {
      ImGui::Text("%.0f%% of the pool used",
                  100.0 * static_cast<double>(report.fragmentsStored) / static_cast<double>(report.nodeCapacity));
    }
    if (report.totalBytes > 0)
      ImGui::Text("%.1f MiB for fragments", static_cast<double>(report.totalBytes) / 1048576.0);
  }
  showTimes(state, drawn);
  for (const std::string& warning : drawn.warnings) {
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextColored(ImVec4(1.0F, 0.8F, 0.4F, 1.0F), "%s", warning.c_str());
    ImGui::PopTextWrapPos();
  }
}

} // namespace

PanelActions drawPanel(const PanelState& state) {
  PanelActions actions;
  const float scale = ImGui::GetFontSize() / 13.0F;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(10.0F, 10.0F), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSizeConstraints(ImVec2(kWidth * scale, 60.0F),
                                      ImVec2(kWidth * scale * 2.0F, std::max(display.y - 20.0F, 80.0F)));
  if (!ImGui::Begin("Vitrail", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
    ImGui::End();
    return actions;
  }
  ImGui::PushItemWidth(kWidth * scale * 0.55F);
  showMethods(state);
  showBeside(state);
  ImGui::Separator();
  showLook(state, state.scene, actions);
  ImGui::Separator();
  showInside(state, actions);
  showPicked(state);
  ImGui::Separator();
  showReport(state);
  if (!state.doing.empty()) ImGui::TextDisabled("%s ...", state.doing.c_str());
  ImGui::Separator();
  actions.save = ImGui::Button("Save picture (P)");
  ImGui::SameLine();
  actions.copy = ImGui::Button("Copy command (C)");
  ImGui::TextDisabled("click: pick  drag: orbit  right: pan  wheel: zoom\n1 3 7: axes  space: rotate  tab: this panel");
  ImGui::PopItemWidth();
  ImGui::End();
  return actions;
}

void drawNotice(std::string& notice, bool isError) {
  if (notice.empty()) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(0.5F * display.x, display.y - 12.0F), ImGuiCond_Always, ImVec2(0.5F, 1.0F));
  ImGui::SetNextWindowSizeConstraints(ImVec2(0.0F, 0.0F), ImVec2(0.9F * display.x, 0.5F * display.y));
  if (ImGui::Begin("##notice", nullptr,
                   ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                       ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing)) {
    ImGui::PushTextWrapPos(0.85F * display.x);
    ImGui::TextColored(isError ? ImVec4(1.0F, 0.5F, 0.4F, 1.0F) : ImVec4(0.8F, 0.9F, 1.0F, 1.0F), "%s", notice.c_str());
    ImGui::PopTextWrapPos();
    if (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(0)) notice.clear();
  }
  ImGui::End();
}

} // namespace vitrail::tool
