#include "fovea/evaluation/truth_poses.h"

#include <algorithm>
#include <numbers>

#include "fovea/errors.h"
#include "fovea/map/map_meta.h"

namespace fovea {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

void add_error(const RigidMotion& difference, PoseErrors& errors) {
  errors.position_m.push_back(static_cast<float>(difference.translation().norm()));
  errors.rotation_deg.push_back(static_cast<float>(kDegrees * rotation_angle(difference.linear())));
}

/// How far the map's motion from a to b is off the true one, seen from b.
RigidMotion motion_error(const PosePair& a, const PosePair& b) {
  const RigidMotion truth = a.T_true_lidar.inverse() * b.T_true_lidar;
  const RigidMotion map = a.T_map_lidar.inverse() * b.T_map_lidar;
  return truth.inverse() * map;
}

}  // namespace

std::vector<PosePair> pose_pairs(const std::vector<FrameRecord>& frames, const DriveTruth& truth) {
  std::vector<PosePair> pairs;
  for (const FrameRecord& record : frames) {
    if (record.status == FrameStatus::kSkipped) continue;
    if (record.index < 0 || record.index >= truth.frames()) continue;
    pairs.push_back({record.index, truth.T_local_lidar()[static_cast<std::size_t>(record.index)],
                     record.T_local_lidar});
  }
  if (pairs.empty()) {
    throw InputError("the truth knows none of the map's frames", truth.folder().string(),
                     "check that the map belongs to this drive");
  }
  return pairs;
}

std::optional<RigidMotion> georeference(const MapMeta& meta, const GeodeticPoint& truth_origin) {
  const std::optional<GeodeticPoint> origin = map_origin(meta);
  if (!origin) return std::nullopt;
  return LocalTangentPlane(truth_origin).T_local_enu(*origin);
}

RigidMotion align_trajectories(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();
  Eigen::Vector3d true_center = Eigen::Vector3d::Zero(), map_center = Eigen::Vector3d::Zero();
  for (const PosePair& pair : pairs) {
    rotations += pair.T_true_lidar.linear() * pair.T_map_lidar.linear().transpose();
    true_center += pair.T_true_lidar.translation();
    map_center += pair.T_map_lidar.translation();
  }
  RigidMotion T_true_map = RigidMotion::Identity();
  T_true_map.linear() = nearest_rotation(rotations);
  T_true_map.translation() =
      (true_center - T_true_map.linear() * map_center) / static_cast<double>(pairs.size());
  return T_true_map;
}

RigidMotion align_drives(const std::vector<PosePair>& pairs) {
  Eigen::Vector3d true_center = Eigen::Vector3d::Zero(), map_center = Eigen::Vector3d::Zero();
  for (const PosePair& pair : pairs) {
    true_center += pair.T_true_lidar.translation() / static_cast<double>(pairs.size());
    map_center += pair.T_map_lidar.translation() / static_cast<double>(pairs.size());
  }
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) {
    moments += pair.T_true_lidar.linear() * pair.T_map_lidar.linear().transpose() +
               (pair.T_true_lidar.translation() - true_center) *
                   (pair.T_map_lidar.translation() - map_center).transpose();
  }
  RigidMotion T_true_map = RigidMotion::Identity();
  T_true_map.linear() = nearest_rotation(moments);
  T_true_map.translation() = true_center - T_true_map.linear() * map_center;
  return T_true_map;
}

RigidMotion error_beside(const std::vector<PosePair>& map, const PosePair& pose) {
  const auto away = [&](const PosePair& other) {
    return (other.T_true_lidar.translation() - pose.T_true_lidar.translation()).squaredNorm();
  };
  return motion_error(
      *std::min_element(map.begin(), map.end(),
                        [&](const PosePair& a, const PosePair& b) { return away(a) < away(b); }),
      pose);
}

PoseErrors absolute_errors(const std::vector<PosePair>& pairs, const RigidMotion& T_true_map) {
  PoseErrors errors;
  for (const PosePair& pair : pairs) {
    add_error(pair.T_true_lidar.inverse() * T_true_map * pair.T_map_lidar, errors);
  }
  return errors;
}

PoseErrors relative_errors(const std::vector<PosePair>& pairs) {
  PoseErrors errors;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    if (pairs[i].frame != pairs[i - 1].frame + 1) continue;
    add_error(motion_error(pairs[i - 1], pairs[i]), errors);
  }
  return errors;
}

std::vector<float> drift_percent(const std::vector<PosePair>& pairs, double length) {
  std::vector<double> way(pairs.size(), 0);
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    way[i] = way[i - 1] +
             (pairs[i].T_true_lidar.translation() - pairs[i - 1].T_true_lidar.translation()).norm();
  }
  std::vector<float> percent;
  for (std::size_t i = 0, j = 0; i < pairs.size(); ++i) {
    while (j < pairs.size() && way[j] - way[i] < length) ++j;
    if (j == pairs.size()) break;
    const double error = motion_error(pairs[i], pairs[j]).translation().norm();
    percent.push_back(static_cast<float>(100 * error / (way[j] - way[i])));
  }
  return percent;
}

}  // namespace fovea
