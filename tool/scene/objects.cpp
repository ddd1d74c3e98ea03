#include "objects.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "message.h"
#include "scene.h"

namespace vitrail::tool {

std::uint32_t ObjectTree::add(std::string_view name, std::uint32_t parent) {
  begins_.push_back(names_.size());
  names_.append(name.substr(0, name.find('\0'))).push_back('\0');
  parents_.push_back(parent);
  return size() - 1;
}

std::uint32_t ObjectTree::append(const ObjectTree& other, std::uint32_t parent) {
  const std::uint32_t first = size();
  for (std::uint32_t i = 0; i < other.size(); ++i) {
    add(other.name(i), other.parent(i) == none ? parent : first + other.parent(i));
  }
  return first;
}

std::string ObjectTree::path(std::uint32_t object) const {
  std::vector<std::string_view> way;
  for (std::uint32_t at = object; at != none; at = parents_[at]) way.push_back(name(at));
  std::ranges::reverse(way);
  return fmt::format("{}", fmt::join(way, "/"));
}

std::vector<std::uint32_t> ObjectTree::keep(const std::vector<bool>& marked) {
  ObjectTree kept;
  std::vector<std::uint32_t> numbers(size(), none);
  for (std::uint32_t i = 0; i < size(); ++i) {
    if (marked[i]) numbers[i] = kept.add(name(i), parents_[i] == none ? none : numbers[parents_[i]]);
  }
  *this = std::move(kept);
  return numbers;
}

void dropEmptyObjects(Scene& scene) {
  std::vector<bool> drawn(scene.objects.size(), false);
  for (const Draw& draw : scene.draws) {
    for (std::uint32_t at = draw.object; at != ObjectTree::none && !drawn[at]; at = scene.objects.parent(at)) {
      drawn[at] = true;
    }
  }
  if (std::ranges::find(drawn, false) == drawn.end()) return;
  const std::vector<std::uint32_t> numbers = scene.objects.keep(drawn);
  for (Draw& draw : scene.draws) {
    if (draw.object != ObjectTree::none) draw.object = numbers[draw.object];
  }
}

void nameDraws(Scene& scene) {
  for (std::size_t i = 0; i < scene.draws.size(); ++i) {
    Draw& draw = scene.draws[i];
    if (draw.object != ObjectTree::none) continue;
    const std::string& material = scene.materials[draw.material].name;
    draw.object = scene.objects.add(material.empty() ? fmt::format("draw {}", i) : material);
  }
}

namespace {

// Marks the objects of a name, or a path, and all that is below them.
std::vector<bool> named(const ObjectTree& objects, const std::string& name) {
  std::vector<bool> marked(objects.size(), false);
  bool any = false;
  const bool isPath = name.find('/') != std::string::npos;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    const std::uint32_t parent = objects.parent(i);
    const bool isIt = objects.name(i) == name || (isPath && name.ends_with(objects.name(i)) && objects.path(i) == name);
    any = any || isIt;
    marked[i] = isIt || (parent != ObjectTree::none && marked[parent]);
  }
  if (any) return marked;
  constexpr std::size_t kMost = 8;
  std::vector<std::string> known;
  for (std::uint32_t i = 0; i < objects.size() && known.size() <= kMost; ++i) {
    std::string text = fmt::format("\"{}\"", oneLine(objects.name(i)));
    if (std::ranges::find(known, text) == known.end()) known.push_back(std::move(text));
  }
  if (known.size() > kMost) known.back() = "...";
  throw std::invalid_argument(
      fmt::format("no object is named \"{}\"; there are {}", oneLine(name), fmt::join(known, ", ")));
}

} // namespace

std::vector<bool> shownObjects(const ObjectTree& objects, const ObjectChoice& choice) {
  std::vector<bool> shown(objects.size(), choice.isolate.empty());
  const auto set = [&](const std::vector<std::string>& names, bool value) {
    for (const std::string& name : names) {
      const std::vector<bool> marked = named(objects, name);
      for (std::size_t i = 0; i < shown.size(); ++i) {
        if (marked[i]) shown[i] = value;
      }
    }
  };
  set(choice.isolate, true);
  set(choice.hide, false);
  set(choice.show, true);
  return shown;
}

std::vector<float> opacities(const ObjectTree& objects, const ObjectChoice& choice) {
  std::vector<float> factors(objects.size(), 1.0F);
  for (const ObjectChoice::Fade& fade : choice.fade) {
    const std::vector<bool> marked = named(objects, fade.name);
    for (std::size_t i = 0; i < factors.size(); ++i) {
      if (marked[i]) factors[i] = fade.opacity;
    }
  }
  return factors;
}

void chooseObjects(Scene& scene, const ObjectChoice& choice) {
  if (choice.isAll()) return;
  const std::vector<bool> shown = shownObjects(scene.objects, choice);
  std::erase_if(scene.draws, [&](const Draw& draw) { return !shown[draw.object]; });
  if (choice.fade.empty()) return;
  const std::vector<float> factors = opacities(scene.objects, choice);
  std::map<std::pair<std::uint32_t, float>, std::uint32_t> made; // of a material and a factor
  for (Draw& draw : scene.draws) {
    const float factor = factors[draw.object];
    if (factor == 1.0F) continue;
    const auto [known, isNew] =
        made.try_emplace({draw.material, factor}, static_cast<std::uint32_t>(scene.materials.size()));
    if (isNew) {
      Material faded = scene.materials[draw.material];
      faded.alphaMode = AlphaMode::Blend;
      faded.baseColor.a *= factor;
      scene.materials.push_back(std::move(faded));
    }
    draw.material = known->second;
  }
}

} // namespace vitrail::tool
