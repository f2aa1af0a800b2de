#include "fovea/pipeline/drive_calibration.h"

#include <algorithm>
#include <cmath>

#include "fovea/core/angle.h"
#include "fovea/core/parallel.h"
#include "fovea/deskew.h"
#include "fovea/drive/recalibrated_source.h"
#include "fovea/errors.h"
#include "fovea/geometry/rotation_vector.h"
#include "fovea/mapping/calibration/extrinsic_estimate.h"
#include "fovea/pipeline/scan_edges.h"

namespace fovea {
namespace {

constexpr int kMaxTracked = 1200;                  // frames, from the first one: two minutes
constexpr std::size_t kFrames = 60;                // with images
constexpr std::size_t kGroup = 3, kGroupStep = 3;  // frames of one place, and from one to the next
constexpr double kMostPixels = 6e7, kFewestFrames = 18;  // of all images of a camera
constexpr std::size_t kSurfacePoints = 6000;
constexpr float kMinSurfaceRange = 2;
constexpr int kImuPasses = 6;
constexpr double kSettledRotation = 0.02 * kDegree, kSettledDelay = 0.0002;  // rad, s

/// The drive with one camera, or with none.
std::unique_ptr<FrameSource> reopened(const DriveInfo& drive, std::vector<int> cameras) {
  DriveOptions options;
  options.begin = drive.begin;
  const std::vector<int> frames = drive.frame_indices();
  options.end = frames.size() > kMaxTracked ? frames[kMaxTracked] : drive.end;
  options.use_navigation = drive.navigation.has_value();
  options.use_imu = false;  // its calibration is not known yet
  options.use_images = !cameras.empty();
  options.cameras = std::move(cameras);
  return open_drive(drive.path, options);
}

/// Up to kFrames of the poses, in groups of neighbors spread over the drive.
std::vector<TrackedPose> chosen(const std::vector<TrackedPose>& poses,
                                const std::function<bool(int)>& usable) {
  std::vector<TrackedPose> all;
  for (const TrackedPose& pose : poses) {
    if (usable(pose.frame)) all.push_back(pose);
  }
  if (all.size() <= kFrames) return all;
  constexpr std::size_t kGroups = kFrames / kGroup, kSpan = (kGroup - 1) * kGroupStep + 1;
  std::vector<TrackedPose> result;
  std::size_t next = 0;
  for (std::size_t g = 0; g < kGroups; ++g) {
    const std::size_t first = g * (all.size() - kSpan) / (kGroups - 1);
    for (std::size_t k = 0; k < kGroup; ++k) {
      const std::size_t i = first + k * kGroupStep;
      if (i < next) continue;
      result.push_back(all[i]);
      next = i + 1;
    }
  }
  return result;
}

/// Fewer frames of large images, in groups of neighbors: their smoothed copies are in memory, too.
std::vector<TrackedPose> frames_within_memory(const std::vector<TrackedPose>& frames,
                                              const DriveInfo& drive) {
  const Camera& camera = drive.calibration.cameras.front();
  const double pixels = double(camera.width) * double(camera.height);
  const auto most = std::size_t(std::clamp(kMostPixels / pixels, kFewestFrames, double(kFrames)));
  if (frames.size() <= most) return frames;
  const std::size_t step = (frames.size() + most - 1) / most;
  std::vector<TrackedPose> fewer;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i / kGroup % step == 0) fewer.push_back(frames[i]);
  }
  return fewer;
}

/// Points in the view and its surroundings.
std::vector<Eigen::Vector3f> surface_points(const PointCloud& scan_lidar, const Camera& camera) {
  const Eigen::Isometry3f T_cam_lidar = camera.T_cam_lidar.cast<float>();
  const float right = static_cast<float>(camera.width / camera.fx),
              down = static_cast<float>(camera.height / camera.fy);
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3f& p_lidar : scan_lidar.position) {
    const Eigen::Vector3f p = T_cam_lidar * p_lidar;
    if (p.z() < kMinSurfaceRange || p.norm() > float(kMaxEdgeRange)) continue;
    if (std::abs(p.x()) > right * p.z() || std::abs(p.y()) > down * p.z()) continue;
    points.push_back(p_lidar);
  }
  const std::size_t stride = 1 + points.size() / kSurfacePoints;
  std::vector<Eigen::Vector3f> few;
  for (std::size_t i = 0; i < points.size(); i += stride) few.push_back(points[i]);
  return few;
}

