#include "fovea/localization/pose_table.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "fovea/geometry/pose_file.h"

namespace fovea {
namespace {

constexpr std::array kAxes{"rx", "ry", "rz", "tx", "ty", "tz"};

std::string pose_columns(const Localization& frame) {
  const Eigen::Vector3d t = frame.T_local_lidar.translation();
  const Eigen::Quaterniond q(frame.T_local_lidar.linear());
  std::string text =
      fmt::format(",{},{},{},{},{},{},{}", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      text += fmt::format(",{:.6g}", frame.covariance(row, column));
    }
  }
  return text;
}

}  // namespace

void write_pose_lines(const std::vector<Localization>& frames, int begin, int end,
                      std::ostream& out) {
  auto next = frames.begin();
  for (int index = begin; index < end; ++index) {
    const bool asked = next != frames.end() && next->index == index;
    const bool localized = asked && next->state == LocalizationState::kLocalized;
    out << (localized ? format_pose(next->T_local_lidar) : pose_gap()) << '\n';
    if (asked) ++next;
  }
}

void write_pose_table(const std::vector<Localization>& frames, std::ostream& out) {
  std::string head = "frame,time_ns,state,health,x,y,z,qx,qy,qz,qw", nothing;
  for (std::size_t row = 0; row < kAxes.size(); ++row) {
    for (std::size_t column = row; column < kAxes.size(); ++column) {
      head += fmt::format(",cov_{}_{}", kAxes[row], kAxes[column]);
    }
  }
  nothing.assign(7 + 21, ',');
  out << head << '\n';
  for (const Localization& frame : frames) {
    const bool localized = frame.state == LocalizationState::kLocalized;
    out << frame.index << ',' << (frame.stamp ? fmt::to_string(*frame.stamp) : std::string()) << ','
        << to_string(frame.state) << ',' << fmt::format("{:.4f}", frame.health)
        << (localized ? pose_columns(frame) : nothing) << '\n';
  }
}

}  // namespace fovea
