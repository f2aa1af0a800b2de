#include "fovea/mapping/registration/local_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace fovea {
namespace {

/// The origin moves in steps (m) of a whole number of voxels: voxel borders stay in place. A long
/// step makes rebuilds rare.
constexpr double kOriginStep = 64;

Eigen::Vector3d origin_near(const Eigen::Vector3d& p_odom) {
  return (p_odom.array() / kOriginStep).round() * kOriginStep;
}

}  // namespace

LocalMap::LocalMap(const LocalMapOptions& options, std::optional<NormalOptions> normals)
    : options_(options),
      normals_(normals),
      voxels_(static_cast<float>(options.voxel)),
      target_{{}, {}, PointIndex({})} {
  if (normals_) normals_->spacing = options_.voxel;
}

auto LocalMap::next_of() {
  return [this](const VoxelQueues::Item& item) -> VoxelQueues::Item& {
    return keyframes_[item.scan - keyframes_.front().number].next[item.index];
  };
}

void LocalMap::add(std::vector<Eigen::Vector3f> points_lidar, const RigidMotion& T_odom_lidar) {
  if (keyframes_.size() == static_cast<std::size_t>(options_.max_keyframes)) remove_oldest();
  keyframes_.push_back({next_number_++, std::move(points_lidar), T_odom_lidar, {}, {}, {}});
  const Eigen::Vector3d origin = origin_near(T_odom_lidar.translation());
  // Without voxels the target cannot be updated point by point.
  if (origin != target_.origin_odom || keyframes_.size() == 1 || options_.voxel == 0) {
    rebuild(origin);
  } else {
    insert(keyframes_.back());
  }
  if (normals_) fit_normals();
}

void LocalMap::insert(Keyframe& keyframe) {
  const std::vector<Eigen::Vector3f>& source = keyframe.points_lidar;
  const Eigen::Matrix3f R = keyframe.T_odom_lidar.linear().cast<float>();
  const Eigen::Vector3f t =
      (keyframe.T_odom_lidar.translation() - target_.origin_odom).cast<float>();
  const std::size_t n = source.size();
  keyframe.points.resize(n);
  for (std::size_t i = 0; i < n; ++i) keyframe.points[i] = R * source[i] + t;
  keyframe.next.resize(n);
  keyframe.slot.assign(n, kNoSlot);
  const auto max_range2 = static_cast<float>(options_.max_range * options_.max_range);
  for (std::uint32_t i = 0; i < n; ++i) {
    if (source[i].squaredNorm() > max_range2) continue;
    const bool is_first =
        options_.voxel == 0 || voxels_.push(keyframe.points[i], {keyframe.number, i}, next_of());
    if (is_first) insert_target(keyframe, i);
  }
}

void LocalMap::insert_target(Keyframe& keyframe, std::uint32_t index) {
  RegistrationCloud& cloud = target_.cloud;
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<std::uint32_t>(cloud.points.size()));
    cloud.points.emplace_back();
    if (normals_) cloud.normals.emplace_back();
  }
  const std::uint32_t slot = keyframe.slot[index] = free_slots_.back();
  free_slots_.pop_back();
  cloud.points[slot] = keyframe.points[index];
  if (normals_) cloud.normals[slot].setZero();
  if (options_.voxel > 0) target_.index.insert(slot, cloud.points[slot]);
}

void LocalMap::remove_oldest() {
  const Keyframe& oldest = keyframes_.front();
  const std::size_t n = options_.voxel > 0 ? oldest.slot.size() : 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (oldest.slot[i] == kNoSlot) continue;
    const Eigen::Vector3f& p = oldest.points[i];
    target_.index.erase(oldest.slot[i], p);
    free_slots_.push_back(oldest.slot[i]);
    const std::optional<VoxelQueues::Item> successor = voxels_.pop(p, next_of());
    if (successor) insert_target(keyframes_[successor->scan - oldest.number], successor->index);
  }
  keyframes_.pop_front();
}

