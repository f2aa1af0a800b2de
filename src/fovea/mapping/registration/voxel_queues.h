// Selects one point for each voxel among the points of several scans.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "fovea/core/flat_map.h"
#include "fovea/geometry/cell_brick.h"

namespace fovea {

/// A first-in, first-out queue of points for each voxel. Each update takes constant time when a
/// scan is added or removed. Empty voxels use no memory. Coordinates are within a million voxels.
class VoxelQueues {
 public:
  /// A point: its scan and its index in this scan.
  struct Item {
    std::uint32_t scan = 0, index = 0;
    friend bool operator==(const Item&, const Item&) = default;
  };

  /// @param voxel  edge, m
  explicit VoxelQueues(float voxel) : inverse_voxel_(1 / voxel) {}

  /// Appends an item to its voxel's queue, unless the last item there is of the same scan.
  /// @param next_of  next_of(item) returns a reference to the storage of the item's successor
  /// @return whether the item is the first of its voxel
  template <class NextOf>
  bool push(const Eigen::Vector3f& p, const Item& item, NextOf&& next_of) {
    const auto [queue, is_new] = queues_.try_emplace(key_of(p), {item, item});
    if (is_new) return true;
    if (queue->last.scan == item.scan) return false;
    next_of(queue->last) = item;
    queue->last = item;
    return false;
  }

  /// Removes the first item of a voxel that is not empty.
  /// @return the new first item, if there is one
  template <class NextOf>
  std::optional<Item> pop(const Eigen::Vector3f& p, NextOf&& next_of) {
    const std::uint64_t key = key_of(p);
    Queue& queue = *queues_.find(key);
    if (queue.first == queue.last) {
      queues_.erase(key);
      return std::nullopt;
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
