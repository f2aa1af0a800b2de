#include "fovea/mapping/registration/local_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "fovea/base/errors.h"

namespace fovea {
namespace {

/// The origin moves in steps of this (m): a whole number of any voxels that divide it, and seldom.
constexpr double kOriginStep = 64;
/// How many points ahead of the one at hand voxels are fetched: all of them are megabytes.
constexpr std::size_t kAhead = 8;

Eigen::Vector3d origin_near(const Eigen::Vector3d& p_local) {
  return (p_local.array() / kOriginStep).round() * kOriginStep;
}

}  // namespace

void LocalMapOptions::validate() const {
  const auto reject = [](const char* what, const char* field, const char* remedy) {
    throw ConfigError(what, field, remedy);
  };
  if (max_keyframes < 1 || max_keyframes > 1000) {
    reject("a number of scans is out of range", "local_map.max_keyframes", "give 1 to 1000");
  }
  if (!(keyframe_distance >= 0 && keyframe_distance <= 1000)) {
    reject("a distance is out of range", "local_map.keyframe_distance",
           "give 0 (every scan) or metres up to 1000");
  }
  if (!(keyframe_rotation > 0 && keyframe_rotation <= std::numbers::pi)) {
    reject("an angle is out of range", "local_map.keyframe_rotation",
           "give degrees above 0 and up to 180");
  }
  if (!(keyframe_overlap >= 0 && keyframe_overlap <= 1)) {
    reject("a share is out of range", "local_map.keyframe_overlap", "give 0 (off) to 1");
  }
  if (!(max_range > 0 && max_range <= 1000)) {
    reject("a range is out of range", "local_map.max_range", "give metres above 0 and up to 1000");
  }
  if (!(voxel == 0 || (voxel >= 0.01 && voxel <= 10))) {
    reject("a voxel size is out of range", "local_map.voxel",
           "give 0 (off) or metres from 0.01 to 10");
  }
}

LocalMap::LocalMap(const LocalMapOptions& options, std::optional<NormalOptions> normals)
    : options_(options),
      normals_(normals),
      voxels_(static_cast<float>(options.voxel)),
      target_{{}, {}, PointIndex({})} {
  options_.validate();
  if (normals_) normals_->spacing = options_.voxel;
}

auto LocalMap::next_of() {
  return [this](const VoxelQueues::Item& item) -> VoxelQueues::Item& {
    return keyframes_[item.owner - keyframes_.front().number].next[item.index];
  };
}

void LocalMap::add(std::vector<Eigen::Vector3f> points_lidar, const RigidMotion& T_local_lidar) {
  if (keyframes_.size() == static_cast<std::size_t>(options_.max_keyframes)) forget_oldest();
  keyframes_.push_back({next_number_++, std::move(points_lidar), T_local_lidar, {}, {}, {}});
  const Eigen::Vector3d origin = origin_near(T_local_lidar.translation());
  // Without voxels nothing tells which points to keep up to date.
  if (origin != target_.origin_local || keyframes_.size() == 1 || options_.voxel == 0) {
    start_at(origin);
  } else {
    place(keyframes_.back());
  }
  if (normals_) find_planes();
}

void LocalMap::place(Keyframe& keyframe) {
  const std::vector<Eigen::Vector3f>& source = keyframe.points_lidar;
  const Eigen::Matrix3f R = keyframe.T_local_lidar.linear().cast<float>();
  const Eigen::Vector3f t =
      (keyframe.T_local_lidar.translation() - target_.origin_local).cast<float>();
  const std::size_t n = source.size();
  keyframe.points.resize(n);
  for (std::size_t i = 0; i < n; ++i) keyframe.points[i] = R * source[i] + t;
  keyframe.next.resize(n);
  keyframe.place.assign(n, kNoPlace);
  const auto max_range2 = static_cast<float>(options_.max_range * options_.max_range);
  for (std::uint32_t i = 0; i < n; ++i) {
    if (i + kAhead < n) voxels_.prefetch(keyframe.points[i + kAhead]);
    if (source[i].squaredNorm() > max_range2) continue;
    const bool is_first =
        options_.voxel == 0 || voxels_.push(keyframe.points[i], {keyframe.number, i}, next_of());
    if (is_first) stand(keyframe, i);
  }
}

void LocalMap::stand(Keyframe& keyframe, std::uint32_t index) {
  RegistrationCloud& cloud = target_.cloud;
  if (empty_.empty()) {
    empty_.push_back(static_cast<std::uint32_t>(cloud.points.size()));
    cloud.points.emplace_back();
    if (normals_) cloud.normals.emplace_back();
  }
  const std::uint32_t place = keyframe.place[index] = empty_.back();
  empty_.pop_back();
  cloud.points[place] = keyframe.points[index];
  if (normals_) cloud.normals[place].setZero();
  if (options_.voxel > 0) target_.index.insert(place, cloud.points[place]);
}

void LocalMap::forget_oldest() {
  const Keyframe& oldest = keyframes_.front();
  const std::size_t n = options_.voxel > 0 ? oldest.place.size() : 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (i + kAhead < n) voxels_.prefetch(oldest.points[i + kAhead]);
    if (oldest.place[i] == kNoPlace) continue;  // a second one in its voxel
    const Eigen::Vector3f& p = oldest.points[i];
    target_.index.erase(oldest.place[i], p);
    empty_.push_back(oldest.place[i]);
    const VoxelQueues::Item heir = voxels_.pop(p, next_of());
    if (heir.owner == VoxelQueues::kNobody) continue;
    stand(keyframes_[heir.owner - oldest.number], heir.index);
  }
  keyframes_.pop_front();
}