/// Frames with images of one camera, ready for an estimate.
std::vector<CalibrationView> calibration_views(const FrameSource& source, std::size_t slot,
                                               const std::vector<TrackedPose>& poses,
                                               const ImageMask* mask, bool compensate) {
  const DriveInfo& drive = source.info();
  const Camera& camera = drive.calibration.cameras.at(slot);
  std::vector<CalibrationView> views(poses.size());
  parallel_for(poses.size(), 1, [&](std::size_t i) {
    LoadedFrame loaded = source.load(poses[i].frame);
    if (!std::holds_alternative<Frame>(loaded)) return;
    Frame& frame = std::get<Frame>(loaded);
    if (frame.images.at(slot).empty()) return;
    const auto motion = compensate ? std::optional(poses[i].motion) : std::nullopt;
    CalibrationView& view = views[i];
    view = {.frame = frame.index,
            .stamp = frame.stamp,
            .image_offset = drive.image_offset(slot, frame.index),
            .image = std::move(frame.images[slot]),
            .mask = mask,
            .edges_lidar = scan_edges(frame.scan, camera, drive, motion),
            .surface_lidar = {}};
    if (motion) compensate_sweep(frame.scan, *motion, drive.sweep);
    view.surface_lidar = surface_points(frame.scan, camera);
  });
  std::erase_if(views, [](const CalibrationView& view) { return view.image.empty(); });
  return views;
}

PoseSpline spline_through(const std::vector<TrackedPose>& poses) {
  std::vector<StampedPose> stamped;
  stamped.reserve(poses.size());
  for (const TrackedPose& pose : poses) stamped.push_back({pose.stamp, pose.T_odom_lidar});
  return PoseSpline(std::move(stamped));
}

std::vector<OverlayPoint> overlay_points(const CalibrationView& view, const Camera& camera,
                                         const PoseSpline& T_local_lidar) {
  std::vector<OverlayPoint> points;
  const auto moment = image_moment(view, camera.image_delay, T_local_lidar);
  if (!moment) return points;
  const RigidMotion T_cam_stamp = camera.T_cam_lidar * moment->T_image_stamp;
  const auto add = [&](const Eigen::Vector3f& p_lidar, bool is_edge) {
    const Eigen::Vector3d p_cam = T_cam_stamp * p_lidar.cast<double>();
    const auto pixel = camera.project(p_cam);
    if (!pixel || !camera.in_view(*pixel)) return;
    points.push_back({float(pixel->x()), float(pixel->y()), float(p_cam.norm()), is_edge});
  };
  for (const Eigen::Vector3f& p_lidar : view.surface_lidar) add(p_lidar, false);
  for (const LidarEdges& edges_lidar : view.edges_lidar) {
    for (const Eigen::Vector3f& p_lidar : edges_lidar.inside.position) add(p_lidar, true);
  }
  return points;
}

/// Of views spread over the drive.
std::vector<CalibrationOverlay> overlays_of(const std::vector<CalibrationView>& views,
                                            const Camera& given, const Camera& right,
                                            const PoseSpline& T_local_lidar, int count) {
  std::vector<CalibrationOverlay> overlays;
  for (int k = 0; k < count && !views.empty(); ++k) {
    const std::size_t i = std::size_t(2 * k + 1) * views.size() / std::size_t(2 * count);
    const CalibrationView& view = views[i];
    if (!overlays.empty() && overlays.back().frame == view.frame) continue;
    overlays.push_back({view.frame, view.image, overlay_points(view, given, T_local_lidar),
                        overlay_points(view, right, T_local_lidar)});
  }
  return overlays;
}

