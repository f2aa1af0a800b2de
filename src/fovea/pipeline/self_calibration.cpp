#include "fovea/pipeline/self_calibration.h"

#include <algorithm>

#include "fovea/core/parallel.h"
#include "fovea/drive/motion_compensation.h"
#include "fovea/drive/scans/sensor_scans.h"
#include "fovea/geometry/transform_cloud.h"

namespace fovea {
namespace {

constexpr double kMaxRange = 40;  // m: beyond it the spacing of beams exceeds most objects
constexpr int kCalibrationFrames = 60, kPasses = 2;

std::vector<EdgeProfile> profiles_of(const Frame& frame, std::size_t slot, const Camera& camera,
                                     const DriveInfo& drive, bool compensate,
                                     const FrameMotion& motion) {
  if (frame.images.at(slot).empty()) return {};
  std::vector<EdgeProfile> profiles;
  for (LidarEdges& edges_lidar : edges_by_lidar(frame.scan, camera, drive, kMaxRange)) {
    if (compensate) {
      compensate_sweep(edges_lidar.inside, motion.sweep, drive.sweep);
      compensate_sweep(edges_lidar.outside, motion.sweep, drive.sweep);
    }
    const std::vector<EdgeProfile> of_lidar =
        edge_profiles(edges_lidar, frame.images.at(slot),
                      {camera, motion.sweep.velocity, motion.T_local_lidar, frame.index});
    profiles.insert(profiles.end(), of_lidar.begin(), of_lidar.end());
  }
  return profiles;
}

/// Up to kCalibrationFrames of the usable frames, spread evenly.
std::vector<int> chosen_frames(const DriveInfo& drive, const CalibrationJob& job) {
  std::vector<int> usable;
  for (const int index : drive.frame_indices()) {
    if (job.usable(index)) usable.push_back(index);
  }
  if (usable.size() <= std::size_t(kCalibrationFrames)) return usable;
  std::vector<int> chosen;
  for (std::size_t i = 0; i < std::size_t(kCalibrationFrames); ++i) {
    chosen.push_back(usable[(2 * i + 1) * usable.size() / (2 * std::size_t(kCalibrationFrames))]);
  }
  return chosen;
}

/// Profiles of all chosen frames by camera, in the order of frames at any number of threads.
std::vector<std::vector<EdgeProfile>> gather(const FrameSource& source, const CalibrationJob& job,
                                             const std::vector<int>& frames,
                                             const std::vector<Camera>& cameras) {
  using ByCamera = std::vector<std::vector<EdgeProfile>>;
  std::vector<ByCamera> by_frame(frames.size(), ByCamera(cameras.size()));
  parallel_for(frames.size(), 1, [&](std::size_t i) {
    if (job.stop.stop_requested()) return;
    const std::optional<FrameMotion> motion = job.motion(frames[i]);
    if (!motion) return;
    const LoadedFrame loaded = source.load(frames[i]);
    if (!std::holds_alternative<Frame>(loaded)) return;
    const Frame& frame = std::get<Frame>(loaded);
    for (std::size_t k = 0; k < cameras.size(); ++k) {
      Camera camera = cameras[k];
      camera.image_delay += source.info().image_offset(k, frame.index);
      by_frame[i][k] = profiles_of(frame, k, camera, source.info(), job.compensate, *motion);
    }
  });
  ByCamera all(cameras.size());
  for (const ByCamera& of_frame : by_frame) {
    for (std::size_t k = 0; k < cameras.size(); ++k) {
      all[k].insert(all[k].end(), of_frame[k].begin(), of_frame[k].end());
    }
  }
  return all;
}

/// Combines the first estimate with the second, which started from it.
CalibrationEstimate joined(const CalibrationEstimate& first, CalibrationEstimate second) {
  const auto rotation = [](const CalibrationEstimate& e) {
    return exp_se3((Twist() << e.rotation, 0, 0, 0).finished());
  };
  second.rotation = log_se3(rotation(second) * rotation(first)).head<3>();
  second.delay += first.delay;
  second.pixels = first.pixels;
  second.pixels_sigma = first.pixels_sigma;
  return second;
}

}  // namespace

std::vector<LidarEdges> edges_by_lidar(const PointCloud& scan_lidar, const Camera& camera,
                                       const DriveInfo& drive, double max_range) {
  if (drive.lidars.size() < 2) return {find_lidar_edges(scan_lidar, camera, max_range)};
  std::vector<LidarEdges> edges_lidar;
  const std::vector<PointCloud> scans = scans_by_sensor(scan_lidar, drive.lidars);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const RigidMotion& T_lidar_sensor = drive.lidars[k].T_lidar_sensor;
    Camera at_sensor = camera;
    at_sensor.T_cam_lidar = camera.T_cam_lidar * T_lidar_sensor;
    LidarEdges& edges = edges_lidar.emplace_back(find_lidar_edges(scans[k], at_sensor, max_range));
    edges.inside = transform_cloud(std::move(edges.inside), T_lidar_sensor);
    edges.outside = transform_cloud(std::move(edges.outside), T_lidar_sensor);
  }
  return edges_lidar;
}

CalibrationCheck::CalibrationCheck(const DriveInfo& drive, bool compensate)
    : drive_(drive),
      compensate_(compensate),
      stride_(std::max(kMinStride, (int(drive.frame_count()) + kFrames - 1) / kFrames)),
      next_(drive.begin + stride_ / 2),
      profiles_(drive.calibration.cameras.size()) {}

void CalibrationCheck::add(const Frame& frame, const FrameMotion& motion) {
  next_ = frame.index + stride_;
  for (std::size_t k = 0; k < profiles_.size(); ++k) {
    const auto profiles =
        profiles_of(frame, k, drive_.camera_at(k, frame.index), drive_, compensate_, motion);
    profiles_[k].insert(profiles_[k].end(), profiles.begin(), profiles.end());
  }
}

std::vector<CameraCalibration> CalibrationCheck::estimates() const {
  std::vector<CameraCalibration> found;
  for (std::size_t k = 0; k < profiles_.size(); ++k) {
    found.push_back({drive_.calibration.cameras[k].index, estimate_calibration(profiles_[k])});
  }
  return found;
}

std::vector<CameraCalibration> calibrate(const FrameSource& source, const CalibrationJob& job) {
  std::vector<Camera> cameras = source.info().calibration.cameras;
  const std::vector<int> frames = chosen_frames(source.info(), job);
  std::vector<CameraCalibration> found(cameras.size());
  for (int pass = 0; pass < kPasses; ++pass) {
    const auto profiles = gather(source, job, frames, cameras);
    for (std::size_t k = 0; k < cameras.size(); ++k) {
      const CalibrationEstimate estimate = estimate_calibration(profiles[k]);
      cameras[k] = fovea::corrected(cameras[k], estimate);
      found[k] = {cameras[k].index, pass == 0 ? estimate : joined(found[k].estimate, estimate)};
    }
  }
  return found;
}

Calibration corrected(const Calibration& calibration, const std::vector<CameraCalibration>& found) {
  Calibration right = calibration;
  for (std::size_t k = 0; k < found.size(); ++k) {
    right.cameras.at(k) = fovea::corrected(right.cameras.at(k), found[k].estimate);
  }
  return right;
}

}  // namespace fovea