void LocalMap::find_planes() {
  // In the order of scans: the order of places depends on scans that are gone.
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> places, without_plane;
  points.reserve(size());
  places.reserve(size());
  for (const Keyframe& keyframe : keyframes_) {
    for (std::size_t i = 0; i < keyframe.place.size(); ++i) {
      const std::uint32_t place = keyframe.place[i];
      if (place == kNoPlace) continue;
      if (target_.cloud.normals[place].isZero(0)) {
        without_plane.push_back(static_cast<std::uint32_t>(points.size()));
      }
      points.push_back(keyframe.points[i]);
      places.push_back(place);
    }
  }
  const std::vector<Eigen::Vector3f> normals = estimate_normals(points, without_plane, *normals_);
  for (std::size_t k = 0; k < normals.size(); ++k) {
    target_.cloud.normals[places[without_plane[k]]] = normals[k];
  }
}

void LocalMap::start_at(const Eigen::Vector3d& origin_local) {
  voxels_ = VoxelQueues(static_cast<float>(options_.voxel));
  empty_.clear();
  target_ = {origin_local, {}, PointIndex({}, options_.voxel)};
  for (Keyframe& keyframe : keyframes_) place(keyframe);
  if (options_.voxel == 0) target_.index = PointIndex(target_.cloud.points);
}

const LocalMap::Target& LocalMap::target() const {
  if (empty()) throw std::logic_error("the local map is empty");
  return target_;
}

VerticalFit vertical_fit(const LocalMap& map, const RegistrationCloud& source_lidar,
                         const RigidMotion& T_local_lidar) {
  constexpr std::size_t kPoints = 1500;
  constexpr float kReach = 1, kOnSurface = 0.1f;  // m
  constexpr float kUpright = 0.5f;                // most of a vertical surface's normal along z
  const LocalMap::Target& target = map.target();
  VerticalFit fit;
  if (target.cloud.normals.empty()) return fit;
  const RigidMotion T_origin_lidar = Eigen::Translation3d(-target.origin_local) * T_local_lidar;
  const Eigen::Vector3f ahead = T_local_lidar.linear().col(0).cast<float>(),
                        left = T_local_lidar.linear().col(1).cast<float>();
  const std::size_t step = std::max<std::size_t>(1, source_lidar.points.size() / kPoints);
  std::array<std::size_t, 2> points{},
      fitting{};  // of surfaces across and along the LiDAR's x axis
  for (std::size_t i = 0; i < source_lidar.points.size(); i += step) {
    const Eigen::Vector3f p =
        (T_origin_lidar * source_lidar.points[i].cast<double>()).cast<float>();
    const Neighbor nearest = target.index.nearest(p, kReach);
    if (!std::isfinite(nearest.squared_distance)) continue;
    const Eigen::Vector3f& normal = target.cloud.normals[nearest.index];
    if (normal.isZero(0) || std::abs(normal.z()) > kUpright) continue;
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
                               const RigidMotion& guess_T_local_lidar,
                               const RegistrationOptions& options, std::optional<PosePrior> prior) {
  const LocalMap::Target& target = map.target();
  const Eigen::Translation3d T_origin_local(-target.origin_local);
  if (prior) prior->T_target_source = T_origin_local * prior->T_target_source;
  RegistrationResult result = register_clouds(target.cloud, target.index, source_lidar,
                                              T_origin_local * guess_T_local_lidar, options, prior);
  result.T_target_source = T_origin_local.inverse() * result.T_target_source;
  return result;
}

}  // namespace fovea
