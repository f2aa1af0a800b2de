#include "app/localization_truth.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "app/map_arguments.h"
#include "app/print.h"
#include "fovea/errors.h"
#include "fovea/evaluation/drive_in_city.h"
#include "fovea/map/map_meta.h"

namespace fovea::app {
namespace {

/// The frames of the map under their numbers in the drive of the truth. InputError if the map was
/// not made of that drive. Prints what could not be compared.
std::vector<FrameRecord> frames_of_truth(const MapReader& map, const FrameSource& map_drive,
                                         const std::string& map_path, bool quiet) {
  std::map<int, int> numbers;
  try {
    numbers =
        find_drive_in_map(map, map_path, map_drive, /*foreign=*/false, quiet)->number_in_drive;
  } catch (const InputError& error) {
    throw InputError(error.problem(), error.where(),
                     "give --truth the drive that 'fovea info' names");
  }
  std::vector<FrameRecord> frames;
  for (FrameRecord& frame : map.frames()) {
    const auto number = numbers.find(frame.index);
    if (number == numbers.end()) continue;
    frame.index = number->second;
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace

LocalizationTruth open_truth(const std::string& truth, const FrameSource& drive,
                             const MapReader& map, const std::string& map_path, bool quiet) {
  if (!merged_drives(map).empty()) {
    throw InputError("the map is of several drives", map_path,
                     "compare with the truth in a map of one drive");
  }
  DriveOptions scans;
  scans.use_images = false;
  const auto map_drive = open_drive(truth, scans);
  return {pose_pairs(frames_of_truth(map, *map_drive, map_path, quiet),
                     DriveTruth(map_drive->info().path)),
          DriveTruth(drive.info().path),
          {}};
}

LocalizationTruth open_city_truth(const std::vector<std::string>& truths, const FrameSource& drive,
                                  const City& city, bool quiet) {
  LocalizationTruth result{{}, DriveTruth(drive.info().path), {}};
  const LocalTangentPlane world(result.drive.origin());
  DriveOptions scans;
  scans.use_images = false;
  for (const std::string& folder : truths) {
    const auto city_drive = open_drive(folder, scans);
    const DriveInCity found = find_drive_in_city(city, *city_drive, /*foreign=*/false);
    if (!quiet) {
      for (const std::string& note : found.notes) print_out("note: {}\n", note);
    }
    const DriveTruth truth(city_drive->info().path);
    const RigidMotion T_world_truth = world.T_local_enu(truth.origin());
    for (PosePair pair : pose_pairs(found.frames, truth)) {
      pair.T_true_lidar = T_world_truth * pair.T_true_lidar;
      result.map.push_back(pair);
    }
  }
  result.T_true_city = align_drives(result.map);
  return result;
}

LocalizationErrors localization_errors(const LocalizationTruth& truth,
                                       const LocalizedDrive& localized) {
  LocalizationErrors errors;
  std::size_t count = 0;
  for (const Localization& frame : localized.frames) {
    if (frame.state != LocalizationState::kLocalized) continue;
    if (frame.index < 0 || frame.index >= truth.drive.frames()) continue;
    const PosePair pair{frame.index, truth.drive.T_local_lidar()[std::size_t(frame.index)],
                        frame.T_local_lidar};
    const Twist error = log_se3(truth.T_true_city ? pair.T_true_lidar.inverse() *
                                                        *truth.T_true_city * pair.T_map_lidar
                                                  : error_beside(truth.map, pair));
    const double position = error.tail<3>().norm();
    const double rotation = error.head<3>().norm() * 180 / std::numbers::pi;
    errors.position_rms += position * position;
    errors.rotation_rms += rotation * rotation;
    errors.position_max = std::max(errors.position_max, position);
    errors.rotation_max = std::max(errors.rotation_max, rotation);
    errors.normalized += error.dot(frame.covariance.ldlt().solve(error)) / 6;
    ++count;
  }
  if (count == 0) {
    throw InputError("the truth knows none of the localized frames", truth.drive.folder().string(),
                     "check that it belongs to the drive");
  }
  errors.position_rms = std::sqrt(errors.position_rms / double(count));
  errors.rotation_rms = std::sqrt(errors.rotation_rms / double(count));
  errors.normalized /= double(count);
  return errors;
}

nlohmann::ordered_json to_json(const LocalizationErrors& errors) {
  return {{"position_rms_m", errors.position_rms},
          {"position_max_m", errors.position_max},
          {"rotation_rms_deg", errors.rotation_rms},
          {"rotation_max_deg", errors.rotation_max},
          {"normalized_error", errors.normalized}};
}

void print_errors(const LocalizationErrors& errors) {
  print_out(
      "against the truth: {:.4f} m RMS (at most {:.4f}), {:.4f} degrees RMS (at most "
      "{:.4f}); squared errors are {:.2f} times what their covariances say\n",
      errors.position_rms, errors.position_max, errors.rotation_rms, errors.rotation_max,
      errors.normalized);
}

}  // namespace fovea::app
