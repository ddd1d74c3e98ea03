// Evaluates glTF's animations (glTF 2.0, section 3.11 and appendix C).
#include "animation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../message.h"
#include "accessor.h"
#include "extensions.h"

namespace vitrail::tool {
namespace {

enum class Interpolation { Step, Linear, CubicSpline };

// The two keys around a time, and how far it is from the one to the other.
struct Moment {
  std::size_t from = 0;
  std::size_t to = 0;
  double share = 0.0;   // 0 to 1
  double seconds = 0.0; // between the keys
};

// A sampler in memory.
struct Track {
  Interpolation interpolation = Interpolation::Linear;
  std::vector<float> times;
  std::vector<glm::vec4> values; // of cubic splines three a key: in-tangent, value, out-tangent
  std::size_t width = 1;         // how many values a key has: weights have several
  std::string where;
};

std::vector<float> readTimes(const GltfDocument& document, std::size_t accessor) {
  const std::vector<glm::vec4> values = readVectors(document, accessor, 1, 1, "animation times");
  std::vector<float> times;
  times.reserve(values.size());
  for (const glm::vec4& value : values) times.push_back(value.x);
  return times;
}

Interpolation interpolationOf(const std::string& text, const std::string& where) {
  if (text == "STEP") return Interpolation::Step;
  if (text == "LINEAR") return Interpolation::Linear;
  if (text == "CUBICSPLINE") return Interpolation::CubicSpline;
  throw LoadError(
      fmt::format("{}: interpolation is \"{}\", none of STEP, LINEAR and CUBICSPLINE", where, oneLine(text)));
}

Moment momentAt(const Track& track, double time) {
  const std::vector<float>& times = track.times;
  const auto after = std::ranges::upper_bound(times, time);
  Moment moment;
  moment.to = std::min(static_cast<std::size_t>(after - times.begin()), times.size() - 1);
  moment.from = after == times.begin() ? 0 : static_cast<std::size_t>(after - times.begin()) - 1;
  moment.seconds = static_cast<double>(times[moment.to]) - static_cast<double>(times[moment.from]);
  if (moment.seconds > 0.0)
    moment.share = std::clamp((time - static_cast<double>(times[moment.from])) / moment.seconds, 0.0, 1.0);
  return moment;
}

// Along the shorter of the two arcs.
glm::dvec4 slerp(const glm::dvec4& from, glm::dvec4 to, double share) {
  double cosine = glm::dot(from, to);
  if (cosine < 0.0) {
    to = -to;
    cosine = -cosine;
  }
  if (cosine > 0.9999999) return glm::mix(from, to, share);
  const double angle = std::acos(cosine);
  return (from * std::sin((1.0 - share) * angle) + to * std::sin(share * angle)) / std::sin(angle);
}

// Value `i` of those that each key has.
glm::dvec4 valueAt(const Track& track, const Moment& moment, std::size_t i, bool rotation) {
  const std::size_t parts = track.interpolation == Interpolation::CubicSpline ? 3 : 1;
  const auto part = [&](std::size_t key, std::size_t which) {
    return glm::dvec4(track.values[(key * parts + which) * track.width + i]);
  };
  const glm::dvec4 from = part(moment.from, parts / 2);
  const double t = moment.share;
  if (track.interpolation == Interpolation::Step) return t >= 1.0 ? part(moment.to, 0) : from;
  const glm::dvec4 to = part(moment.to, parts / 2);
  if (track.interpolation == Interpolation::Linear) return rotation ? slerp(from, to, t) : glm::mix(from, to, t);
  const double t2 = t * t;
  const double t3 = t2 * t;
  return from * (2.0 * t3 - 3.0 * t2 + 1.0) + part(moment.from, 2) * (moment.seconds * (t3 - 2.0 * t2 + t)) +
         to * (3.0 * t2 - 2.0 * t3) + part(moment.to, 0) * (moment.seconds * (t3 - t2));
}

// The pose of one animation at one time, collected from its channels.
class Pose {
 public:
  Pose(GltfDocument& document, const GltfAnimation& animation, std::string where, double time)
      : document_(document), animation_(animation), where_(std::move(where)), time_(time) {}

  void add(std::size_t index, Scene& scene) {
    const GltfAnimation::Channel& channel = animation_.channels[index];
    if (channel.sampler >= animation_.samplers.size())
      throw LoadError(fmt::format("{}: channels[{}].sampler is {}, but samplers has {} element{}", where_, index,
                                  channel.sampler, animation_.samplers.size(),
                                  animation_.samplers.size() == 1 ? "" : "s"));
    if (channel.path == "pointer") {
      warn(scene, extensionWarning("KHR_animation_pointer"));
    } else if (!channel.node) {
      return; // it moves nothing
    } else if (channel.path == "weights") {
      addWeights(*channel.node, track(channel, 1));
    } else if (channel.path == "translation") {
      placeOf(*channel.node).translation = glm::dvec3(single(track(channel, 3), false));
    } else if (channel.path == "scale") {
      placeOf(*channel.node).scale = glm::dvec3(single(track(channel, 3), false));
    } else if (channel.path == "rotation") {
      const glm::dvec4 rotation = single(track(channel, 4), true);
      const double length = glm::length(rotation);
      if (length > 0.0) placeOf(*channel.node).rotation = rotation / length;
    } else {
      warn(scene, fmt::format("{}: moves \"{}\" of nodes, which stands still", where_, oneLine(channel.path)));
    }
  }

