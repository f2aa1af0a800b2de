#include "fovea/pipeline/scan_track.h"

#include "fovea/core/parallel.h"
#include "fovea/geometry/rotation_vector.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/frame_pipeline.h"
#include "fovea/pipeline/frame_reader.h"
#include "fovea/pipeline/initial_motion.h"
#include "fovea/pipeline/make_mapper.h"

namespace fovea {
namespace {

bool is_firm(const TrackingStats& tracking) {
  if (!tracking.registration) return true;
  const std::optional<AlignmentStats>& alignment = tracking.registration->alignment;
  return alignment && !alignment->has_failed && alignment->degenerate_directions == 0;
}

}  // namespace

std::vector<TrackedPose> track_scans(const FrameSource& source, const ScanTrackJob& job) {
  const DriveInfo drive = info_with_lidars(source);
  MapperServices services;
  services.initial_velocity = [&](int frame) {
    return initial_velocity(source, job.given_poses, frame, job.settings.compensates_motion());
  };
  const auto mapper = make_mapper(drive, job.settings, job.pose_source, std::move(services));
  FrameReader reader(source, drive.frame_indices(), /*rate=*/0);
  const auto track = [&](const Frame& frame) {
    FrameTask task;
    const auto place = std::size_t(frame.index - drive.begin);
    if (place < job.given_poses.size()) task.given_pose = job.given_poses[place];
    return mapper->track(frame, task);
  };
  FramePipeline frames({.read = [&](const std::stop_token& stop) { return reader.next(stop); },
                        .track = track,
                        .apply_deferred = [&] { mapper->apply_deferred_tracking(); }},
                       available_threads() > 1, job.stop);
  std::vector<TrackedPose> poses;
  int done = 0;
  while (const std::optional<TrackedFrame> tracked = frames.next()) {
    job.progress(++done, int(drive.frame_count()));
    if (!tracked->tracked) continue;
    const FrameResult& result = tracked->tracked->result;
    if (result.tracking.is_pose_unknown || result.tracking.is_lost) continue;
    const Frame& frame = std::get<Frame>(tracked->read.result);
    poses.push_back({frame.index, frame.stamp, result.poses.T_odom_lidar,
                     result.poses.motion.value_or(SweepMotion{}), is_firm(result.tracking)});
  }
  return poses;
}

std::vector<ScanTurn> turns_of(const std::vector<TrackedPose>& poses) {
  constexpr TimeNs kLongestTurn = kNsPerSecond / 2;
  std::vector<ScanTurn> turns;
  turns.reserve(poses.size());
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const TrackedPose &before = poses[i - 1], &after = poses[i];
    if (!after.is_firm || after.stamp - before.stamp > kLongestTurn) continue;
    const RigidMotion turn = before.T_odom_lidar.inverse() * after.T_odom_lidar;
    turns.push_back({before.stamp, after.stamp, rotation_vector(turn.linear())});
  }
  return turns;
}

}  // namespace fovea
