// Which of several scans' points stands for a voxel, kept up to date as scans come and go.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fovea/base/flat_map.h"
#include "fovea/geometry/cell_brick.h"

namespace fovea {

/// For each voxel the points in it, oldest first. Forgets empty voxels, so that it stays as small
/// as what it holds. Coordinates are within a million voxels.
class VoxelQueues {
 public:
  /// Of a point: by whom it was put, and its number there.
  struct Item {
    std::uint32_t owner = kNobody, index = 0;
    friend bool operator==(const Item&, const Item&) = default;
  };
  static constexpr std::uint32_t kNobody = 0xffffffffu;

  /// @param voxel  edge, m
  explicit VoxelQueues(float voxel) : inverse_voxel_(1 / voxel) {}

  /// Puts an item behind those of its voxel, unless the last of them is the same owner's.
  /// @param next_of  next_of(item) is a reference to the place where the item behind `item` is kept
  /// @return whether it is the first of its voxel
  template <class NextOf>
  bool push(const Eigen::Vector3f& p, const Item& item, NextOf&& next_of) {
    const auto [queue, is_new] = queues_.try_emplace(key_of(p), {item, item});
    if (is_new) return true;
    if (queue->last.owner == item.owner) return false;
    next_of(queue->last) = item;
    queue->last = item;
    return false;
  }

  /// Something will be asked of this voxel soon.
  void prefetch(const Eigen::Vector3f& p) const { queues_.prefetch(key_of(p)); }

  /// Removes the first item of a voxel that has one.
  /// @return the one that is first now; of owner kNobody if there is none
  template <class NextOf>
  Item pop(const Eigen::Vector3f& p, NextOf&& next_of) {
    const std::uint64_t key = key_of(p);
    Queue& queue = *queues_.find(key);
    if (queue.first == queue.last) {
      queues_.erase(key);
      return {};
    }
    return queue.first = next_of(queue.first);
  }

 private:
  struct Queue {
    Item first, last;
  };
  std::uint64_t key_of(const Eigen::Vector3f& p) const {
    return cell_key((p.array() * inverse_voxel_).floor().cast<int>());
  }

  float inverse_voxel_;
  FlatMap<Queue> queues_;
};

}  // namespace fovea
