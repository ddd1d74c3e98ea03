#include "viewer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui_impl_glfw.h>

#include "../commands/device_options.h"
#include "../commands/method_choice.h"
#include "../commands/output_file.h"
#include "../commands/output_format.h"
#include "../commands/progress.h"
#include "../methods/methods.h"
#include "../scene/message.h"
#include "command_line.h"
#include "cut_handle.h"
#include "drawer.h"
#include "event_log.h"
#include "navigation.h"
#include "panel.h"
#include "presenter.h"

namespace vitrail::tool {

namespace {

using Clock = std::chrono::steady_clock;

// Dear ImGui, which has one context.
class Widgets {
 public:
  explicit Widgets(const Window& window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr; // nothing is written beside the model
    ImGui::StyleColorsDark();
    ImGui::GetStyle().ScaleAllSizes(window.scale());
    ImFontConfig font;
    font.SizePixels = std::round(13.0F * window.scale());
    io.Fonts->AddFontDefault(&font);
    ImGui_ImplGlfw_InitForVulkan(window.handle(), true);
  }
  ~Widgets() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  Widgets(const Widgets&) = delete;
  Widgets& operator=(const Widgets&) = delete;
};

// As `render` opens it, but for volumes, which are not known before the scene is.
Device openDevice(const RenderArguments& arguments, const Window& window) {
  const bool openGl = arguments.method.api == Api::OpenGl;
  Device device({arguments.device, arguments.validate, arguments.wish, !openGl, openGl, window.instanceExtensions(),
                 Window::presents});
  if (device.gl() != nullptr) device.gl()->leaveThread(); // for the drawer's
  return device;
}

// One line.
std::string wordsOf(const std::exception_ptr& caught) {
  try {
    std::rethrow_exception(caught);
  } catch (const std::bad_alloc&) {
    return "out of memory";
  } catch (const std::exception& error) {
    return printable(error.what());
  }
}

void rethrowIfLost(const std::exception_ptr& caught) {
  try {
    std::rethrow_exception(caught);
  } catch (const DeviceLost&) {
    throw;
  } catch (const std::exception&) { // told in another way
  }
}

std::string titleOf(const RenderArguments& arguments) {
  return fmt::format("{} - Vitrail", printable(nameOfScene(arguments)));
}

class Viewer {
 public:
  explicit Viewer(const ViewArguments& arguments)
      : log_(arguments.events),
        initial_(arguments.picture),
        now_(arguments.picture),
        window_(titleOf(arguments.picture), {arguments.picture.width, arguments.picture.height}),
        widgets_(window_) {
    open(now_);
    if (now_.wish == Wish::Fastest) chooseExactMethod();
    if (device_->gpu() == nullptr && device_->gl() == nullptr) now_.device = std::string(kProcessor);
    initial_ = now_;
    showing_ = now_;
  }

  void run() {
    while (!window_.isClosing()) {
      window_.wait(patience());
      try {
        step();
      } catch (const DeviceLost& lost) {
        reopen(lost.what());
      }
    }
    finish();
  }

 private:
  // Where nothing of a method was asked for: the faster one of a GPU.
  void chooseExactMethod() {
    const MethodOptions exact = device_->exactMethod();
    now_.method.name = exact.name;
    now_.method.api = exact.api;
    if (device_->gpu() == nullptr || exact.api != Api::Vulkan || now_.peel) return;
    const Progress progress(true);
    now_.method.name =
        methodFor(*device_->gpu(), kPicturesOfAWindow, [&] { progress.show("measuring the device, this once"); });
    isMethodChosen_ = now_.method.name != exact.name;
  }

  // Opens what draws and what shows.
  void open(const RenderArguments& arguments) {
    device_.emplace(openDevice(arguments, window_));
    Gpu* gpu = device_->gpu();
    presenter_ = std::make_unique<Presenter>(window_, gpu, arguments.validate);
    drawer_ = std::make_unique<Drawer>(*device_, gpu != nullptr && gpu->presents(), Window::wake);
  }

