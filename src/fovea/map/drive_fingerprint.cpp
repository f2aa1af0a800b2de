#include "fovea/map/drive_fingerprint.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "fovea/map/value_hash.h"

namespace fovea {
namespace {

/// Beyond this a value is the same as any other: no calibration has it.
constexpr double kLargest = 1e9, kResolution = 1e-9;

constexpr const char* kImu = "imu";
constexpr std::string_view kLidar = "lidar_";

void add_rounded(double value, ValueHash& hash) {
  const double bounded = std::isfinite(value) ? std::clamp(value, -kLargest, kLargest) : kLargest;
  hash.value(std::int64_t{std::llround(bounded / kResolution)});
}

void add_pose(const RigidMotion& T, ValueHash& hash) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) add_rounded(T.matrix()(row, column), hash);
  }
}

std::string name_of_part(const std::string& part) {
  if (part == kImu) return "the place of the IMU";
  if (part.starts_with(kLidar)) return "the pose of LiDAR " + part.substr(kLidar.size());
  return "camera " + part;
}

}  // namespace

std::string calibration_fingerprint(const Calibration& calibration,
                                    std::span<const MountedLidar> lidars) {
  std::string fingerprint;
  const auto add = [&](const std::string& name, const ValueHash& hash) {
    fingerprint += fmt::format("{}{}:{:016x}", fingerprint.empty() ? "" : " ", name, hash.hash64());
  };
  if (calibration.T_imu_lidar) {
    ValueHash hash;
    add_pose(*calibration.T_imu_lidar, hash);
    add(kImu, hash);
  }
  for (std::size_t k = 1; k < lidars.size(); ++k) {
    ValueHash hash;
    add_pose(lidars[k].T_lidar_sensor, hash);
    add(fmt::format("{}{}", kLidar, k), hash);
  }
  for (const Camera& camera : calibration.cameras) {
    ValueHash hash;
    for (const int number : {camera.width, camera.height}) hash.value(std::int64_t{number});
    for (const double number : {camera.fx, camera.fy, camera.cx, camera.cy, camera.image_delay}) {
      add_rounded(number, hash);
    }
    add_pose(camera.T_cam_lidar, hash);
    add(fmt::to_string(camera.index), hash);
  }
  return fingerprint;
}

std::map<std::string, std::string> fingerprint_parts(const std::string& fingerprint) {
  std::map<std::string, std::string> parts;
  std::istringstream words(fingerprint);
  for (std::string word; words >> word;) {
    const std::size_t colon = std::min(word.find(':'), word.size());
    parts[word.substr(0, colon)] = word.substr(colon);
  }
  return parts;
}

std::string without_imu(const std::string& fingerprint) {
  std::vector<std::string> kept;
  for (const auto& [name, hash] : fingerprint_parts(fingerprint)) {
    if (name != kImu) kept.push_back(name + hash);
  }
  return fmt::format("{}", fmt::join(kept, " "));
}

std::optional<std::string> calibration_difference(const std::string& a, const std::string& b) {
  const std::map<std::string, std::string> parts_a = fingerprint_parts(a),
                                           parts_b = fingerprint_parts(b);
  std::map<std::string, std::string> all = parts_a;
  all.insert(parts_b.begin(), parts_b.end());
  std::vector<std::string> different;
  for (const auto& [name, hash] : all) {
    const auto in_a = parts_a.find(name), in_b = parts_b.find(name);
    const bool both = in_a != parts_a.end() && in_b != parts_b.end();
    if (both && in_a->second == in_b->second) continue;
    different.push_back(name_of_part(name));
  }
  if (different.empty()) return std::nullopt;
  return fmt::format("{}", fmt::join(different, ", "));
}

std::string stamps_fingerprint(int first_frame, std::span<const std::optional<TimeNs>> stamps) {
  ValueHash hash;
  hash.section("stamps");
  hash.value(std::int64_t{first_frame});
  for (const std::optional<TimeNs>& stamp : stamps) {
    stamp ? hash.value(std::int64_t{*stamp}) : hash.null();
  }
  return hash.hex128();
}

}  // namespace fovea
