// What tables of poses and of positions have in common.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/drive/scans/csv_rows.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// The rotation of the quaternion x y z w in four columns from `first` on; empty if that is none.
std::optional<Eigen::Quaterniond> quaternion_of(const CsvRows& rows, std::size_t row,
                                                std::size_t first);

/// The velocity in six columns from `first` on, where the line has one.
std::optional<Twist> velocity_of(const CsvRows& rows, std::size_t row, std::size_t first);

/// Standard deviation as DriveInfo has it: 0 where the file says nothing.
double accuracy_of(const CsvRows& rows, std::size_t row, std::size_t column);

/// A table's columns, and after them those of a velocity.
template <std::size_t N>
constexpr std::array<CsvColumn, N + 6> with_velocity(const std::array<CsvColumn, N>& columns) {
  std::array<CsvColumn, N + 6> all{};
  std::size_t next = 0;
  for (const CsvColumn& column : columns) all[next++] = column;
  for (const char* name : {"vx", "vy", "vz", "wx", "wy", "wz"}) all[next++] = {name, false};
  return all;
}

/// Lines that cannot be used, for a warning.
class LeftOut {
 public:
  LeftOut(const std::filesystem::path& file, const CsvRows& rows)
      : file_(file), lines_(rows.malformed) {
    if (!lines_.empty()) count_by_reason_["malformed"] = lines_.size();
  }

  /// @param reason  "without an attitude"
  void add(int line, const std::string& reason) {
    lines_.push_back(line);
    ++count_by_reason_[reason];
  }
  void add_out_of_order(std::size_t count) { out_of_order_ = count; }
  void warn(Messages& messages) const;

 private:
  std::filesystem::path file_;
  std::vector<int> lines_;
  std::map<std::string, std::size_t> count_by_reason_;
  std::size_t out_of_order_ = 0;
};

}  // namespace fovea
