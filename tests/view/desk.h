// An X11 display with one window on it, and somebody who uses mouse and keyboard.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct _XDisplay;

namespace vitrail::tests {

struct Pixels {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgb; // rows top to bottom
  bool operator==(const Pixels&) const = default;
};

class Desk {
 public:
  // The display of $DISPLAY. Throws std::runtime_error.
  Desk();
  ~Desk();
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;

  // Waits for a window of the program and gives it the focus. Throws std::runtime_error where none comes in ten
  // seconds.
  void find();
  [[nodiscard]] bool hasWindow();

  // Presses a key by its name for X ("space", "Left", "a"), with those that are held meanwhile.
  void key(const std::string& name, const std::vector<std::string>& held = {});
  void move(int x, int y); // to a place of the window
  void press(unsigned button, bool down);
  void drag(unsigned button, int fromX, int fromY, int toX, int toY);
  void wheel(int steps); // away from the user
  // Drops files as a file manager does (XDND 5), in the middle of the window. Throws std::runtime_error where the
  // window does not take them.
  void drop(const std::vector<std::string>& files);
  void resize(unsigned width, unsigned height);
  void minimise(bool on);
  void close(); // as by the button of its frame

  // What is on the screen of the window.
  Pixels look();

 private:
  void flush();

  _XDisplay* display_ = nullptr;
  unsigned long window_ = 0;
};

} // namespace vitrail::tests
