#include "desk.h"

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <thread>

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>

namespace vitrail::tests {

namespace {

using namespace std::chrono_literals;

// The window of the program: the one with a name, below `from`.
::Window named(Display* display, ::Window from) {
  char* name = nullptr;
  if (XFetchName(display, from, &name) != 0 && name != nullptr) {
    const bool isIt = std::strstr(name, "Vitrail") != nullptr;
    XFree(name);
    if (isIt) return from;
  }
  ::Window root = 0;
  ::Window parent = 0;
  ::Window* children = nullptr;
  unsigned count = 0;
  if (XQueryTree(display, from, &root, &parent, &children, &count) == 0) return 0;
  ::Window found = 0;
  for (unsigned i = 0; i < count && found == 0; ++i) found = named(display, children[i]);
  if (children != nullptr) XFree(children);
  return found;
}

} // namespace

Desk::Desk() {
  for (int i = 0; i < 50 && display_ == nullptr; ++i) { // a server without clients may be starting anew
    display_ = XOpenDisplay(nullptr);
    if (display_ == nullptr) std::this_thread::sleep_for(20ms);
  }
  if (display_ == nullptr) throw std::runtime_error("there is no X display: run this under xvfb-run");
  // A window may be gone when it is looked at.
  XSetErrorHandler([](Display*, XErrorEvent*) { return 0; });
}

Desk::~Desk() { XCloseDisplay(display_); }

bool Desk::hasWindow() { return named(display_, DefaultRootWindow(display_)) != 0; }

void Desk::find() {
  for (int i = 0; i < 500; ++i) {
    window_ = named(display_, DefaultRootWindow(display_));
    XWindowAttributes attributes{};
    if (window_ != 0 && XGetWindowAttributes(display_, window_, &attributes) != 0 &&
        attributes.map_state == IsViewable) {
      XSetInputFocus(display_, window_, RevertToParent, CurrentTime);
      move(attributes.width / 2, attributes.height / 2);
      return;
    }
    std::this_thread::sleep_for(20ms);
  }
  throw std::runtime_error("no window was opened");
}

void Desk::flush() {
  XSync(display_, False);
  std::this_thread::sleep_for(30ms); // a frame
}

void Desk::key(const std::string& name, const std::vector<std::string>& held) {
  const auto code = [&](const std::string& key) {
    const KeyCode found = XKeysymToKeycode(display_, XStringToKeysym(key.c_str()));
    if (found == 0) throw std::runtime_error("the keyboard has no " + key);
    return found;
  };
  for (const std::string& other : held) XTestFakeKeyEvent(display_, code(other), True, CurrentTime);
  if (!held.empty()) flush();
  XTestFakeKeyEvent(display_, code(name), True, CurrentTime);
  flush();
  XTestFakeKeyEvent(display_, code(name), False, CurrentTime);
  for (const std::string& other : held) XTestFakeKeyEvent(display_, code(other), False, CurrentTime);
  flush();
}

void Desk::move(int x, int y) {
  int rootX = 0;
  int rootY = 0;
  ::Window child = 0;
  XTranslateCoordinates(display_, window_, DefaultRootWindow(display_), x, y, &rootX, &rootY, &child);
  XTestFakeMotionEvent(display_, -1, rootX, rootY, CurrentTime);
  flush();
}

void Desk::press(unsigned button, bool down) {
  XTestFakeButtonEvent(display_, button, down ? True : False, CurrentTime);
  flush();
}

void Desk::drag(unsigned button, int fromX, int fromY, int toX, int toY) {
  move(fromX, fromY);
  press(button, true);
  constexpr int kSteps = 4;
  for (int i = 1; i <= kSteps; ++i) {
    move(fromX + (toX - fromX) * i / kSteps, fromY + (toY - fromY) * i / kSteps);
  }
  press(button, false);
}

void Desk::wheel(int steps) {
  const unsigned button = steps > 0 ? 4 : 5;
  for (int i = 0; i < std::abs(steps); ++i) {
    press(button, true);
    press(button, false);
  }
}

void Desk::resize(unsigned width, unsigned height) {
  XResizeWindow(display_, window_, width, height);
  flush();
}

void Desk::minimise(bool on) {
  on ? XUnmapWindow(display_, window_) : XMapWindow(display_, window_);
  flush();
}

void Desk::close() {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = window_;
  event.xclient.message_type = XInternAtom(display_, "WM_PROTOCOLS", False);
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(XInternAtom(display_, "WM_DELETE_WINDOW", False));
  event.xclient.data.l[1] = CurrentTime;
  XSendEvent(display_, window_, False, NoEventMask, &event);
  flush();
}

// The source's side of https://freedesktop.org/wiki/Specifications/XDND/, version 5.
void Desk::drop(const std::vector<std::string>& files) {
  const auto atom = [&](const char* name) { return XInternAtom(display_, name, False); };
  const ::Window source = XCreateSimpleWindow(display_, DefaultRootWindow(display_), 0, 0, 1, 1, 0, 0, 0);
  XSetSelectionOwner(display_, atom("XdndSelection"), source, CurrentTime);
  const auto send = [&](const char* type, long one, long two, long three, long four) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = window_;
    event.xclient.message_type = atom(type);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(source);
    event.xclient.data.l[1] = one;
    event.xclient.data.l[2] = two;
    event.xclient.data.l[3] = three;
    event.xclient.data.l[4] = four;
    XSendEvent(display_, window_, False, NoEventMask, &event);
    XSync(display_, False);
  };
  std::string list;
  for (const std::string& file : files) list += "file://" + file + "\r\n";
  send("XdndEnter", 5L << 24, static_cast<long>(atom("text/uri-list")), 0, 0);
  XWindowAttributes attributes{};
  XGetWindowAttributes(display_, window_, &attributes);
  send("XdndPosition", 0, (static_cast<long>(attributes.width / 2) << 16) | (attributes.height / 2), CurrentTime,
       static_cast<long>(atom("XdndActionCopy")));
  bool isDropped = false;
  for (int i = 0; i < 500; ++i) {
    while (XPending(display_) > 0) {
      XEvent event{};
      XNextEvent(display_, &event);
      if (event.type == ClientMessage && event.xclient.message_type == atom("XdndStatus") && !isDropped) {
        if ((event.xclient.data.l[1] & 1) == 0) throw std::runtime_error("the window takes no files");
        send("XdndDrop", 0, CurrentTime, 0, 0);
        isDropped = true;
      }
      if (event.type == SelectionRequest) {
        const XSelectionRequestEvent& wanted = event.xselectionrequest;
        XChangeProperty(display_, wanted.requestor, wanted.property, wanted.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(list.data()), static_cast<int>(list.size()));
        XEvent answer{};
        answer.xselection.type = SelectionNotify;
        answer.xselection.requestor = wanted.requestor;
        answer.xselection.selection = wanted.selection;
        answer.xselection.target = wanted.target;
        answer.xselection.property = wanted.property;
        answer.xselection.time = wanted.time;
        XSendEvent(display_, wanted.requestor, False, NoEventMask, &answer);
        XSync(display_, False);
      }
      if (event.type == ClientMessage && event.xclient.message_type == atom("XdndFinished")) {
        XDestroyWindow(display_, source);
        flush();
        return;
      }
    }
    std::this_thread::sleep_for(10ms);
  }
  throw std::runtime_error("the window did not take the files");
}

Pixels Desk::look() {
  XWindowAttributes attributes{};
  XGetWindowAttributes(display_, window_, &attributes);
  XImage* image = XGetImage(display_, window_, 0, 0, static_cast<unsigned>(attributes.width),
                            static_cast<unsigned>(attributes.height), AllPlanes, ZPixmap);
  if (image == nullptr) throw std::runtime_error("the window cannot be looked at");
  Pixels pixels{static_cast<std::uint32_t>(attributes.width), static_cast<std::uint32_t>(attributes.height), {}};
  for (int y = 0; y < attributes.height; ++y) {
    for (int x = 0; x < attributes.width; ++x) {
      const unsigned long code = XGetPixel(image, x, y);
      for (const unsigned shift : {16U, 8U, 0U}) pixels.rgb.push_back(static_cast<std::uint8_t>(code >> shift));
    }
  }
  XDestroyImage(image);
  return pixels;
}

} // namespace vitrail::tests