  // The device is lost: it is opened again, or, where that does not work or not for long, the processor draws.
  void reopen(const std::string& reason) {
    log_.happened("lost", reason);
    ImGui::EndFrame(); // of the step that was not finished
    const bool again = lastLoss_ && since(*lastLoss_) < kSecondsBetweenLosses;
    lastLoss_ = Clock::now();
    drawer_.reset();
    if (drawn_) drawn_->image.reset();
    presenter_.reset();
    if (device_->gl() != nullptr) device_->gl()->comeToThread();
    device_.reset();
    std::string now = "the device was lost, and is opened again";
    try {
      if (again) throw GpuError("the device was lost again");
      open(now_);
    } catch (const GpuError&) {
      presenter_.reset();
      now_.device = std::string(kProcessor);
      now_.wish = Wish::Processor;
      chooseMethod(now_, std::string(kCpuMethod));
      now_.method.api = Api::Vulkan; // of no consequence there
      initial_.device = now_.device;
      initial_.wish = now_.wish;
      initial_.method = now_.method;
      open(now_);
      now = "the device was lost: the processor draws now";
    }
    asked_.reset();
    isAsked_ = false;
    isReopened_ = drawn_.has_value();
    drawn_.reset(); // nothing to go back to: the window's texture is gone with the device
    say(now, true);
  }

  // How long nothing will change by itself, in seconds; negative: for ever.
  double patience() const {
    if (isMinimised(window_.size())) return -1.0;
    if (restless_ > 0) return 0.0;
    if (!isMoving() && wantsFull()) return std::max(kSettle - since(lastMove_), 0.0);
    return isSettling() ? kSettle : -1.0;
  }
  static double since(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }
  static bool isMinimised(PixelSize size) { return size.width == 0 || size.height == 0; }
  bool isMoving() const { return rotates_ || drags_ || cutHandle_.isDragged(); }
  bool isSettling() const { return since(lastMove_) < kSettle; }
  // Whether the picture that was asked for last is not the one for rest.
  bool wantsFull() const { return asked_ && !asked_->rests; }

  void step() {
    const PixelSize size = window_.size();
    if (isMinimised(size)) return;
    if (restless_ > 0) --restless_;
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    openDropped();
    takeNews();
    steer(size);
    pressKeys();
    drawPicture(size);
    drawPanels();
    askFor(size);
    tellRest();
    ImGui::Render();
    ImGuiIO& io = ImGui::GetIO();
    const bool busy = ImGui::IsAnyMouseDown() || io.WantTextInput;
    if (busy || io.MouseWheel != 0.0F || changed_) restless_ = kFramesOfAChange;
    changed_ = false;
    if (!presenter_->show(*ImGui::GetDrawData(), vsync_)) restless_ = std::max(restless_, 1);
  }

  static bool sameCamera(const RenderArguments& a, const RenderArguments& b) {
    const auto sameOrbit = [](const Orbit& one, const Orbit& other) {
      return one.azimuth == other.azimuth && one.elevation == other.elevation && one.zoom == other.zoom;
    };
    return a.camera == b.camera && a.eye == b.eye && a.lookAt == b.lookAt && a.fov == b.fov &&
           a.orbit.has_value() == b.orbit.has_value() && (!a.orbit || sameOrbit(*a.orbit, *b.orbit));
  }

  // What was dropped may be no model: then takeNews() goes back.
  void openDropped() {
    const std::vector<std::string> files = window_.takeDropped();
    if (files.empty()) return;
    now_.models = files;
    now_.scene.clear();
    now_.count.reset();
    now_.seed.reset();
    now_.load = {};
    now_.clipPlanes.clear();
    now_.objects = {};
    now_.camera.reset();
    now_.orbit.reset();
    now_.eye.reset();
    now_.lookAt.reset();
    now_.fov.reset();
    isNavigating_ = false;
    changed_ = true;
    say({}, false);
  }

