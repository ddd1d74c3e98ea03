#include "window.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace vitrail::tool {

namespace {

constexpr const char* kInstead = "vitrail render writes pictures without a window";

std::string reason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason given";
}

// What fits on the screen beside the window's frame and the desktop's bars.
PixelSize fitting(PixelSize wanted) {
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (monitor == nullptr) return wanted;
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
  if (width <= 0 || height <= 0) return wanted;
  return {std::min(wanted.width, static_cast<std::uint32_t>(width)),
          std::min(wanted.height, static_cast<std::uint32_t>(height))};
}

} // namespace

Window::Window(const std::string& title, PixelSize size) {
  if (glfwInit() == GLFW_FALSE) {
    throw WindowError(fmt::format("there is no display to open a window on ({}); {}", reason(), kInstead));
  }
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  const PixelSize fits = fitting(size);
  window_ =
      glfwCreateWindow(static_cast<int>(fits.width), static_cast<int>(fits.height), title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const std::string why = reason();
    glfwTerminate();
    throw WindowError(fmt::format("the window cannot be opened ({}); {}", why, kInstead));
  }
  // The size was meant in pixels; some systems have others.
  int width = 0;
  glfwGetFramebufferSize(window_, &width, nullptr);
  if (width > 0 && static_cast<std::uint32_t>(width) != fits.width) {
    const double ratio = static_cast<double>(fits.width) / width;
    glfwSetWindowSize(window_, static_cast<int>(std::lround(fits.width * ratio)),
                      static_cast<int>(std::lround(fits.height * ratio)));
  }
  glfwSetWindowUserPointer(window_, this);
  // Dear ImGui passes on to it what it takes, too.
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int /*code*/, int action, int mods) {
    if (action == GLFW_RELEASE) return;
    auto& self = *static_cast<Window*>(glfwGetWindowUserPointer(window));
    self.keys_.push_back({key, (mods & GLFW_MOD_SHIFT) != 0, (mods & GLFW_MOD_CONTROL) != 0, action == GLFW_REPEAT});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int /*mods*/) {
    if (button != GLFW_MOUSE_BUTTON_LEFT || action != GLFW_PRESS) return;
    double x = 0.0;
    double y = 0.0;
    glfwGetCursorPos(window, &x, &y);
    static_cast<Window*>(glfwGetWindowUserPointer(window))->pressed_ = {static_cast<float>(x), static_cast<float>(y)};
  });
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
    auto& self = *static_cast<Window*>(glfwGetWindowUserPointer(window));
    for (int i = 0; i < count; ++i) self.dropped_.emplace_back(paths[i]);
  });
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

bool Window::isClosing() const { return glfwWindowShouldClose(window_) != GLFW_FALSE; }
void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

PixelSize Window::size() const {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {static_cast<std::uint32_t>(std::max(width, 0)), static_cast<std::uint32_t>(std::max(height, 0))};
}

float Window::scale() const {
  float x = 1.0F;
  float y = 1.0F;
  glfwGetWindowContentScale(window_, &x, &y);
  return std::clamp(y, 1.0F, 4.0F);
}

void Window::copy(const std::string& text) { glfwSetClipboardString(window_, text.c_str()); }

void Window::wait(double seconds) {
  if (seconds < 0.0) {
    glfwWaitEvents();
  } else if (seconds > 0.0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
}

void Window::wake() { glfwPostEmptyEvent(); }

std::vector<KeyPress> Window::takeKeys() { return std::exchange(keys_, {}); }

std::vector<std::string> Window::takeDropped() { return std::exchange(dropped_, {}); }

std::vector<const char*> Window::instanceExtensions() const {
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  if (names == nullptr) {
    throw WindowError(
        fmt::format("Vulkan shows no pictures in windows here ({}): install libvulkan1 and "
                    "mesa-vulkan-drivers; {}",
                    reason(), kInstead));
  }
  return {names, names + count};
}

bool Window::presents(VkInstance instance, VkPhysicalDevice device, std::uint32_t queueFamily) {
  return glfwGetPhysicalDevicePresentationSupport(instance, device, queueFamily) != GLFW_FALSE;
}

VkSurfaceKHR Window::makeSurface(VkInstance instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  if (glfwCreateWindowSurface(instance, window_, nullptr, &surface) != VK_SUCCESS) {
    throw WindowError(fmt::format("Vulkan cannot draw in the window ({}); {}", reason(), kInstead));
  }
  return surface;
}

} // namespace vitrail::tool
