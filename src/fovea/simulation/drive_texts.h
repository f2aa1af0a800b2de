// The texts of a KITTI raw drive: time stamps and calibration.
#pragma once

#include <string>

#include "fovea/simulation/rig.h"
#include "fovea/simulation/simulation_options.h"
#include "fovea/time.h"

namespace fovea {

/// Time of the stamp of a frame: 2026-01-01 12:00:00 UTC and so many sweeps.
TimeNs stamp_of(int frame, const SimulationOptions& options);

/// "2026-01-01 12:00:00.000000000" of a time since the Unix epoch.
std::string date_time_text(TimeNs time);

/// timestamps.txt of every frame's stamp.
/// @param sweeps  so many sweeps later: -0.5 and 0.5 for the LiDAR's timestamps_start and _end
std::string stamps_text(const SimulationOptions& options, double sweeps = 0);

/// The texts of calib_cam_to_cam.txt, calib_velo_to_cam.txt, calib_imu_to_velo.txt.
struct CalibrationTexts {
  std::string cam_to_cam, velo_to_cam, imu_to_velo;
};

/// @param rig  made from the options. Of KITTI's cameras 0 to 3 those that are not simulated get
/// lines,
///             too: other programs' readers insist on them.
CalibrationTexts calibration_texts(const Rig& rig, const SimulationOptions& options);

}  // namespace fovea
