// The named parts of a scene, nested as in its file: what --hide, --show and --isolate name, and what a picked layer is
// of.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vitrail::tool {

struct Scene;

// Kept without an allocation for each: files may have millions of nodes.
class ObjectTree {
 public:
  static constexpr std::uint32_t none = 0xffffffff;

  // Adds one below another, which was added before it. Its number.
  std::uint32_t add(std::string_view name, std::uint32_t parent = none);
  // Adds all of another tree below one of this; the number of its first.
  std::uint32_t append(const ObjectTree& other, std::uint32_t parent);

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(parents_.size()); }
  [[nodiscard]] std::string_view name(std::uint32_t object) const { return names_.c_str() + begins_[object]; }
  [[nodiscard]] std::uint32_t parent(std::uint32_t object) const { return parents_[object]; } // or none
  // "Car/Wheel/Tyre"
  [[nodiscard]] std::string path(std::uint32_t object) const;

  // Keeps those that are marked; marked ones have marked parents. The new number of each, or none.
  std::vector<std::uint32_t> keep(const std::vector<bool>& marked);

 private:
  std::string names_; // each ends with a 0
  std::vector<std::size_t> begins_;
  std::vector<std::uint32_t> parents_;
};

// Drops objects below which nothing is drawn.
void dropEmptyObjects(Scene& scene);

// Gives each draw that belongs to no object one of its own, named after its material, or its number.
void nameDraws(Scene& scene);

// What of a scene is drawn: names of objects, or paths; those below them go with them.
struct ObjectChoice {
  std::vector<std::string> isolate; // these alone; none: all
  std::vector<std::string> hide;    // of those
  std::vector<std::string> show;    // of what was hidden
  struct Fade {
    std::string name;
    float opacity = 1.0F; // its materials are blended with that factor, above 0 and at most 1
    bool operator==(const Fade&) const = default;
  };
  std::vector<Fade> fade; // the last one of an object, or of one above it, counts

  [[nodiscard]] bool isAll() const { return isolate.empty() && hide.empty() && show.empty() && fade.empty(); }
  bool operator==(const ObjectChoice&) const = default;
};

// Whether each object is drawn. Throws std::invalid_argument where there is no object of a name, with some that there
// are.
std::vector<bool> shownObjects(const ObjectTree& objects, const ObjectChoice& choice);

// The factor of each object's opacity. Throws the same.
std::vector<float> opacities(const ObjectTree& objects, const ObjectChoice& choice);

// Leaves out the draws that are not, and gives those that are faded materials of their own. The objects stay. Throws
// the same.
void chooseObjects(Scene& scene, const ObjectChoice& choice);

} // namespace vitrail::tool
