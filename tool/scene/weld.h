// Finds equal vertices in one pass, without sorting.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace vitrail::tool {

// Numbers places in the order of their first appearance: a hash table with open addresses, kept less than half full.
// The two zeros are one. Places are finite.
class Welder {
 public:
  struct Key {
    glm::vec3 position{0.0F};
    std::uint32_t tag = 0; // whatever else tells vertices apart

    bool operator==(const Key&) const = default;
  };

  // Makes room for so many different places.
  explicit Welder(std::size_t expected = 0) { grow(std::bit_ceil(expected * 2 + 64)); }

  // The number of this place; the next one where it is new.
  std::uint32_t add(const glm::vec3& position, std::uint32_t tag = 0) {
    const Key key{position + 0.0F, tag};
    return add(key, hashOf(key));
  }

  // The same for the three corners of a triangle, in their order, whose places in memory are fetched at once.
  std::array<std::uint32_t, 3> add(const std::array<glm::vec3, 3>& positions, std::uint32_t tag) {
    std::array<Key, 3> keys;
    std::array<std::uint32_t, 3> hashes;
    for (std::size_t i = 0; i < 3; ++i) {
      keys[i] = {positions[i] + 0.0F, tag};
      hashes[i] = hashOf(keys[i]);
      __builtin_prefetch(&slots_[hashes[i] & mask_]);
    }
    return {add(keys[0], hashes[0]), add(keys[1], hashes[1]), add(keys[2], hashes[2])};
  }

  std::size_t size() const { return keys_.size(); }
  // The keys in their order; the table is empty afterwards.
  std::vector<Key> take();

 private:
  std::uint32_t add(const Key& key, std::uint32_t hash) {
    for (std::size_t slot = hash & mask_;; slot = (slot + 1) & mask_) {
      const Slot found = slots_[slot];
      if (found.number == none) return insert(slot, key, hash);
      if (found.hash == hash && keys_[found.number] == key) return found.number;
    }
  }

  static constexpr std::uint32_t none = 0xffffffff;

  struct Slot {
    std::uint32_t number = none;
    std::uint32_t hash = 0;
  };

  static std::uint32_t hashOf(const Key& key) {
    const auto bits = [](float value) { return std::uint64_t{std::bit_cast<std::uint32_t>(value)}; };
    std::uint64_t mixed = (bits(key.position.x) | bits(key.position.y) << 32U) * 0x9e3779b97f4a7c15U;
    mixed ^= mixed >> 29U;
    mixed = (mixed ^ (bits(key.position.z) | std::uint64_t{key.tag} << 32U)) * 0xbf58476d1ce4e5b9U;
    return static_cast<std::uint32_t>(mixed >> 32U);
  }

  std::uint32_t insert(std::size_t slot, const Key& key, std::uint32_t hash);
  void grow(std::size_t size);

  std::vector<Slot> slots_;
  std::vector<Key> keys_;
  std::size_t mask_ = 0;
};

} // namespace vitrail::tool
