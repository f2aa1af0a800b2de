#include "fovea/drive/navigation/imu_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/core/median.h"
#include "fovea/drive/navigation/navigation_columns.h"
#include "fovea/geometry/imu_gap.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

constexpr double kStandardGravity = 9.80665;  // m/s^2
/// No IMU measures more: rad/s, or degrees a second that are to be radians; m/s^2.
constexpr double kLargestRate = 500, kLargestForce = 5000;

Eigen::Vector3d vector_at(const CsvRows& rows, std::size_t row, std::size_t first) {
  return {rows.at(row, first), rows.at(row, first + 1), rows.at(row, first + 2)};
}

/// The factor from the file's accelerations to m/s^2. At rest and on average they are as long as
/// gravity.
double force_scale(const std::vector<ImuSample>& samples, ForceUnit stated, const fs::path& file,
                   Messages& messages) {
  if (stated == ForceUnit::kGravity) return kStandardGravity;
  if (stated == ForceUnit::kMetric) return 1;
  std::vector<double> lengths;
  lengths.reserve(samples.size());
  for (const ImuSample& sample : samples) lengths.push_back(sample.force.norm());
  const double usual = median_of(std::move(lengths));
  constexpr double kLeastG = 0.7, kMostG = 1.4;
  if (usual >= kLeastG && usual <= kMostG) {
    messages.notes.push_back(
        fmt::format("{}: accelerations of {:.2f} are read as multiples of gravity (state "
                    "imu.acceleration_unit in drive.toml)",
                    file.string(), usual));
    return kStandardGravity;
  }
  if (usual < kLeastG * kStandardGravity || usual > kMostG * kStandardGravity) {
    messages.warn(
        fmt::format("{}: accelerations of {:.2f} m/s^2 are no gravity: wrong units, or gravity is "
                    "taken out; the IMU needs raw accelerations",
                    file.string(), usual));
  }
  return 1;
}

void report_times(const std::vector<ImuSample>& samples, const fs::path& file, Messages& messages) {
  std::vector<TimeNs> steps;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    steps.push_back(samples[i].time - samples[i - 1].time);
  }
  if (steps.empty()) return;
  const TimeNs usual = median_of(steps);
  constexpr double kSlowest = 50;  // Hz
  const double rate = 1 / seconds(usual);
  if (rate < 0.9 * kSlowest) {
    messages.warn(
        fmt::format("{} has {:.0f} records a second: under {:.0f}, motion between them "
                    "is lost",
                    file.string(), rate, kSlowest));
  }
  const TimeNs limit = imu_gap_limit(samples);
  std::size_t gaps = 0;
  TimeNs longest = 0;
  for (const TimeNs step : steps) {
    if (step <= limit) continue;
    ++gaps;
    longest = std::max(longest, step);
  }
  if (gaps > 0) {
    messages.warn(
        fmt::format("{} has {} gaps, the longest of {:.2f} s: there, scans alone tell "
                    "the motion",
                    file.string(), gaps, seconds(longest)));
  }
}

/// A sensor at the end of its range repeats its largest value.
/// @param kind   "angular rates"
/// @param least  that any IMU measures
void report_saturation(const std::vector<double>& values, std::string_view kind,
                       std::string_view unit, double scale, double least, const fs::path& file,
                       Messages& messages) {
  constexpr std::size_t kInARow = 3;
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  if (largest == 0) return;
  std::size_t count = 0, in_a_row = 0, longest = 0;
  for (const double value : values) {
    const bool at_end = std::abs(value) == largest;
    in_a_row = at_end ? in_a_row + 1 : 0;
    longest = std::max(longest, in_a_row);
    count += at_end ? 1 : 0;
  }
  if (longest < kInARow || largest < least) return;
  messages.warn(
      fmt::format("{}: {} {} are at the end of the range, {:.4g} {}: the IMU is saturated",
                  file.string(), count, kind, largest * scale, unit));
}

void report_saturation(const std::vector<ImuSample>& samples, const fs::path& file,
                       Messages& messages) {
  constexpr double kLeastRate = 0.5, kLeastForce = 14;  // rad/s, m/s^2
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> rates, forces;
    for (const ImuSample& sample : samples) {
      rates.push_back(sample.rate[axis]);
      forces.push_back(sample.force[axis]);
    }
    const char name = "xyz"[axis];
    report_saturation(rates, fmt::format("angular rates about {}", name), "degrees/s", 1 / kDegree,
                      kLeastRate, file, messages);
    report_saturation(forces, fmt::format("accelerations along {}", name), "m/s^2", 1, kLeastForce,
                      file, messages);
  }
}

}  // namespace

