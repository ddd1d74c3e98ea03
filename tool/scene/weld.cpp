// Finds equal vertices in one pass.
#include "weld.h"

#include <utility>

namespace vitrail::tool {

std::vector<Welder::Key> Welder::take() {
  slots_ = {};
  grow(64);
  return std::exchange(keys_, {});
}

std::uint32_t Welder::insert(std::size_t slot, const Key& key, std::uint32_t hash) {
  const auto number = static_cast<std::uint32_t>(keys_.size());
  slots_[slot] = {number, hash};
  keys_.push_back(key);
  if (2 * keys_.size() > slots_.size()) grow(2 * slots_.size());
  return number;
}

void Welder::grow(std::size_t size) {
  const std::vector<Slot> before = std::exchange(slots_, std::vector<Slot>(size));
  mask_ = size - 1;
  for (const Slot& slot : before) {
    if (slot.number == none) continue;
    std::size_t place = slot.hash & mask_;
    while (slots_[place].number != none) place = (place + 1) & mask_;
    slots_[place] = slot;
  }
}

} // namespace vitrail::tool