  // A picture before an error: that is of what was asked for later.
  void takeNews() {
    takePicture();
    if (const std::exception_ptr caught = drawer_->takeError()) {
      isAsked_ = false;
      rethrowIfLost(caught);
      if (!drawn_) std::rethrow_exception(caught); // there is nothing to go back to
      const std::string error = wordsOf(caught);
      now_ = showing_;
      beside_ = drawn_->wanted.beside;
      asked_ = drawn_->wanted;
      asked_->coarse = 1;
      asked_->rests = true; // what did not work is not asked for again
      isNavigating_ = false;
      rotates_ = false;
      log_.happened("error", error);
      say(error, true);
    }
    if (std::optional<Picked> picked = drawer_->takePicked()) {
      pickedBefore_ = std::exchange(picked_, std::move(picked));
      log_.picked(*picked_);
      changed_ = true;
    }
  }

  void takePicture() {
    std::optional<Drawn> drawn = drawer_->take();
    if (!drawn) return;
    // A later one than asked_: it was asked for before an error of an earlier one was known.
    if (asked_ && drawn->wanted.number > asked_->number) asked_ = drawn->wanted;
    isAsked_ = asked_ && drawn->wanted.number < asked_->number;
    changed_ = true;
    if (drawn->image) {
      presenter_->setPicture(Presenter::Side::Picture, drawn->image);
    } else {
      presenter_->setPicture(Presenter::Side::Picture, drawn->picture);
    }
    if (!drawn->beside.rgba.empty()) presenter_->setPicture(Presenter::Side::Beside, drawn->beside);
    const bool isOther = (!drawn_ || drawer_->scene() != scene_) && !std::exchange(isReopened_, false);
    scene_ = drawer_->scene();
    showing_ = drawn->wanted.arguments;
    if (isOther) {
      window_.setTitle(titleOf(showing_));
      initial_ = showing_;
      // Nobody asked for the method: another draws this scene as it is.
      if (isMethodChosen_ && !scene_->drawsAlike && now_.method == showing_.method) {
        isMethodChosen_ = false;
        chooseMethod(now_, std::string(kListMethod));
        initial_.method = now_.method;
        changed_ = true;
      }
      log_.happened("opened", nameOfScene(showing_));
      times_.clear();
      picked_.reset();
      pickedBefore_.reset();
    }
    if (drawn->wanted.coarse == 1) fullMilliseconds_ = drawn->milliseconds;
    const bool isTimed = !drawn->report.passesMs.empty();
    times_.push_back(isTimed ? drawn->report.passesMs : PassTimes{{"all", drawn->milliseconds}});
    constexpr std::size_t kKept = 120;
    if (times_.size() > kKept) times_.pop_front();
    log_.shown(*drawn, renderCommand(showing_, "picture.png"));
    drawn_ = std::move(drawn);
  }

  // ---- The camera

  void beginNavigation() {
    if (isNavigating_ || !scene_) return;
    // Where the view that is wanted was not drawn yet, it is that of the box.
    const float aspect = static_cast<float>(now_.width) / static_cast<float>(std::max(now_.height, 1U));
    const bool isDrawn = drawn_ && sameCamera(drawn_->wanted.arguments, now_);
    navigation_.begin(scene_->bounds,
                      isDrawn ? drawn_->view : frameScene(scene_->bounds, now_.orbit.value_or(Orbit{}), aspect));
    isNavigating_ = true;
  }

  template <typename Move>
  void move(Move&& moved) {
    if (!scene_) return;
    beginNavigation();
    moved(navigation_);
    navigation_.put(now_, scene_->origin);
    lastMove_ = Clock::now();
    changed_ = true;
  }

  // Sees it all from there, in degrees.
  void frame(double azimuth, double elevation) {
    now_.camera.reset();
    now_.eye.reset();
    now_.lookAt.reset();
    now_.fov.reset();
    now_.orbit = Orbit{static_cast<float>(azimuth), static_cast<float>(elevation), 1.0F};
    isNavigating_ = false;
    changed_ = true;
  }

  void frameFromHere() {
    if (!scene_) return;
    beginNavigation();
    frame(navigation_.azimuth(), navigation_.elevation());
  }

  void reset() {
    now_ = initial_;
    rotates_ = false;
    isNavigating_ = false;
    changed_ = true;
  }

