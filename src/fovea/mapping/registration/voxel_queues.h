// Which of several scans' points stands for a voxel, kept up to date as scans come and go.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fovea {

/// For each voxel the points in it, oldest first. Open addressing in one flat table that forgets
/// empty voxels, so that it stays as small as what it holds.
class VoxelQueues {
 public:
  /// Of a point: by whom it was put, and its number there.
  struct Item {
    std::uint32_t owner = kNobody, index = 0;
    friend bool operator==(const Item&, const Item&) = default;
  };
  static constexpr std::uint32_t kNobody = 0xffffffffu;

  /// @param voxel  edge, m
  explicit VoxelQueues(float voxel) : inverse_voxel_(1 / voxel), slots_(kFirstSlots) {}

  /// Puts an item behind those of its voxel, unless the last of them is the same owner's.
  /// @param next_of  next_of(item) is a reference to the place where the item behind `item` is kept
  /// @return whether it is the first of its voxel
  template <class NextOf>
  bool push(const Eigen::Vector3f& p, const Item& item, NextOf&& next_of) {
    const std::uint64_t key = key_of(p);
    Slot& slot = slots_[place_of(key)];
    if (slot.key == kFree) {
      slot = {key, item, item};
      if (2 * ++used_ > slots_.size()) grow();
      return true;
    }
    if (slot.last.owner == item.owner) return false;
    next_of(slot.last) = item;
    slot.last = item;
    return false;
  }

  /// Removes the first item of a voxel.
  /// @return the one that is first now; of owner kNobody if there is none
  template <class NextOf>
  Item pop(const Eigen::Vector3f& p, NextOf&& next_of) {
    const std::size_t place = place_of(key_of(p));
    Slot& slot = slots_[place];
    if (slot.first == slot.last) {
      release(place);
      return {};
    }
    return slot.first = next_of(slot.first);
  }

 private:
  static constexpr std::size_t kFirstSlots = 1 << 12;
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};  // keys have 63 bits
  struct Slot {
    std::uint64_t key = kFree;
    Item first, last;
  };
  /// 21 bits an axis: a million voxels to either side.
  std::uint64_t axis(float value) const {
    const auto cell = static_cast<std::int64_t>(std::floor(value * inverse_voxel_)) + (1 << 20);
    return static_cast<std::uint64_t>(cell) & 0x1fffff;
  }
  std::uint64_t key_of(const Eigen::Vector3f& p) const {
    return axis(p.x()) | axis(p.y()) << 21 | axis(p.z()) << 42;
  }
  std::size_t home_of(std::uint64_t key) const {
    return (key * 0x9e3779b97f4a7c15ull) >> 20 & (slots_.size() - 1);
  }
  /// Of the slot with this key, or of the free one where it belongs.
  std::size_t place_of(std::uint64_t key) const;
  /// Frees a slot; what has been put behind it since for want of room moves up.
  void release(std::size_t place);
  void grow();

  float inverse_voxel_;
  std::vector<Slot> slots_;  // a power of two of them, at most half in use
  std::size_t used_ = 0;
};

}  // namespace fovea
