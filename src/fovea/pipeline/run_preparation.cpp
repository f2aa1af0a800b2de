#include "fovea/pipeline/run_preparation.h"

#include "fovea/core/errors.h"
#include "fovea/pipeline/frame_motion.h"
#include "fovea/pipeline/stored_calibration.h"

namespace fovea {

bool has_known_motion(const DriveInfo& drive, const MapJob& job) {
  return drive.navigation.has_value() || !job.given_poses.empty();
}

bool has_sweep_motion(const DriveInfo& drive, const MapJob& job) {
  return job.settings.compensates_motion() && !drive.sweep_compensated;
}

namespace {

std::vector<CameraCalibration> estimated_calibration(const FrameSource& source, const MapJob& job) {
  CalibrationJob calibration;
  calibration.compensate = has_sweep_motion(source.info(), job);
  calibration.usable = [&](int index) { return !job.hold_out.contains(index); };
  calibration.motion = [&](int index) { return known_motion(source, job.given_poses, index); };
  calibration.stop = job.stop;
  return calibrate(source, calibration);
}

}  // namespace

std::vector<CameraCalibration> correct_calibration(const FrameSource& source, const MapJob& job,
                                                   DriveInfo& drive, MapMeta& meta) {
  if (!job.calibrate) return {};
  std::vector<CameraCalibration> correction = estimated_calibration(source, job);
  drive.calibration = corrected(drive.calibration, correction);
  store_calibration(correction, meta);
  return correction;
}

void require_sources(const DriveInfo& drive, const MapJob& job) {
  if (job.pose_source == PoseSource::kNavigation && !drive.navigation) {
    throw InputError("the drive has no navigation to take poses from", drive.path.string(),
                     "let registration find them (--poses refine)");
  }
  if (job.calibrate) require_cameras(drive, "calibration");
  if (job.settings.is_paper() && job.settings.paper().foveal_enabled) {
    require_cameras(drive, "the paper's method");
  }
  if (job.calibrate && !has_known_motion(drive, job)) {
    throw InputError("nothing says how the vehicle moves, which a calibration needs",
                     drive.path.string(), "give poses (--poses FILE) or map without --calibrate");
  }
}

}  // namespace fovea
