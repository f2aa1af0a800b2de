#include "fovea/drive/kitti/oxts.h"

#include <algorithm>
#include <cmath>

#include "fovea/core/read_file.h"
#include "fovea/drive/measured_velocity.h"
#include "fovea/drive/plausible.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr std::size_t kFields = 30;
constexpr std::size_t kVelocityLevel = 8, kForceImu = 11, kRateImu = 17, kPositionAccuracy = 23,
                      kSatellites = 26;

Eigen::Vector3d vector_at(const std::vector<double>& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

}  // namespace

Eigen::Matrix3d OxtsRecord::R_enu_imu() const {
  return (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

std::variant<OxtsRecord, std::string> parse_oxts(std::string_view text) {
  const auto numbers = parse_numbers(text);
  if (!numbers) return "has an entry that is no number";
  if (numbers->size() != kFields) {
    return "has " + std::to_string(numbers->size()) + " numbers, not " + std::to_string(kFields);
  }
  for (const double number : *numbers) {
    if (!std::isfinite(number)) return "has an entry that is not finite";
  }
  const std::vector<double>& n = *numbers;
  if (std::abs(n[0]) > 90) {
    const bool swapped = std::abs(n[0]) <= 180 && std::abs(n[1]) <= 90;
    return "has latitude " + std::to_string(n[0]) + (swapped ? " (swapped with longitude?)" : "");
  }
  if (std::abs(n[1]) > 180) return "has longitude " + std::to_string(n[1]);
  if (std::abs(n[2]) > kMaxAltitude) return "has altitude " + std::to_string(n[2]);
  for (std::size_t i = 3; i < 6; ++i) {
    if (std::abs(n[i]) > kMaxAngle) {
      return "has angle " + std::to_string(n[i]) + ", over a turn: likely degrees, not radians";
    }
  }
  if (is_null_position(n[0], n[1])) return "has latitude and longitude 0: no fix";
  OxtsRecord record;
  record.position = {n[0], n[1], n[2]};
  record.roll = n[3];
  record.pitch = n[4];
  record.yaw = n[5];
  record.position_accuracy = std::max(0.0, n[kPositionAccuracy]);
  // Other programs that write the format often leave all fields of the quality zero.
  const auto is_zero = [](double number) { return number == 0; };
  if (!std::all_of(n.begin() + kPositionAccuracy, n.end(), is_zero)) {
    record.satellites = static_cast<int>(std::clamp(n[kSatellites], 0.0, 1000.0));
  }
  record.rate = vector_at(n, kRateImu);
  record.force = vector_at(n, kForceImu);
  // The level frame is turned as east-north-up is, but heads where the imu does.
  const Eigen::AngleAxisd R_level_enu(-record.yaw, Eigen::Vector3d::UnitZ());
  const Eigen::Matrix3d R_level_imu = R_level_enu * record.R_enu_imu();
  record.velocity =
      measured_velocity(record.rate, R_level_imu.transpose() * vector_at(n, kVelocityLevel));
  return record;
}

std::variant<OxtsRecord, std::string> read_oxts(const std::filesystem::path& file) {
  try {
    return parse_oxts(read_text(file));
  } catch (const InputError& error) {
    return "cannot be read: " + error.problem();
  }
}

}  // namespace fovea
