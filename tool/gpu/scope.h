// Rendering scopes: which images a pass draws into, with the barriers before it and the viewport.
#pragma once

#include <optional>
#include <vector>

#include "used_image.h"

namespace vitrail::tool {

struct ColorAttachment {
  UsedImage* image = nullptr;
  bool keep = true; // what it holds is needed
  // The image is cleared to this first; it need not be kept.
  std::optional<VkClearColorValue> clear = {};
  // Several samples: each pixel's mean goes there at the end, and nothing is drawn into `image`.
  UsedImage* average = nullptr;
};

// What a scope does with one aspect of the depth image.
enum class AspectUse { None, Test, Write };

struct DepthAttachment {
  UsedImage* image = nullptr;
  AspectUse depth = AspectUse::None;
  AspectUse stencil = AspectUse::None; // an image that has a stencil and is used for depth has it tested at least
  std::optional<VkClearDepthStencilValue> clear = {}; // of the aspects that are written. Default: they are kept
  bool sampled = false; // fragment shaders of the scope read it; then neither aspect is written
};

struct Scope {
  VkExtent2D extent{}; // of the images, and the viewport
  VkRect2D area{};     // of it: what is drawn
  std::vector<ColorAttachment> colors;
  DepthAttachment depth;
};

// Waits for what the images were used for before, begins the scope and sets viewport and scissor. Colours are in
// VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL. End it with vkCmdEndRendering().
void cmdBeginScope(VkCommandBuffer commands, const Scope& scope);

} // namespace vitrail::tool