  void steer(PixelSize size) {
    const ImGuiIO& io = ImGui::GetIO();
    constexpr double kDegreesOfAHeight = 180.0;
    // A move that is heard of together with a press, or with a release, came before it.
    const auto isHeld = [](int button) { return ImGui::IsMouseDown(button) || ImGui::IsMouseReleased(button); };
    const bool begins = ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(1) || ImGui::IsMouseClicked(2);
    const double right = begins ? 0.0 : io.MouseDelta.x / static_cast<double>(size.height);
    const double up = begins ? 0.0 : -io.MouseDelta.y / static_cast<double>(size.height);
    if (!io.WantCaptureMouse && !dragsDivider_ && !cutHandle_.isDragged()) {
      pickWhereClicked(size);
      const bool pans = isHeld(1) || isHeld(2) || (isHeld(0) && io.KeyShift);
      const bool isDown = pans || isHeld(0);
      drags_ = isDown && (drags_ || right != 0.0 || up != 0.0); // pressing alone moves nothing
      if (drags_ && (right != 0.0 || up != 0.0)) {
        move([&](Navigation& navigation) {
          pans ? navigation.pan(right, up) : navigation.orbit(-right * kDegreesOfAHeight, -up * kDegreesOfAHeight);
        });
      }
      if (io.MouseWheel != 0.0F) {
        move([&](Navigation& navigation) { navigation.zoom(std::pow(1.1, io.MouseWheel)); });
      }
    } else {
      drags_ = false;
    }
    if (rotates_ && scene_ && mayAsk()) {
      const double seconds = std::min(since(lastTurn_), 0.5);
      move([&](Navigation& navigation) { navigation.orbit(kDegreesOfASecond * seconds, 0.0); });
      lastTurn_ = Clock::now();
    }
  }

  // A click that is no drag.
  void pickWhereClicked(PixelSize size) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!scene_ || !ImGui::IsMouseReleased(0) || io.MouseDragMaxDistanceSqr[0] > 9.0F) return;
    const float x = io.MousePos.x * io.DisplayFramebufferScale.x;
    const float y = io.MousePos.y * io.DisplayFramebufferScale.y;
    if (x < 0.0F || y < 0.0F || x >= static_cast<float>(size.width) || y >= static_cast<float>(size.height)) return;
    drawer_->askPick(now_, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
  }

  void pressKeys() {
    const std::vector<KeyPress> keys = window_.takeKeys();
    if (ImGui::GetIO().WantTextInput) return;
    for (const KeyPress& key : keys) {
      if (!key.repeats) press(key);
      pressOrHold(key);
    }
  }

  void press(const KeyPress& key) {
    const double back = key.control ? 180.0 : 0.0;
    switch (key.key) {
      case GLFW_KEY_1:
      case GLFW_KEY_KP_1:
        return frame(back, 0.0);
      case GLFW_KEY_3:
      case GLFW_KEY_KP_3:
        return frame(90.0 + back, 0.0);
      case GLFW_KEY_7:
      case GLFW_KEY_KP_7:
        return frame(0.0, key.control ? -90.0 : 90.0);
      case GLFW_KEY_F:
        return frameFromHere();
      case GLFW_KEY_R:
        return reset();
      case GLFW_KEY_SPACE:
        return toggleRotation();
      case GLFW_KEY_TAB:
        hasPanel_ = !hasPanel_;
        return;
      case GLFW_KEY_S:
        if (Sorting::isChoice(*device_)) sorting_.set(now_, !Sorting::isOn(now_));
        return;
      case GLFW_KEY_M:
        return nextMethod(key.shift ? -1 : 1);
      case GLFW_KEY_B:
        return nextBeside();
      case GLFW_KEY_P:
        return save();
      case GLFW_KEY_C:
        return copy();
      case GLFW_KEY_Q:
        if (key.control) window_.close();
        return;
      default:
        return;
    }
  }

