#include "fovea/pipeline/drive_log.h"

#include <algorithm>
#include <stdexcept>

namespace fovea {
namespace {

/// Motion after which a pose is written again. Each new submap moves the thousands before it by
/// very little.
constexpr double kNoticeable = 1e-3;  // m, and a hundred times that in radians
/// Change of a gain after which a submap is written again, stops: less than a color code.
constexpr double kVisible = 1e-3;

bool has_moved(const RigidMotion& from, const RigidMotion& to, bool exact) {
  if (exact) return from.matrix() != to.matrix();
  return (from.translation() - to.translation()).norm() > kNoticeable ||
         (from.linear() - to.linear()).norm() > kNoticeable / 100;
}

SubmapRecord record_of(const Submap& submap) {
  SubmapRecord record;
  record.T_local_submap = submap.T_local_submap;
  if ((submap.log2_gain != 0).any()) record.log2_gain = submap.log2_gain.cast<double>().matrix();
  return record;
}

bool has_changed(const SubmapRecord& from, const SubmapRecord& to, bool exact) {
  if (has_moved(from.T_local_submap, to.T_local_submap, exact)) return true;
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Vector3d before = from.log2_gain.value_or(zero), now = to.log2_gain.value_or(zero);
  return exact ? before != now : (before - now).cwiseAbs().maxCoeff() > kVisible;
}

}  // namespace

void DriveLog::remember(const FrameRecord& record) {
  Frame frame{record.index, -1, record.T_odom_lidar, record.T_local_lidar};
  if (record.status != FrameStatus::kSkipped) {
    frame.submap = record.submap;
    const auto submap = static_cast<std::size_t>(record.submap);
    // A submap begins where its first frame is.
    if (submap == T_odom_submap_.size()) T_odom_submap_.push_back(record.T_odom_lidar);
  }
  frames_.push_back(frame);
}

void DriveLog::add(FrameRecord record) {
  remember(record);
  fresh_.push_back(std::move(record));
}

void DriveLog::add_stored(const FrameRecord& record) {
  if (!fresh_.empty()) throw std::logic_error("an earlier run's frame after those of this run");
  remember(record);
}

bool DriveLog::has_mapped() const {
  return std::any_of(frames_.begin(), frames_.end(),
                     [](const Frame& frame) { return frame.submap >= 0; });
}

std::vector<RigidMotion> DriveLog::poses(const TileMap& map) const {
  std::vector<RigidMotion> T_local_odom;  // by submap
  for (std::size_t id = 0; id < T_odom_submap_.size(); ++id) {
    const RigidMotion& T_local_submap = map.submaps().at(id).T_local_submap;
    // An unmoved pose stays bit-identical, so that given poses are returned unchanged.
    const bool stays = T_local_submap.matrix() == T_odom_submap_[id].matrix();
    T_local_odom.push_back(stays ? RigidMotion::Identity()
                                 : T_local_submap * T_odom_submap_[id].inverse());
  }
  std::vector<RigidMotion> poses;
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const Frame& frame = frames_[i];
    if (frame.submap < 0) {
      poses.push_back(frame.T_local_lidar);
      continue;
    }
    known.push_back(i);
    poses.push_back(T_local_odom[std::size_t(frame.submap)] * frame.T_odom_lidar);
  }
  if (known.empty()) return poses;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (frames_[i].submap >= 0) continue;
    if (known.size() == 1) {
      poses[i] = poses[known.front()];
      continue;
    }
    const auto after = std::upper_bound(known.begin() + 1, known.end() - 1, i);
    const std::size_t a = *(after - 1), b = *after;
    poses[i] = interpolate(
        poses[a], poses[b],
        double(frames_[i].index - frames_[a].index) / (frames_[b].index - frames_[a].index));
  }
  return poses;
}

MapRows DriveLog::rows(const TileMap& map, bool exact) {
  MapRows rows;
  const std::vector<RigidMotion> T_local_lidar = poses(map);
  const std::size_t stored = frames_.size() - fresh_.size();
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    Frame& frame = frames_[i];
    if (i >= stored) {
      fresh_[i - stored].T_local_lidar = T_local_lidar[i];
    } else if (has_moved(frame.T_local_lidar, T_local_lidar[i], exact)) {
      rows.poses.emplace_back(frame.index, T_local_lidar[i]);
    } else {
      continue;
    }
    frame.T_local_lidar = T_local_lidar[i];
  }
  rows.frames = std::exchange(fresh_, {});
  for (std::size_t id = 0; id < map.submaps().size(); ++id) {
    const SubmapRecord submap = record_of(map.submaps()[id]);
    if (id == submaps_.size()) {
      submaps_.push_back(submap);
    } else if (has_changed(submaps_[id], submap, exact)) {
      submaps_[id] = submap;
    } else {
      continue;
    }
    rows.submaps.emplace_back(id, submap);
  }
  return rows;
}

}  // namespace fovea
