// `fovea localize --truth`: errors of the poses of a simulated drive.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fovea/city/city.h"
#include "fovea/drive/drive_truth.h"
#include "fovea/drive/frame_source.h"
#include "fovea/evaluation/truth_poses.h"
#include "fovea/localization/localize_drive.h"
#include "fovea/map/map_store.h"

namespace fovea::app {

struct LocalizationTruth {
  std::vector<PosePair> map;  ///< true poses of the frames of the map or the city
  DriveTruth drive;           ///< of the drive that is localized
  /// Lays the frames of a city over their truth; absent for a map.
  std::optional<RigidMotion> T_true_city;
};

/// In a map: relative to the nearest pose of the map, so that errors of the map do not count. In a
/// city: after one rigid alignment of the city's drives to their truth.
struct LocalizationErrors {
  double position_rms = 0, position_max = 0;  ///< m
  double rotation_rms = 0, rotation_max = 0;  ///< degrees
  /// Mean of the squared errors relative to their covariances, for one direction.
  double normalized = 0;
};

/// Prints comparisons that were impossible, unless `quiet`.
/// @param truth  folder of the drive of the map
/// @throws InputError  if the map was not made of that drive alone
LocalizationTruth open_truth(const std::string& truth, const FrameSource& drive,
                             const MapReader& map, const std::string& map_path, bool quiet);

/// @param truths  folders of drives of the city; at least one
/// @throws InputError  if the city was not made of one of these drives
LocalizationTruth open_city_truth(const std::vector<std::string>& truths, const FrameSource& drive,
                                  const City& city, bool quiet);

/// @throws InputError  if the truth has none of the localized frames
LocalizationErrors localization_errors(const LocalizationTruth& truth,
                                       const LocalizedDrive& localized);

nlohmann::ordered_json to_json(const LocalizationErrors& errors);
void print_errors(const LocalizationErrors& errors);

}  // namespace fovea::app
