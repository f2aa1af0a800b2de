#include "fovea/drive/navigation/navigation_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "fovea/drive/measured_velocity.h"

namespace fovea {

std::optional<Eigen::Quaterniond> quaternion_of(const CsvRows& rows, std::size_t row,
                                                std::size_t first) {
  const Eigen::Quaterniond q(rows.at(row, first + 3), rows.at(row, first), rows.at(row, first + 1),
                             rows.at(row, first + 2));
  if (!(std::abs(q.norm() - 1) < 0.01)) return std::nullopt;  // NaN, too
  return q.normalized();
}

std::optional<Twist> velocity_of(const CsvRows& rows, std::size_t row, std::size_t first) {
  const auto vector = [&](std::size_t column) {
    return Eigen::Vector3d(rows.at(row, column), rows.at(row, column + 1),
                           rows.at(row, column + 2));
  };
  return measured_velocity(vector(first + 3), vector(first));
}

double accuracy_of(const CsvRows& rows, std::size_t row, std::size_t column) {
  const double accuracy = rows.at(row, column);
  return std::isnan(accuracy) ? 0 : std::max(0.0, accuracy);
}

void LeftOut::warn(Messages& messages) const {
  if (!lines_.empty()) {
    std::vector<std::string> reasons;
    for (const auto& [reason, count] : count_by_reason_) {
      reasons.push_back(fmt::format("{} {}", count, reason));
    }
    messages.warn(fmt::format("{} lines of {} cannot be used (the first: {}): {}", lines_.size(),
                              file_.string(), *std::min_element(lines_.begin(), lines_.end()),
                              fmt::join(reasons, ", ")));
  }
  if (out_of_order_ > 0) {
    messages.warn(
        fmt::format("{} lines of {} are out of order and not used", out_of_order_, file_.string()));
  }
}

}  // namespace fovea