CameraCalibration calibrated_camera(const DriveInfo& drive, int number,
                                    const std::vector<TrackedPose>& frames,
                                    const PoseSpline& T_local_lidar,
                                    const DriveCalibrationJob& job) {
  const auto source = reopened(drive, {number});
  const bool compensate = job.track.settings.compensates_motion() && !drive.sweep_compensated;
  const std::vector<CalibrationView> views = calibration_views(
      *source, 0, frames_within_memory(frames, source->info()), drive.mask(number), compensate);
  const Camera& given = source->info().calibration.cameras.front();
  CameraCalibration result{number, estimate_extrinsics(views, given, T_local_lidar)};
  const Camera right = corrected(given, result.estimate.correction);
  if (result.estimate.is_any_observable()) {
    result.lens = check_lens(profiles_of_views(views, right, T_local_lidar), right);
  }
  result.overlays = overlays_of(views, given, right, T_local_lidar, job.overlays);
  return result;
}

/// The IMU under a correction.
ImuData corrected(const ImuData& imu, const ImuHandEye& found) {
  ImuData right = imu;
  right.T_lidar_imu.linear() = rotation_of(found.rotation) * right.T_lidar_imu.linear();
  for (ImuSample& sample : right.samples) sample.time += from_seconds(found.delay);
  return right;
}

/// Estimates from scans that are tracked without the IMU, then with the IMU as estimated: turns
/// within a sweep distort scans, which the IMU alone undoes.
/// @param poses  without the IMU; returns those with it
ImuHandEye calibrated_imu(const DriveInfo& drive, const ScanTrackJob& job,
                          std::vector<TrackedPose>& poses) {
  const ImuData& given = *drive.imu;
  const std::vector<TrackedPose> without_imu = poses;
  ImuHandEye found =
      estimate_imu_hand_eye(turns_of(poses), given.samples, given.T_lidar_imu.linear());
  for (int pass = 0; pass < kImuPasses; ++pass) {
    if (!found.agrees || job.stop.stop_requested()) break;
    std::unique_ptr<FrameSource> scans = reopened(drive, {});
    DriveInfo with_imu = scans->info();
    with_imu.imu = corrected(given, found);
    with_imu.wheels = drive.wheels;
    poses = track_scans(RecalibratedSource(std::move(scans), std::move(with_imu)), job);
    const ImuHandEye before = found;
    found = estimate_imu_hand_eye(turns_of(poses), given.samples, given.T_lidar_imu.linear());
    if ((found.rotation - before.rotation).norm() < kSettledRotation &&
        std::abs(found.delay - before.delay) < kSettledDelay) {
      break;
    }
  }
  if (!found.agrees) poses = without_imu;
  return found;
}

}  // namespace

DriveCalibration calibrate_drive(const DriveInfo& drive, const DriveCalibrationJob& job) {
  DriveCalibration result;
  std::vector<TrackedPose> poses = track_scans(*reopened(drive, {}), job.track);
  if (poses.empty() && !job.track.stop.stop_requested()) {
    throw InputError("no frame could be tracked", drive.path.string(),
                     "check that the drive has scans for the frames asked for");
  }
  if (drive.imu) result.imu = calibrated_imu(drive, job.track, poses);
  result.frames = poses.size();
  const PoseSpline T_local_lidar = spline_through(poses);
  const std::vector<TrackedPose> frames = chosen(poses, job.usable);
  for (const Camera& camera : drive.calibration.cameras) {
    if (job.track.stop.stop_requested()) break;
    result.cameras.push_back(calibrated_camera(drive, camera.index, frames, T_local_lidar, job));
  }
  return result;
}

DriveInfo corrected(DriveInfo drive, const DriveCalibration& found) {
  for (std::size_t k = 0; k < found.cameras.size(); ++k) {
    Camera& camera = drive.calibration.cameras.at(k);
    camera = corrected(camera, found.cameras[k].estimate.correction);
  }
  if (drive.imu && found.imu) drive.imu = corrected(*drive.imu, *found.imu);
  return drive;
}

DriveCorrection correction_of(const DriveInfo& drive, const DriveCalibration& found) {
  DriveCorrection correction;
  const DriveInfo right = corrected(drive, found);
  for (std::size_t k = 0; k < found.cameras.size(); ++k) {
    const Camera& camera = right.calibration.cameras.at(k);
    correction.cameras.push_back(
        {camera.index, camera.T_cam_lidar, found.cameras[k].estimate.correction.delay});
  }
  if (right.imu && found.imu) correction.imu = {right.imu->T_lidar_imu, found.imu->delay};
  return correction;
}

}  // namespace fovea
