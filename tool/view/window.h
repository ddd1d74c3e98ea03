// The window: GLFW, and what the user does in it.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <volk.h>

struct GLFWwindow;

namespace vitrail::tool {

// Why there can be no window, in one line.
struct WindowError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct PixelSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool operator==(const PixelSize&) const = default;
};

// A key that went down, or repeats.
struct KeyPress {
  int key = 0; // of GLFW
  bool shift = false;
  bool control = false;
  bool repeats = false;
};

class Window {
 public:
  // Opens a window whose inside is so many pixels, or as many as the screen has room for. Throws WindowError where
  // there is no display. One at a time, on the main thread.
  Window(const std::string& title, PixelSize size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  [[nodiscard]] GLFWwindow* handle() const { return window_; }
  [[nodiscard]] bool isClosing() const;
  void close();
  void setTitle(const std::string& title);
  // Pixels of the inside; 0 in a direction while the window is minimised.
  [[nodiscard]] PixelSize size() const;
  // How many pixels what is one pixel on an ordinary screen has here.
  [[nodiscard]] float scale() const;
  void copy(const std::string& text); // to the clipboard

  // Sleeps until something happens: at most so many seconds, or for as long as that takes where it is negative.
  void wait(double seconds);
  // Wakes wait(). From any thread.
  static void wake();

  // The keys since the last call: none is missed, however short it was down.
  std::vector<KeyPress> takeKeys();
  // Where the left button went down last, as ImGui counts: a frame that comes late finds the mouse elsewhere.
  [[nodiscard]] std::array<float, 2> pressed() const { return pressed_; }
  // The files that were dropped since the last call.
  std::vector<std::string> takeDropped();

  // For a Vulkan device that shows pictures here (GpuOptions).
  [[nodiscard]] std::vector<const char*> instanceExtensions() const;
  static bool presents(VkInstance instance, VkPhysicalDevice device, std::uint32_t queueFamily);
  // The caller destroys it before the window. Throws WindowError.
  [[nodiscard]] VkSurfaceKHR makeSurface(VkInstance instance) const;

 private:
  GLFWwindow* window_ = nullptr;
  std::vector<std::string> dropped_;
  std::vector<KeyPress> keys_;
  std::array<float, 2> pressed_{};
};

} // namespace vitrail::tool
