#include "fovea/geometry/pose_file.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "fovea/base/errors.h"

namespace fovea {
namespace {

constexpr double kRotationTolerance = 1e-3;  // poses are often written with few digits
constexpr double kRotationRounding = 1e-12;
constexpr const char* kRemedy = "give one 3x4 row-major T_local_lidar a line, 12 numbers";

RigidMotion parse_pose(const std::string& line, const std::string& where) {
  std::istringstream stream(line);
  std::vector<double> numbers;
  for (std::string word; stream >> word;) {
    std::size_t used = 0;
    double value = std::numeric_limits<double>::quiet_NaN();
    try {
      value = std::stod(word, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used != word.size() || !std::isfinite(value)) {
      throw InputError(fmt::format("'{}' is not a number", word), where, kRemedy);
    }
    numbers.push_back(value);
  }
  if (numbers.size() != 12) {
    throw InputError(fmt::format("a pose has {} numbers", numbers.size()), where, kRemedy);
  }
  RigidMotion pose = RigidMotion::Identity();
  pose.affine() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers.data());
  if (!is_rotation(pose.linear(), kRotationTolerance)) {
    throw InputError("a pose has no rotation matrix", where, kRemedy);
  }
  // Full digits are kept as they are, so that what we write reads back to the same bits.
  if (!is_rotation(pose.linear(), kRotationRounding)) {
    pose.linear() = nearest_rotation(pose.linear());
  }
  return pose;
}

}  // namespace

std::vector<RigidMotion> read_poses(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file)) {
    throw InputError("the poses cannot be read", file.string(), "check the path");
  }
  std::vector<RigidMotion> poses;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    poses.push_back(parse_pose(line, fmt::format("{}:{}", file.string(), number)));
  }
  if (poses.empty()) throw InputError("there are no poses", file.string(), kRemedy);
  return poses;
}

std::vector<RigidMotion> read_poses(const std::filesystem::path& file, int begin, int end) {
  std::vector<RigidMotion> poses = read_poses(file);
  const auto count = static_cast<int>(poses.size());
  if (count == end - begin || (begin == 0 && count < end)) return poses;
  if (count < end) {
    throw InputError(fmt::format("{} poses for frames {} to {}", count, begin, end - 1),
                     file.string(),
                     "give one line for each of these frames, or for every frame from 0");
  }
  return {poses.begin() + begin, poses.begin() + end};
}

std::string format_pose(const RigidMotion& pose) {
  std::string text;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      text += fmt::format("{}{}", text.empty() ? "" : " ", pose.matrix()(row, column));
    }
  }
  return text;
}

}  // namespace fovea
