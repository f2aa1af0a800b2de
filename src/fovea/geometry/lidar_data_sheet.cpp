#include "fovea/geometry/lidar_data_sheet.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <numbers>

#include "fovea/core/angle.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// `count` rings from the highest down, `step` degrees apart.
std::vector<double> even_rings(int count, double highest, double step) {
  std::vector<double> elevations(static_cast<std::size_t>(count));
  for (int ring = 0; ring < count; ++ring) {
    elevations[static_cast<std::size_t>(ring)] = (highest - ring * step) * kDegree;
  }
  return elevations;
}

/// HDL-64E S2: the upper block from +2 degrees by a third, the lower one from -8.83 by a half.
std::vector<double> hdl64_rings() {
  std::vector<double> elevations(64);
  for (std::size_t ring = 0; ring < 32; ++ring) {
    const auto k = static_cast<double>(ring);
    elevations[ring] = (2.0 - k / 3.0) * kDegree;
    elevations[32 + ring] = (-8.83 - 0.5 * k) * kDegree;
  }
  return elevations;
}

/// HDL-32E: steps of 4/3 degrees; the ninth ring is level.
std::vector<double> hdl32_rings() {
  std::vector<double> elevations(32);
  for (std::size_t ring = 0; ring < 32; ++ring) {
    elevations[ring] = (32 - 4 * static_cast<double>(ring)) / 3.0 * kDegree;
  }
  return elevations;
}

/// Pandar64: the channel table of the user manual, degrees.
std::vector<double> pandar64_rings() {
  constexpr std::array kDegrees{
      14.882, 11.032, 8.059,  5.057,   3.04,    2.028,   1.86,   1.688,   1.522,  1.351,  1.184,
      1.013,  0.846,  0.675,  0.508,   0.337,   0.169,   0.0,    -0.169,  -0.337, -0.508, -0.675,
      -0.845, -1.013, -1.184, -1.351,  -1.522,  -1.688,  -1.86,  -2.028,  -2.198, -2.365, -2.536,
      -2.7,   -2.873, -3.04,  -3.21,   -3.375,  -3.548,  -3.712, -3.884,  -4.05,  -4.221, -4.385,
      -4.558, -4.72,  -4.892, -5.057,  -5.229,  -5.391,  -5.565, -5.726,  -5.898, -6.061, -7.063,
      -8.059, -9.06,  -9.885, -11.032, -12.006, -12.974, -13.93, -18.889, -24.897};
  static_assert(kDegrees.size() == 64);
  std::vector<double> elevations(kDegrees.begin(), kDegrees.end());
  for (double& elevation : elevations) elevation *= kDegree;
  return elevations;
}

constexpr double kOusterStep = 45.0;  // degrees, the vertical field of view

/// In the order of LidarModel. Velodyne's and Hesai's accuracies count as standard deviations where
/// the data sheet states no precision. The HDL-64E's row is that of KITTI's recordings: sweeps of
/// 103.4 ms, and 1.5 cm of noise where the data sheet promises less than 2 cm.
std::vector<LidarDataSheet> make_data_sheets() {
  using enum LidarModel;
  const auto avia = Rosette{70.4 * kDegree, 77.2 * kDegree};
  const auto hap = Rosette{120 * kDegree, 25 * kDegree};
  return {
      {kHdl64,
       "hdl64",
       "Velodyne HDL-64E S2",
       hdl64_rings(),
       {},
       0.1034,
       2083 / 0.1034,
       0.9,
       120,
       0.015,
       0.002,
       50},
      {kHdl32,
       "hdl32",
       "Velodyne HDL-32E",
       hdl32_rings(),
       {},
       0.1,
       1 / 46.08e-6,
       0.9,
       100,
       0.02,
       0.002,
       50},
      {kVlp16,
       "vlp16",
       "Velodyne VLP-16",
       even_rings(16, 15, 2),
       {},
       0.1,
       1 / 55.296e-6,
       0.9,
       100,
       0.03,
       0.002,
       50},
      {kOs1_64,
       "os1-64",
       "Ouster OS1-64",
       even_rings(64, 22.5, kOusterStep / 63),
       {},
       0.1,
       10'240,
       0.8,
       120,
       0.015,
       0.003,
       40},
      {kOs1_128,
       "os1-128",
       "Ouster OS1-128",
       even_rings(128, 22.5, kOusterStep / 127),
       {},
       0.1,
       10'240,
       0.8,
       120,
       0.015,
       0.003,
       40},
      {kPandar64,
       "pandar64",
       "Hesai Pandar64",
       pandar64_rings(),
       {},
       0.1,
       18'000,
       0.3,
       200,
       0.02,
       0.004,
       200},
      {kXt32,
       "xt32",
       "Hesai XT32",
       even_rings(32, 15, 1),
       {},
       0.1,
       20'000,
       0.3,
       120,
       0.005,
       0.004,
       80},
      {kLivoxAvia, "livox-avia", "Livox Avia", {0}, avia, 0.1, 240'000, 1, 190, 0.02, 0.001, 190},
      {kLivoxHap, "livox-hap", "Livox HAP", {0}, hap, 0.1, 452'000, 0.5, 150, 0.02, 0.001, 150},
  };
}

}  // namespace

Eigen::Vector2d rosette_angles(const Rosette& rosette, double time) {
  // The prisms of a Livox Mid-40 turn at 7294 and -4664 a minute (Liu, Wang, Zhang 2021,
  // "Low-cost Retina-like Robotic Lidars Based on Incommensurable Scanning").
  constexpr double kTurnsAMinute = 2 * std::numbers::pi / 60;
  const double first = 7294 * kTurnsAMinute * time, second = -4664 * kTurnsAMinute * time;
  return {0.25 * rosette.width * (std::cos(first) + std::cos(second)),
          0.25 * rosette.height * (std::sin(first) + std::sin(second))};
}

const std::vector<LidarDataSheet>& lidar_data_sheets() {
  static const std::vector<LidarDataSheet> sheets = make_data_sheets();
  return sheets;
}

std::vector<std::string> lidar_model_names() {
  std::vector<std::string> names;
  for (const LidarDataSheet& sheet : lidar_data_sheets()) names.emplace_back(sheet.name);
  return names;
}

LidarModel parse_lidar_model(std::string_view name) {
  for (const LidarDataSheet& sheet : lidar_data_sheets()) {
    if (sheet.name == name) return sheet.model;
  }
  throw ConfigError(fmt::format("unknown LiDAR '{}'", name), "lidar.model",
                    fmt::format("give one of {}", fmt::join(lidar_model_names(), ", ")));
}

const LidarDataSheet& lidar_data_sheet(LidarModel model) {
  return lidar_data_sheets().at(static_cast<std::size_t>(model));
}

}  // namespace fovea
