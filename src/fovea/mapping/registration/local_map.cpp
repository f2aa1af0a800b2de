#include "fovea/mapping/registration/local_map.h"

#include <bit>
#include <cmath>
#include <stdexcept>

#include "fovea/base/errors.h"

namespace fovea {
namespace {

/// Set of voxels: open addressing in one flat table, because it is filled anew with every scan.
class VoxelSet {
 public:
  VoxelSet(float voxel, std::size_t capacity)
      : inverse_voxel_(1 / voxel), slots_(std::bit_ceil(capacity * 2 + 1), kFree) {}

  /// Whether the point is the first of its voxel.
  bool insert(const Eigen::Vector3f& p) {
    const std::uint64_t key = axis(p.x()) | axis(p.y()) << 21 | axis(p.z()) << 42;
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = (key * 0x9e3779b97f4a7c15ull) >> 20 & mask;; i = (i + 1) & mask) {
      if (slots_[i] == key) return false;
      if (slots_[i] == kFree) {
        slots_[i] = key;
        return true;
      }
    }
  }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};  // keys have 63 bits
  /// 21 bits an axis: a million voxels to either side.
  std::uint64_t axis(float value) const {
    const auto cell = static_cast<std::int64_t>(std::floor(value * inverse_voxel_)) + (1 << 20);
    return static_cast<std::uint64_t>(cell) & 0x1fffff;
  }

  float inverse_voxel_;
  std::vector<std::uint64_t> slots_;
};

}  // namespace

void LocalMapOptions::validate() const {
  const auto reject = [](const char* what, const char* field, const char* remedy) {
    throw ConfigError(what, field, remedy);
  };
  if (max_keyframes < 1 || max_keyframes > 1000) {
    reject("a number of scans is out of range", "local_map.max_keyframes", "give 1 to 1000");
  }
  if (!(max_range > 0 && max_range <= 1000)) {
    reject("a range is out of range", "local_map.max_range", "give metres above 0 and up to 1000");
  }
  if (!(voxel == 0 || (voxel >= 0.01 && voxel <= 10))) {
    reject("a voxel size is out of range", "local_map.voxel",
           "give 0 (off) or metres from 0.01 to 10");
  }
}

LocalMap::LocalMap(const LocalMapOptions& options) : options_(options) { options_.validate(); }

void LocalMap::add(RegistrationCloud cloud_lidar, const RigidMotion& T_local_lidar) {
  keyframes_.push_back({std::move(cloud_lidar), T_local_lidar});
  if (keyframes_.size() > static_cast<std::size_t>(options_.max_keyframes)) keyframes_.pop_front();
  const Eigen::Vector3d origin = T_local_lidar.translation();
  RegistrationCloud cloud = thinned(origin);
  KdTree tree(cloud.points);  // moving the vector below keeps its points where they are
  target_ = std::make_unique<Target>(Target{origin, std::move(cloud), std::move(tree)});
}

RegistrationCloud LocalMap::thinned(const Eigen::Vector3d& origin_local) const {
  std::size_t total = 0;
  for (const Keyframe& keyframe : keyframes_) total += keyframe.cloud_lidar.points.size();
  VoxelSet occupied(static_cast<float>(options_.voxel), total);
  const float max_range2 = static_cast<float>(options_.max_range * options_.max_range);

  RegistrationCloud cloud;
  // The oldest scan has a voxel: the target changes least from scan to scan, and drifts least.
  for (const Keyframe& keyframe : keyframes_) {
    const RegistrationCloud& source = keyframe.cloud_lidar;
    const Eigen::Matrix3f R = keyframe.T_local_lidar.linear().cast<float>();
    const Eigen::Vector3f t = (keyframe.T_local_lidar.translation() - origin_local).cast<float>();
    for (std::size_t i = 0; i < source.points.size(); ++i) {
      const Eigen::Vector3f p = R * source.points[i] + t;
      if (p.squaredNorm() > max_range2) continue;
      if (options_.voxel > 0 && !occupied.insert(p)) continue;
      cloud.points.push_back(p);
      if (!source.normals.empty()) cloud.normals.push_back(R * source.normals[i]);
    }
  }
  return cloud;
}

const LocalMap::Target& LocalMap::target() const {
  if (target_ == nullptr) throw std::logic_error("the local map is empty");
  return *target_;
}

RegistrationResult register_to(const LocalMap& map, const RegistrationCloud& source_lidar,
                               const RigidMotion& guess_T_local_lidar,
                               const RegistrationOptions& options) {
  const LocalMap::Target& target = map.target();
  const Eigen::Translation3d T_origin_local(-target.origin_local);
  RegistrationResult result = register_clouds(target.cloud, target.tree, source_lidar,
                                              T_origin_local * guess_T_local_lidar, options);
  result.T_target_source = T_origin_local.inverse() * result.T_target_source;
  return result;
}

}  // namespace fovea