  // Keys that go on while they are held.
  void pressOrHold(const KeyPress& key) {
    constexpr double kStep = 5.0; // degrees; a twentieth of the picture
    const auto arrow = [&](double right, double up) {
      move([&](Navigation& navigation) {
        key.shift ? navigation.pan(-0.01 * right, -0.01 * up) : navigation.orbit(right, up);
      });
    };
    switch (key.key) {
      case GLFW_KEY_LEFT:
        return arrow(-kStep, 0.0);
      case GLFW_KEY_RIGHT:
        return arrow(kStep, 0.0);
      case GLFW_KEY_UP:
        return arrow(0.0, kStep);
      case GLFW_KEY_DOWN:
        return arrow(0.0, -kStep);
      case GLFW_KEY_EQUAL:
      case GLFW_KEY_KP_ADD:
        return move([](Navigation& navigation) { navigation.zoom(1.1); });
      case GLFW_KEY_MINUS:
      case GLFW_KEY_KP_SUBTRACT:
        return move([](Navigation& navigation) { navigation.zoom(1.0 / 1.1); });
      case GLFW_KEY_LEFT_BRACKET:
        return changeLayers(-1);
      case GLFW_KEY_RIGHT_BRACKET:
        return changeLayers(1);
      default:
        return;
    }
  }

  void toggleRotation() {
    rotates_ = !rotates_;
    lastTurn_ = Clock::now();
  }

  void nextMethod(int step) {
    const std::vector<std::string> names = methodsOf(*device_);
    const auto at = std::ranges::find(names, now_.method.name) - names.begin();
    const auto count = static_cast<std::ptrdiff_t>(names.size());
    chooseMethod(now_, names[static_cast<std::size_t>((at + step + count) % count)]);
  }

  // The exact one, or what that is compared with.
  std::string methodBeside() const {
    const std::string exact = device_->exactMethod().name;
    return now_.method.name == exact && Sorting::isChoice(*device_) ? "unsorted" : exact;
  }

  void nextBeside() {
    using Kind = Beside::Kind;
    switch (beside_.kind) {
      case Kind::Nothing:
        beside_ = {Kind::Complexity, {}};
        break;
      case Kind::Complexity:
        beside_ = {Kind::Error, {}};
        break;
      case Kind::Error:
        beside_ = {Kind::Method, methodBeside()};
        break;
      case Kind::Method:
        beside_ = {Kind::Overflow, {}};
        break;
      case Kind::Overflow:
        beside_ = {Kind::Tiles, {}};
        break;
      case Kind::Tiles:
        beside_ = {};
    }
  }

  void changeLayers(int step) {
    if (!traitsTake(kTakesLayers) || !now_.method.sorted || now_.peel) return;
    now_.method.maxLayers =
        static_cast<std::uint32_t>(std::clamp(static_cast<int>(now_.method.maxLayers) + step, 0, 64));
  }
  bool traitsTake(MethodOption option) const { return traitsOf(now_.method.name).takes(option); }

  // ---- Pictures

  // Has it drawn what is to be seen, as coarse as moving smoothly takes.
  void askFor(PixelSize size) {
    now_.width = size.width;
    now_.height = size.height;
    Wanted wanted{now_, 1, beside_, !isMoving() && !isSettling(), asks_ + 1};
    if (!wanted.rests) wanted.coarse = coarseness();
    const bool isSame = asked_ && asked_->coarse == wanted.coarse && asked_->beside == beside_ &&
                        renderCommand(asked_->arguments, "-") == renderCommand(now_, "-");
    if (isSame && (asked_->rests || !wanted.rests)) return;
    if (isSame && isWhole()) { // it was drawn while something moved, and will do
      asked_->rests = true;
      return;
    }
    ++asks_;
    asked_ = wanted;
    isAsked_ = true;
    isResting_ = false;
    drawer_->ask(std::move(wanted));
  }

  // Whether the picture on the screen is what was asked for, in full, and the host has its pixels.
  bool isWhole() const {
    return drawn_ && !isAsked_ && drawn_->wanted.coarse == 1 && !drawn_->picture.rgba.empty() && drawn_->isFinal;
  }

