// imu.csv and wheels.csv (docs/drives.md).
#pragma once

#include <filesystem>
#include <optional>

#include "fovea/core/messages.h"
#include "fovea/drive/drive_description.h"
#include "fovea/drive/scans/csv_rows.h"
#include "fovea/drive/stamp_units.h"

namespace fovea {

struct ImuTable : Messages {
  std::optional<ImuData> imu;  ///< absent: the file has nothing of use
  double force_scale = 1;      ///< from the file's accelerations to m/s^2
};

/// A record in rad/s; its acceleration keeps its unit.
ImuSample imu_sample(TimeNs stamp, const Eigen::Vector3d& rate, const Eigen::Vector3d& force,
                     const ImuDescription& description);
/// Why a record is left out ("without rates and accelerations"); nullptr if it is not.
const char* why_unusable(const ImuSample& sample);

/// As read_imu() of rows in memory.
/// @param rows  kInertiaColumns
/// @param file  of the rows, for messages
ImuTable convert_imu(CsvRows rows, const std::filesystem::path& file,
                     const ImuDescription& description);

/// Reads the angular rates and accelerations of a file. Warnings count the lines that are left out,
/// and name faults: gaps, values at the end of the IMU's range, accelerations that are no gravity.
/// InputError if the file cannot be read.
ImuTable read_imu(const std::filesystem::path& file, const ImuDescription& description,
                  const std::optional<ScanPeriod>& scans);

/// Warns of gaps, of too few samples, and of values at the end of the IMU's range.
/// @param file  of the samples, for warnings
void report_faults(const std::vector<ImuSample>& samples, const std::filesystem::path& file,
                   Messages& messages);

struct WheelTable : Messages {
  std::optional<WheelData> wheels;
};

/// Whether a vehicle can be so fast, m/s.
bool is_wheel_speed(double speed);

/// Reads the speeds of wheels. As read_imu().
WheelTable read_wheels(const std::filesystem::path& file, const WheelDescription& description,
                       const std::optional<ScanPeriod>& scans);

/// What imu.csv and wheels.csv of a drive's folder give, where they are there. The IMU needs a
/// place that the drive states.
struct InertialTables : Messages {
  std::optional<ImuData> imu;
  std::optional<WheelData> wheels;
};
InertialTables read_inertial_tables(const std::filesystem::path& folder,
                                    const DriveDescription& drive,
                                    const std::optional<ScanPeriod>& scans);

}  // namespace fovea
