// Beams, rates, ranges and noise of LiDARs as their data sheets state them.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

enum class LidarModel {
  kHdl64,
  kHdl32,
  kVlp16,
  kOs1_64,
  kOs1_128,
  kPandar64,
  kXt32,
  kLivoxAvia,
  kLivoxHap,
};

/// A non-repetitive pattern: one beam behind two rotating prisms. It draws a rosette in an elliptic
/// field of view around the x axis, and no rosette repeats the one before.
struct Rosette {
  double width = 0, height = 0;  ///< rad, the field of view
};

/// Azimuth and elevation (rad) of a rosette's beam at a time (s).
Eigen::Vector2d rosette_angles(const Rosette& rosette, double time);

struct LidarDataSheet {
  LidarModel model = LidarModel::kHdl64;
  std::string_view name;     ///< as options give it: "vlp16"
  std::string_view product;  ///< "Velodyne VLP-16"
  /// Elevations of the rings (rad), highest first; all of them fire at once. A rosette has one
  /// beam and no rings: its only entry is 0.
  std::vector<double> elevations;
  std::optional<Rosette> rosette;       ///< absent: the LiDAR rotates
  double period = 0.1;                  ///< s, of a sweep
  double firing_rate = 0;               ///< firings a second, at every period
  double min_range = 0, max_range = 0;  ///< m
  double range_noise = 0;               ///< m, standard deviation
  double range_resolution = 0;          ///< m
  /// m, at which a matte target of 10 % reflectance is detected half of the time.
  double dark_range = 0;
};

/// Of all models, in the order of LidarModel.
const std::vector<LidarDataSheet>& lidar_data_sheets();
/// Names of all models.
std::vector<std::string> lidar_model_names();
/// The model of that name; ConfigError that lists all for any other.
LidarModel parse_lidar_model(std::string_view name);
const LidarDataSheet& lidar_data_sheet(LidarModel model);

}  // namespace fovea
