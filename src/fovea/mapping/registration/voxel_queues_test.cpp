#include "fovea/mapping/registration/voxel_queues.h"

#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <optional>
#include <tuple>

#include "fovea/core/random.h"

namespace fovea::voxel_queues_test {

using Item = VoxelQueues::Item;

/// Compares the queues with a search through all scans while scans are added and removed.
TEST(VoxelQueues, TheOldestPointOfAVoxelIsFirst) {
  constexpr float kVoxel = 0.5f;
  constexpr std::size_t kScans = 4;
  Random random(1);
  VoxelQueues queues(kVoxel);
  struct Scan {
    std::uint32_t number;
    std::vector<Eigen::Vector3f> points;
    std::vector<Item> next;
    std::vector<bool> first;
  };
  std::deque<Scan> scans;
  const auto next_of = [&](const Item& item) -> Item& {
    return scans[item.scan - scans.front().number].next[item.index];
  };
  for (std::uint32_t number = 0; number < 60; ++number) {
    if (scans.size() == kScans) {
      const Scan& oldest = scans.front();
      for (std::size_t i = 0; i < oldest.points.size(); ++i) {
        if (!oldest.first[i]) continue;
        const std::optional<Item> successor = queues.pop(oldest.points[i], next_of);
        if (successor) scans[successor->scan - oldest.number].first[successor->index] = true;
      }
      scans.pop_front();
    }
    Scan& scan = scans.emplace_back();
    scan.number = number;
    // The center moves, so voxels become occupied and empty.
    const double center = 0.4 * number;
    scan.points.resize(number % 7 == 6 ? 0 : 700);
    for (Eigen::Vector3f& p : scan.points) {
      p = {static_cast<float>(random.uniform(center - 2, center + 2)),
           static_cast<float>(random.uniform(-2, 2)), static_cast<float>(random.uniform(-1, 1))};
    }
    scan.next.resize(scan.points.size());
    scan.first.resize(scan.points.size());
    for (std::uint32_t i = 0; i < scan.points.size(); ++i) {
      scan.first[i] = queues.push(scan.points[i], {number, i}, next_of);
    }
    std::map<std::tuple<int, int, int>, Item> truth;
    for (const Scan& s : scans) {
      for (std::uint32_t i = 0; i < s.points.size(); ++i) {
        const Eigen::Vector3i v = (s.points[i] / kVoxel).array().floor().cast<int>();
        const bool is_first = truth.try_emplace({v.x(), v.y(), v.z()}, Item{s.number, i}).second;
        ASSERT_EQ(s.first[i], is_first) << "scan " << s.number << " of " << number;
      }
    }
  }
}

}  // namespace fovea::voxel_queues_test