  // Whether the camera may go on by itself: as many pictures are on their way as can be.
  bool mayAsk() const {
    const bool several = drawn_ && drawn_->image != nullptr;
    return !isAsked_ || (several && asked_->number < drawn_->wanted.number + InteractiveRenderer::kFramesInFlight);
  }

  // Nothing is drawn until something happens: once, for scripts.
  void tellRest() {
    if (isResting_ || isAsked_ || !isWhole() || isMoving() || isSettling()) return;
    isResting_ = true;
    log_.happened("rest", renderCommand(showing_, "picture.png"));
    if (const auto& place = cutHandle_.place())
      log_.happened("handle", fmt::format("{:.0f},{:.0f}", place->x, place->y));
  }

  std::uint32_t coarseness() const {
    constexpr double kSmooth = 40.0; // milliseconds a picture
    for (std::uint32_t coarse : {1U, 2U, 3U}) {
      if (fullMilliseconds_ <= kSmooth * coarse * coarse) return coarse;
    }
    return 4;
  }

  void drawPicture(PixelSize size) {
    if (!drawn_) return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 corner = ImGui::GetIO().DisplaySize;
    if (drawn_->picture.hasAlpha) drawChecks(list, corner);
    const bool fits = drawn_->width == size.width && drawn_->height == size.height;
    list.AddImage(Presenter::texture(Presenter::Side::Picture, !fits), ImVec2(0.0F, 0.0F), corner, ImVec2(0.0F, 0.0F),
                  partOfTexture());
    if (!drawn_->beside.rgba.empty()) drawBeside(list, corner, fits);
    if (hasPanel_ && scene_) {
      drawCut(list, corner);
    } else {
      cutHandle_.letGo();
    }
  }

  // The plane that cuts, which the mouse moves. The camera stays, which would frame what is left.
  void drawCut(ImDrawList& list, const ImVec2& corner) {
    const std::vector<glm::dvec4> before = now_.clipPlanes;
    if (!cutHandle_.draw(list, now_, *scene_, drawn_->view, {corner.x, corner.y},
                         {window_.pressed()[0], window_.pressed()[1]}))
      return;
    const std::vector<glm::dvec4> moved = std::exchange(now_.clipPlanes, before);
    move([](Navigation&) {});
    now_.clipPlanes = moved;
  }

  // Where the picture ends in its texture. What is beyond a part is not blended in at its edge.
  ImVec2 partOfTexture() const {
    if (!drawn_->image) return {1.0F, 1.0F};
    const VkExtent2D whole = drawn_->image->info().extent;
    const auto end = [](std::uint32_t part, std::uint32_t all) {
      return part == all ? 1.0F : (static_cast<float>(part) - 0.5F) / static_cast<float>(all);
    };
    return {end(drawn_->width, whole.width), end(drawn_->height, whole.height)};
  }

  // The other picture to the right of a line that is dragged, and what its colours stand for.
  void drawBeside(ImDrawList& list, const ImVec2& corner, bool fits) {
    const ImGuiIO& io = ImGui::GetIO();
    const float line = std::round(divider_ * corner.x);
    list.AddImage(Presenter::texture(Presenter::Side::Beside, !fits), ImVec2(line, 0.0F), corner,
                  ImVec2(line / corner.x, 0.0F), ImVec2(1.0F, 1.0F));
    list.AddLine(ImVec2(line, 0.0F), ImVec2(line, corner.y), IM_COL32(255, 160, 0, 255), 2.0F);
    const bool isNear = std::abs(io.MousePos.x - line) < 6.0F && !io.WantCaptureMouse;
    if (isNear || dragsDivider_) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (isNear && ImGui::IsMouseClicked(0)) dragsDivider_ = true;
    if (!ImGui::IsMouseDown(0)) dragsDivider_ = false;
    if (dragsDivider_) divider_ = std::clamp(io.MousePos.x / corner.x, 0.0F, 1.0F);
    drawLegend(list, corner, drawn_->wanted.beside);
  }

