#include "fovea/pipeline/run_preparation.h"

#include "fovea/errors.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/stored_calibration.h"

namespace fovea {

bool has_sweep_motion(const DriveInfo& drive, const MapJob& job) {
  return job.settings.compensates_motion() && !drive.sweep_compensated;
}

DriveCalibration correct_calibration(const FrameSource& source, const MapJob& job, DriveInfo& drive,
                                     MapMeta& meta) {
  if (!job.calibrate) return {};
  DriveCalibrationJob calibration;
  // The paper's mapper finds poses only while it maps.
  calibration.track.settings = job.settings.is_paper() ? load_preset("default") : job.settings;
  calibration.track.pose_source = job.pose_source;
  calibration.track.given_poses = job.given_poses;
  calibration.track.stop = job.stop;
  calibration.usable = [&](int index) { return !job.hold_out.contains(index); };
  DriveCalibration found = calibrate_drive(source.info(), calibration);
  drive = corrected(std::move(drive), found);
  store_calibration(found, meta);
  return found;
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
}

std::unique_ptr<MapWriter> open_output(const MapJob& job) {
  if (job.resume) return MapWriter::open(job.output);
  return MapWriter::create(job.output, job.force, job.scratch);
}

}  // namespace fovea