void LocalMap::fit_normals() {
  // Points in the order of scans. The order of slots would depend on removed scans.
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> slots, without_normal;
  points.reserve(size());
  slots.reserve(size());
  for (const Keyframe& keyframe : keyframes_) {
    for (std::size_t i = 0; i < keyframe.slot.size(); ++i) {
      const std::uint32_t slot = keyframe.slot[i];
      if (slot == kNoSlot) continue;
      if (target_.cloud.normals[slot].isZero(0)) {
        without_normal.push_back(static_cast<std::uint32_t>(points.size()));
      }
      points.push_back(keyframe.points[i]);
      slots.push_back(slot);
    }
  }
  const std::vector<Eigen::Vector3f> normals = estimate_normals(points, without_normal, *normals_);
  for (std::size_t k = 0; k < normals.size(); ++k) {
    target_.cloud.normals[slots[without_normal[k]]] = normals[k];
  }
}

void LocalMap::rebuild(const Eigen::Vector3d& origin_odom) {
  voxels_ = VoxelQueues(static_cast<float>(options_.voxel));
  free_slots_.clear();
  target_ = {origin_odom, {}, PointIndex({}, options_.voxel)};
  for (Keyframe& keyframe : keyframes_) insert(keyframe);
  if (options_.voxel == 0) target_.index = PointIndex(target_.cloud.points);
}

const LocalMap::Target& LocalMap::target() const {
  if (empty()) throw std::logic_error("the local map is empty");
  return target_;
}

VerticalFit vertical_fit(const LocalMap& map, const RegistrationCloud& source_lidar,
                         const RigidMotion& T_odom_lidar) {
  constexpr std::size_t kPoints = 1500;
  constexpr float kReach = 1, kOnSurface = 0.1f;  // m
  constexpr float kMaxNormalZ = 0.5f;             // of a vertical surface
  const LocalMap::Target& target = map.target();
  VerticalFit fit;
  if (target.cloud.normals.empty()) return fit;
  const RigidMotion T_origin_lidar = Eigen::Translation3d(-target.origin_odom) * T_odom_lidar;
  const Eigen::Vector3f ahead = T_odom_lidar.linear().col(0).cast<float>(),
                        left = T_odom_lidar.linear().col(1).cast<float>();
  const std::size_t step = std::max<std::size_t>(1, source_lidar.points.size() / kPoints);
  // Surfaces across and along the LiDAR's x axis.
  std::array<std::size_t, 2> points{}, fitting{};
  for (std::size_t i = 0; i < source_lidar.points.size(); i += step) {
    const Eigen::Vector3f p =
        (T_origin_lidar * source_lidar.points[i].cast<double>()).cast<float>();
    const Neighbor nearest = target.index.nearest(p, kReach);
    if (!std::isfinite(nearest.squared_distance)) continue;
    const Eigen::Vector3f& normal = target.cloud.normals[nearest.index];
    if (normal.isZero(0) || std::abs(normal.z()) > kMaxNormalZ) continue;
    const std::size_t kind = std::abs(normal.dot(ahead)) > std::abs(normal.dot(left)) ? 0 : 1;
    ++points[kind];
    const float away = normal.dot(p - target.cloud.points[nearest.index]);
    fitting[kind] += std::abs(away) < kOnSurface ? 1 : 0;
  }
  for (const std::size_t kind : {0, 1}) {
    if (points[kind] < VerticalFit::kLeastPoints) continue;
    const double share = double(fitting[kind]) / double(points[kind]);
    if (fit.points == 0 || share < fit.share) fit = {points[kind], share};
  }
  return fit;
}

RegistrationResult register_to(const LocalMap& map, const RegistrationCloud& source_lidar,
                               const RigidMotion& guess_T_odom_lidar,
                               const RegistrationOptions& options, std::optional<PosePrior> prior) {
  const LocalMap::Target& target = map.target();
  const Eigen::Translation3d T_origin_odom(-target.origin_odom);
  if (prior) prior->T_target_source = T_origin_odom * prior->T_target_source;
  RegistrationResult result = register_clouds(target.cloud, target.index, source_lidar,
                                              T_origin_odom * guess_T_odom_lidar, options, prior);
  result.T_target_source = T_origin_odom.inverse() * result.T_target_source;
  return result;
}

}  // namespace fovea
