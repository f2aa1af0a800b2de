#include "fovea/point_cloud.h"

#include <fmt/format.h>

#include <functional>
#include <stdexcept>

#include "fovea/core/cloud_columns.h"
#include "fovea/core/kept_rows.h"
#include "fovea/core/parallel.h"

namespace fovea {

void PointCloud::check() const {
  for_each_optional_column(*this, [&](const char* name, const auto& column) {
    if (!column.empty() && column.size() != size()) {
      throw std::logic_error(fmt::format("point cloud column '{}' has {} entries for {} points",
                                         name, column.size(), size()));
    }
  });
}

PointCloud PointCloud::select(const std::vector<std::uint32_t>& indices) const {
  PointCloud result;
  result.origin = origin;
  const auto gather = [&](const auto& from, auto& to) {
    if (from.empty()) return;
    to.resize(indices.size());
    for (std::size_t k = 0; k < indices.size(); ++k) to[k] = from[indices[k]];
  };
  gather(position, result.position);
  for_each_optional_column(*this, result,
                           [&](const char*, const auto& from, auto& to) { gather(from, to); });
  return result;
}

void PointCloud::keep(const std::vector<std::uint32_t>& indices) {
  if (indices.size() == size()) return;
  const KeptRows kept(indices);
  std::vector<std::function<void()>> columns{[&] { kept.close_up(position); }};
  for_each_optional_column(*this, [&](const char*, auto& column) {
    columns.emplace_back([&] { kept.close_up(column); });
  });
  parallel_for(columns.size(), 1, [&](std::size_t i) { columns[i](); });
}

std::size_t PointCloud::drop(const std::vector<std::uint8_t>& marks) {
  std::vector<std::uint32_t> kept;
  kept.reserve(marks.size());
  for (std::uint32_t i = 0; i < marks.size(); ++i) {
    if (marks[i] == 0) kept.push_back(i);
  }
  keep(kept);
  return marks.size() - kept.size();
}

void PointCloud::append(const PointCloud& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  if (origin != other.origin) {
    throw std::logic_error("point clouds of different origins cannot be joined");
  }
  if (sensor.empty() != other.sensor.empty()) {
    PointCloud with_sensor = other;
    sensor.resize(size(), 0);
    with_sensor.sensor.resize(other.size(), 0);
    return append(with_sensor);
  }
  for_each_optional_column(*this, other, [&](const char* name, auto& to, const auto& from) {
    if (to.empty() != from.empty()) {
      throw std::logic_error(fmt::format("only one of two joined point clouds has '{}'", name));
    }
    to.insert(to.end(), from.begin(), from.end());
  });
  position.insert(position.end(), other.position.begin(), other.position.end());
}

}  // namespace fovea
