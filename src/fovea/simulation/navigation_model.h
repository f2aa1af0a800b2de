// GPS/INS records as KITTI's OXTS unit would have written them.
#pragma once

#include <string>
#include <vector>

#include "fovea/base/time.h"
#include "fovea/simulation/vehicle_motion.h"

namespace fovea {

struct NavigationRecord {
  TimeNs time = 0;   ///< on the drive's clock
  std::string text;  ///< the 30 fields, one line
};

/// One record a frame, of the time at which it was taken (its scan's stamp and a delay). Errors
/// come from the seed: a constant bias, random walks of position and angles, white noise, GPS
/// jumps, outages.
/// @param T_world_local  the truth's local frame in the world (a translation)
std::vector<NavigationRecord> simulate_navigation(const VehicleMotion& motion, const Rig& rig,
                                                  const RigidMotion& T_world_local,
                                                  const SimulationOptions& options);

/// Time of the stamp of a frame.
TimeNs stamp_of(int frame, const SimulationOptions& options);
/// "2026-01-01 12:00:00.000000000" of a time.
std::string date_time_text(TimeNs time);

/// The texts of calib_cam_to_cam.txt, calib_velo_to_cam.txt, calib_imu_to_velo.txt.
struct CalibrationTexts {
  std::string cam_to_cam, velo_to_cam, imu_to_velo;
};
CalibrationTexts calibration_texts(const Rig& rig, const SimulationOptions& options);

}  // namespace fovea