  void drawLegend(ImDrawList& list, const ImVec2& corner, const Beside& beside) const {
    std::string text = beside.method;
    if (beside.kind == Beside::Kind::Complexity) text = fmt::format("surfaces of a pixel: 0 to {}", drawn_->largest);
    if (beside.kind == Beside::Kind::Error) text = fmt::format("off the exact picture: 0 to {}/255", drawn_->largest);
    const bool isOfCounts = beside.kind == Beside::Kind::Overflow || beside.kind == Beside::Kind::Tiles;
    if (isOfCounts && !drawn_->report.counted) {
      text = fmt::format("{} does not count surfaces", drawn_->report.method);
    } else if (beside.kind == Beside::Kind::Overflow) {
      text = drawn_->report.fragmentsMissing > 0
                 ? fmt::format("surfaces of pixels without room for all: 0 to {}", drawn_->largest)
                 : std::string("there was room for all surfaces");
    } else if (beside.kind == Beside::Kind::Tiles) {
      text =
          fmt::format("parts: {}; surfaces of a pixel in the mean: 0 to {:.1f}", drawn_->report.tiles, drawn_->largest);
    }
    const float height = ImGui::GetFontSize();
    const ImVec2 at(corner.x - ImGui::CalcTextSize(text.c_str()).x - 20.0F, 14.0F);
    const bool hasColors = beside.kind != Beside::Kind::Method;
    list.AddRectFilled(ImVec2(at.x - 8.0F, at.y - 6.0F),
                       ImVec2(corner.x - 12.0F, at.y + (hasColors ? 2.4F : 1.3F) * height), IM_COL32(0, 0, 0, 200));
    list.AddText(at, IM_COL32(255, 255, 255, 255), text.c_str());
    if (!hasColors) return;
    const ColorMap& map = colorsOf(beside);
    const auto color = [&map](std::size_t i) { return IM_COL32(map[i][0], map[i][1], map[i][2], 255); };
    const float step = (corner.x - 20.0F - at.x) / static_cast<float>(map.size() - 1);
    for (std::size_t i = 0; i + 1 < map.size(); ++i) {
      const float left = at.x + step * static_cast<float>(i);
      list.AddRectFilledMultiColor(ImVec2(left, at.y + 1.3F * height), ImVec2(left + step, at.y + 2.1F * height),
                                   color(i), color(i + 1), color(i + 1), color(i));
    }
  }

  // What shows through transparent pictures.
  static void drawChecks(ImDrawList& list, const ImVec2& corner) {
    constexpr float kSide = 16.0F;
    list.AddRectFilled(ImVec2(0.0F, 0.0F), corner, IM_COL32(160, 160, 160, 255));
    for (int y = 0; static_cast<float>(y) * kSide < corner.y; ++y) {
      for (int x = y % 2; static_cast<float>(x) * kSide < corner.x; x += 2) {
        const ImVec2 from(static_cast<float>(x) * kSide, static_cast<float>(y) * kSide);
        list.AddRectFilled(from, ImVec2(from.x + kSide, from.y + kSide), IM_COL32(110, 110, 110, 255));
      }
    }
  }

  void drawPanels() {
    if (hasPanel_) {
      const bool didRotate = rotates_;
      parts_.set(scene_, now_.objects);
      const ObjectChoice before = now_.objects;
      const PanelActions actions = drawPanel({now_, sorting_, rotates_, vsync_, *device_, scene_.get(),
                                              picked_ ? &*picked_ : nullptr, pickedBefore_ ? &*pickedBefore_ : nullptr,
                                              parts_, beside_, drawn_ ? &*drawn_ : nullptr, drawer_->doing(), times_});
      if (rotates_ && !didRotate) lastTurn_ = Clock::now();
      if (actions.frame) frameFromHere();
      if (actions.reset) reset();
      if (actions.objects) {
        const ObjectChoice chosen = std::exchange(now_.objects, before);
        move([](Navigation&) {}); // pins the camera, which would frame what is left
        now_.objects = chosen;
      }
      if (actions.save) save();
      if (actions.copy) copy();
    }
    drawNotice(notice_, isError_);
  }

  void say(std::string notice, bool isError) {
    notice_ = std::move(notice);
    isError_ = isError;
    changed_ = true;
  }

