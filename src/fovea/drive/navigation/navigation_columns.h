// Columns of poses.csv, gnss.csv and imu.csv (docs/drives.md), in the order in which rows have
// them.
#pragma once

#include <array>
#include <cstddef>

#include "fovea/drive/navigation/navigation_table.h"

namespace fovea {

namespace pose_column {
enum PoseColumn : std::size_t { kX, kY, kZ, kQx, kAccuracy = 7, kVelocity };
}
inline constexpr auto kPoseColumns = with_velocity<pose_column::kVelocity>(
    {{{"x"}, {"y"}, {"z"}, {"qx"}, {"qy"}, {"qz"}, {"qw"}, {"accuracy", false}}});

namespace position_column {
enum PositionColumn : std::size_t {
  kLatitude,
  kLongitude,
  kAltitude,
  kAccuracy,
  kRoll,
  kPitch,
  kYaw,
  kQx,
  kSatellites = kQx + 4,
  kStatus,
  kVelocity
};
}
inline constexpr auto kPositionColumns =
    with_velocity<position_column::kVelocity>({{{"latitude"},
                                                {"longitude"},
                                                {"altitude"},
                                                {"accuracy", false},
                                                {"roll", false},
                                                {"pitch", false},
                                                {"yaw", false},
                                                {"qx", false},
                                                {"qy", false},
                                                {"qz", false},
                                                {"qw", false},
                                                {"satellites", false},
                                                {"status", false}}});

/// Of imu.csv: what gnss.csv without attitudes needs.
inline constexpr std::array<CsvColumn, 4> kOrientationColumns = {
    {{"qx", false}, {"qy", false}, {"qz", false}, {"qw", false}}};

/// Of imu.csv: what the IMU measures.
inline constexpr std::array<CsvColumn, 6> kInertiaColumns = {
    {{"wx", false}, {"wy", false}, {"wz", false}, {"ax", false}, {"ay", false}, {"az", false}}};

}  // namespace fovea