  void apply() {
    for (const auto& [node, place] : places_) document_.nodes.setPlace(node, place);
  }

 private:
  GltfPlace& placeOf(std::uint32_t node) {
    const auto known = places_.find(node);
    return known != places_.end() ? known->second : places_.emplace(node, document_.nodes.place(node)).first->second;
  }

  Track track(const GltfAnimation::Channel& channel, int components) const {
    const GltfAnimation::Sampler& sampler = animation_.samplers[channel.sampler];
    Track track;
    track.where = fmt::format("{} sampler {}", where_, channel.sampler);
    track.interpolation = interpolationOf(sampler.interpolation, track.where);
    track.times = readTimes(document_, sampler.input);
    track.values = readVectors(document_, sampler.output, components, components, "animated " + channel.path);
    const std::size_t keys = track.times.size() * (track.interpolation == Interpolation::CubicSpline ? 3 : 1);
    const bool fits = keys > 0 && (components == 1 ? track.values.size() >= keys && track.values.size() % keys == 0
                                                   : track.values.size() == keys);
    if (!fits)
      throw LoadError(
          fmt::format("{}: has {} times, but {} values", track.where, track.times.size(), track.values.size()));
    track.width = track.values.size() / keys;
    return track;
  }

  [[nodiscard]] glm::dvec4 single(const Track& track, bool rotation) const {
    return valueAt(track, momentAt(track, time_), 0, rotation);
  }

  void addWeights(std::uint32_t node, const Track& track) {
    const Moment moment = momentAt(track, time_);
    std::vector<double> weights;
    weights.reserve(track.width);
    for (std::size_t i = 0; i < track.width; ++i) weights.push_back(valueAt(track, moment, i, false).x);
    document_.nodes.setWeights(node, std::move(weights));
  }

  GltfDocument& document_;
  const GltfAnimation& animation_;
  std::string where_;
  double time_;
  std::unordered_map<std::uint32_t, GltfPlace> places_;
};

// The index of the animation with that name or number. There is one.
std::size_t chosen(const std::vector<FileFacts::Animation>& animations, const std::optional<std::string>& choice) {
  if (animations.empty()) throw LoadError("holds no animations");
  if (const auto found = chosenAnimation(animations, choice)) return *found;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min<std::size_t>(animations.size(), 20); ++i)
    names.push_back(animations[i].name.empty() ? fmt::format("{}", i)
                                               : fmt::format("{} \"{}\"", i, oneLine(animations[i].name)));
  if (names.size() < animations.size()) names.emplace_back("...");
  throw LoadError(fmt::format("has no animation \"{}\"; it has {} {}", oneLine(*choice),
                              names.size() == 1 ? "one, number" : "numbers", fmt::join(names, ", ")));
}

} // namespace

std::vector<FileFacts::Animation> listAnimations(const GltfDocument& document) {
  std::map<std::size_t, double> ends; // of accessors
  const auto endOf = [&](std::size_t accessor) {
    const auto known = ends.find(accessor);
    if (known != ends.end()) return known->second;
    double end = 0.0;
    try {
      for (const float time : readTimes(document, accessor))
        if (std::isfinite(time)) end = std::max(end, static_cast<double>(time));
    } catch (const LoadError&) {
      // Whoever asks for the animation is told.
    }
    return ends[accessor] = end;
  };
  std::vector<FileFacts::Animation> list;
  list.reserve(document.animations.size());
  for (const GltfAnimation& animation : document.animations) {
    FileFacts::Animation& facts = list.emplace_back();
    facts.name = animation.name;
    for (const GltfAnimation::Sampler& sampler : animation.samplers)
      facts.seconds = std::max(facts.seconds, endOf(sampler.input));
  }
  return list;
}

void poseAt(GltfDocument& document, const LoadOptions& options, Scene& scene) {
  if (!options.time && !options.animation) return;
  if (options.optional && !hasAnimation(scene.file, options)) return;
  const std::size_t index = chosen(scene.file.animations, options.animation);
  const GltfAnimation animation = document.animations[index];
  Pose pose(document, animation, objectName("animation", index, animation.name), options.time.value_or(0.0));
  for (std::size_t i = 0; i < animation.channels.size(); ++i) pose.add(i, scene);
  pose.apply();
}

} // namespace vitrail::tool
