// The widgets beside the picture.
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "drawer.h"
#include "parts.h"
#include "settings.h"

namespace vitrail::tool {

// What the panel shows and what is changed in it.
struct PanelState {
  RenderArguments& arguments;
  Sorting& sorting;
  bool& rotates;
  bool& vsync;
  const Device& device;
  const SceneFacts* scene; // null: none was drawn
  const Picked* picked;    // null: nothing was
  const Picked* pickedBefore;
  Parts& parts;
  Beside& beside;
  const Drawn* drawn;                 // the picture on the screen; null: none
  std::string doing;                  // what the drawer is at
  const std::deque<PassTimes>& times; // of the last pictures, the newest last; all of one word where nothing is timed
};

struct PanelActions {
  bool frame = false;
  bool reset = false;
  bool save = false;
  bool copy = false;
  bool objects = false; // others are chosen: the camera stays
};

// Draws the panel; changes what the state refers to.
PanelActions drawPanel(const PanelState& state);

// A line at the bottom of the window, until it is clicked away.
void drawNotice(std::string& notice, bool isError);

} // namespace vitrail::tool
