#include "fovea/geometry/pose_file.h"

#include <fmt/format.h>

#include <sstream>
#include <stdexcept>

#include "fovea/core/input_file.h"
#include "fovea/core/text_encoding.h"
#include "fovea/errors.h"
#include "fovea/geometry/position_limit.h"

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
    if (line == pose_gap()) {
      throw InputError("this pose is not known (nan)", where, "give poses without gaps");
    }
    if (used != word.size() || !std::isfinite(value)) {
      throw InputError(fmt::format("'{}' is not a number", word), where, kRemedy);
    }
    numbers.push_back(value);
  }
  if (numbers.size() != 12) {
    throw InputError(fmt::format("a pose has {} numbers", numbers.size()), where, kRemedy);
  }
  try {
    return checked_pose(
        Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers.data()));
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what(), where, kRemedy);
  }
}

/// Of frames [begin, end), see read_poses.
template <class Pose>
std::vector<Pose> of_frames(const std::vector<Pose>& poses, int begin, int end,
                            const std::filesystem::path& file) {
  const auto count = static_cast<int>(poses.size());
  if (count == end - begin || (begin == 0 && count < end)) return poses;
  if (count < end) {
    throw InputError(fmt::format("{} poses for frames {} to {}", count, begin, end - 1),
                     file.string(),
                     "give one line for each of these frames, or for every frame from 0");
  }
  return {poses.begin() + begin, poses.begin() + end};
}

/// Calls f(line, where) for each line that is not blank; InputError if there is none.
template <class F>
void for_each_line(const std::filesystem::path& file, F&& f) {
  InputFile input(file, kDataFile);
  std::istream& stream = input.stream();
  int number = 0;
  bool any = false;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (number == 1) line = without_byte_order_mark(line, file.string());
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    any = true;
    f(line, fmt::format("{}:{}", file.string(), number));
  }
  if (!any) throw InputError("there are no poses", file.string(), kRemedy);
}

}  // namespace

RigidMotion checked_pose(const Eigen::Matrix<double, 3, 4>& matrix) {
  RigidMotion pose = RigidMotion::Identity();
  pose.affine() = matrix;
  if (!matrix.allFinite()) throw std::invalid_argument("a pose has a number that is not finite");
  if (!is_possible_position(pose.translation())) {
    throw std::invalid_argument(
        fmt::format("a pose lies over {:.0f} km from the origin", kMaxPosition / 1000));
  }
  if (!is_rotation(pose.linear(), kRotationTolerance)) {
    throw std::invalid_argument(fmt::format("a pose has no rotation matrix (determinant {:.3g})",
                                            pose.linear().determinant()));
  }
  // Full digits are kept as they are, so that what we write reads back to the same bits.
  if (!is_rotation(pose.linear(), kRotationRounding)) {
    pose.linear() = nearest_rotation(pose.linear());
  }
  return pose;
}

std::vector<RigidMotion> read_poses(const std::filesystem::path& file) {
  std::vector<RigidMotion> poses;
  for_each_line(file, [&](const std::string& line, const std::string& where) {
    poses.push_back(parse_pose(line, where));
  });
  return poses;
}

std::vector<RigidMotion> read_poses(const std::filesystem::path& file, int begin, int end) {
  return of_frames(read_poses(file), begin, end, file);
}

std::vector<std::optional<RigidMotion>> read_poses_with_gaps(const std::filesystem::path& file) {
  std::vector<std::optional<RigidMotion>> poses;
  for_each_line(file, [&](const std::string& line, const std::string& where) {
    const bool gap = line.substr(0, line.find_last_not_of(" \t\r") + 1) == pose_gap();
    poses.push_back(gap ? std::nullopt : std::optional(parse_pose(line, where)));
  });
  return poses;
}

std::vector<std::optional<RigidMotion>> read_poses_with_gaps(const std::filesystem::path& file,
                                                             int begin, int end) {
  return of_frames(read_poses_with_gaps(file), begin, end, file);
}

std::string pose_gap() { return "nan nan nan nan nan nan nan nan nan nan nan nan"; }

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