  // Writes the picture on the screen, without the widgets.
  void save() {
    if (!drawn_) return;
    if (!isWhole()) return say("the picture is not finished: press P again", false);
    try {
      const std::string name = freeName();
      OutputFile file{std::filesystem::path(name)};
      RenderResult result;
      result.picture = drawn_->picture;
      const std::vector<std::byte> bytes = encodePicture(result, OutputFormat{});
      file.write(bytes);
      file.commit();
      log_.happened("saved", name);
      say(fmt::format("saved {}", std::filesystem::absolute(name).string()), false);
    } catch (const std::exception& error) {
      log_.happened("error", error.what());
      say(error.what(), true);
    }
  }

  // NAME_1.png, or the next number that is free.
  std::string freeName() const {
    std::string stem = std::filesystem::path(nameOfScene(showing_)).stem().string();
    if (showing_.models.size() > 1) stem = "picture";
    for (int i = 1;; ++i) {
      std::string name = fmt::format("{}_{}.png", stem, i);
      if (!std::filesystem::exists(name)) return name;
    }
  }

  void copy() {
    if (!drawn_) return;
    const std::string command = renderCommand(showing_, "picture.png");
    window_.copy(command);
    fmt::print("{}\n", command); // for those whose clipboard ends with the window
    std::fflush(stdout);
    log_.happened("copied", command);
    say(fmt::format("copied: {}", command), false);
  }

  void finish() {
    const std::vector<std::string> errors = presenter_->finish();
    const bool isBusy = !drawer_->doing().empty();
    if (errors.empty() && isBusy && !now_.validate)
      std::_Exit(0); // nobody waits for a file that is not wanted any more
    drawer_.reset();
    drawn_.reset(); // its image
    if (device_->gl() != nullptr) device_->gl()->comeToThread();
    if (!errors.empty()) throw std::runtime_error(errors.front());
    closeValidated(*device_);
  }

  static constexpr double kSecondsBetweenLosses = 30.0; // of the device: below that it is given up
  static constexpr double kSettle = 0.15;               // seconds behind a move until the picture is fine again
  static constexpr int kFramesOfAChange = 3;            // which ImGui takes to come to rest
  static constexpr double kDegreesOfASecond = 20.0;     // of the automatic rotation

  EventLog log_;
  RenderArguments initial_; // of the scene
  RenderArguments now_;     // what is wanted
  RenderArguments showing_; // what the picture is of
  Window window_;
  Widgets widgets_;
  std::optional<Device> device_; // always there but while it is opened
  std::unique_ptr<Presenter> presenter_;
  std::unique_ptr<Drawer> drawer_;
  Sorting sorting_;
  Navigation navigation_;
  bool isNavigating_ = false; // navigation_ is where now_ is
  std::shared_ptr<const SceneFacts> scene_;
  Parts parts_;
  std::optional<Picked> picked_;
  std::optional<Picked> pickedBefore_;
  Beside beside_;
  float divider_ = 0.5F; // part of the width
  bool dragsDivider_ = false;
  CutHandle cutHandle_;
  std::optional<Drawn> drawn_;
  std::optional<Wanted> asked_;
  bool isAsked_ = false;        // and not drawn yet
  bool isMethodChosen_ = false; // nobody named the method that draws, and it is not that of lists
  bool isReopened_ = false;     // the next picture is of what was shown before the device was lost
  std::uint64_t asks_ = 0;
  bool isResting_ = false;
  std::deque<PassTimes> times_;
  double fullMilliseconds_ = 0.0;
  bool rotates_ = false;
  bool drags_ = false;
  bool vsync_ = true;
  bool hasPanel_ = true;
  bool changed_ = true;
  bool isError_ = false;
  int restless_ = kFramesOfAChange; // frames to come in any case
  std::string notice_;
  std::optional<Clock::time_point> lastLoss_;
  Clock::time_point lastMove_;
  Clock::time_point lastTurn_;
};

} // namespace

void runViewer(const ViewArguments& arguments) { Viewer(arguments).run(); }

} // namespace vitrail::tool