const char* why_unusable(const ImuSample& sample) {
  if (!sample.rate.allFinite() || !sample.force.allFinite()) {
    return "without rates and accelerations";
  }
  if (sample.rate.norm() > kLargestRate || sample.force.norm() > kLargestForce) {
    return "with rates or accelerations out of range";
  }
  return nullptr;
}

ImuSample imu_sample(TimeNs stamp, const Eigen::Vector3d& rate, const Eigen::Vector3d& force,
                     const ImuDescription& description) {
  const double rate_scale = description.rate_unit == RateUnit::kDegrees ? kDegree : 1;
  return {stamp + from_seconds(description.delay), rate_scale * rate, force};
}

ImuTable convert_imu(CsvRows rows, const fs::path& file, const ImuDescription& description) {
  constexpr std::size_t kRateX = 0, kForceX = 3;
  ImuTable table;
  LeftOut left_out(file, rows);
  left_out.add_out_of_order(rows.drop_out_of_order());
  ImuData imu{description.T_lidar_imu, description.noise, {}};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const ImuSample sample = imu_sample(rows.times[row], vector_at(rows, row, kRateX),
                                        vector_at(rows, row, kForceX), description);
    if (const char* const reason = why_unusable(sample)) {
      left_out.add(rows.lines[row], reason);
    } else {
      imu.samples.push_back(sample);
    }
  }
  left_out.warn(table);
  if (imu.samples.size() < 2) {
    table.warn(
        fmt::format("{} has no angular rates and accelerations (wx, wy, wz, ax, ay, az): "
                    "the IMU is not used",
                    file.string()));
    return table;
  }
  table.force_scale = force_scale(imu.samples, description.force_unit, file, table);
  for (ImuSample& sample : imu.samples) sample.force *= table.force_scale;
  report_faults(imu.samples, file, table);
  table.imu = std::move(imu);
  return table;
}

ImuTable read_imu(const fs::path& file, const ImuDescription& description,
                  const std::optional<ScanPeriod>& scans) {
  Messages read;
  CsvRows rows = read_timed_csv(file, kInertiaColumns, scans, read.notes);
  ImuTable table = convert_imu(std::move(rows), file, description);
  table.notes.insert(table.notes.begin(), read.notes.begin(), read.notes.end());
  return table;
}

bool is_wheel_speed(double speed) {
  constexpr double kFastest = 200;  // m/s
  return std::isfinite(speed) && std::abs(speed) < kFastest;
}

void report_faults(const std::vector<ImuSample>& samples, const fs::path& file,
                   Messages& messages) {
  report_times(samples, file, messages);
  report_saturation(samples, file, messages);
}

WheelTable read_wheels(const fs::path& file, const WheelDescription& description,
                       const std::optional<ScanPeriod>& scans) {
  constexpr std::array<CsvColumn, 1> kColumns = {{{"speed", true}}};
  WheelTable table;
  CsvRows rows = read_timed_csv(file, kColumns, scans, table.notes);
  LeftOut left_out(file, rows);
  left_out.add_out_of_order(rows.drop_out_of_order());
  WheelData wheels{description.T_lidar_body, description.sigma, {}};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const double speed = rows.at(row, 0);
    if (is_wheel_speed(speed)) {
      wheels.samples.push_back({rows.times[row], speed});
    } else {
      left_out.add(rows.lines[row], "without a speed");
    }
  }
  left_out.warn(table);
  if (!wheels.samples.empty()) table.wheels = std::move(wheels);
  return table;
}

InertialTables read_inertial_tables(const fs::path& folder, const DriveDescription& drive,
                                    const std::optional<ScanPeriod>& scans) {
  InertialTables tables;
  const fs::path imu_file = folder / "imu.csv", wheels_file = folder / "wheels.csv";
  if (drive.imu && fs::exists(imu_file)) {
    ImuTable table = read_imu(imu_file, *drive.imu, scans);
    tables.append(table);
    tables.imu = std::move(table.imu);
  }
  if (fs::exists(wheels_file)) {
    WheelTable table = read_wheels(wheels_file, drive.wheels, scans);
    tables.append(table);
    tables.wheels = std::move(table.wheels);
  }
  return tables;
}

}  // namespace fovea
