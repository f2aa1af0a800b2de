#include "fovea/mapping/registration/voxel_queues.h"

namespace fovea {

std::size_t VoxelQueues::place_of(std::uint64_t key) const {
  std::size_t place = home_of(key);
  while (slots_[place].key != key && slots_[place].key != kFree) {
    place = (place + 1) & (slots_.size() - 1);
  }
  return place;
}

void VoxelQueues::release(std::size_t place) {
  const std::size_t mask = slots_.size() - 1;
  --used_;
  // Knuth, The Art of Computer Programming 3, 6.4, algorithm R.
  for (std::size_t next = (place + 1) & mask; slots_[next].key != kFree; next = (next + 1) & mask) {
    const std::size_t home = home_of(slots_[next].key);
    if (((next - home) & mask) < ((next - place) & mask)) continue;  // found where it is
    slots_[place] = slots_[next];
    place = next;
  }
  slots_[place] = Slot();
}

void VoxelQueues::grow() {
  std::vector<Slot> before(2 * slots_.size());
  before.swap(slots_);
  for (const Slot& slot : before) {
    if (slot.key != kFree) slots_[place_of(slot.key)] = slot;
  }
}

}  // namespace fovea
