#include "fovea/base/point_cloud.h"

#include <fmt/format.h>

#include <stdexcept>

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
    to.reserve(indices.size());
    for (const std::uint32_t i : indices) to.push_back(from[i]);
  };
  gather(position, result.position);
  for_each_optional_column(*this, result,
                           [&](const char*, const auto& from, auto& to) { gather(from, to); });
  return result;
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
  for_each_optional_column(*this, other, [&](const char* name, auto& to, const auto& from) {
    if (to.empty() != from.empty()) {
      throw std::logic_error(fmt::format("only one of two joined point clouds has '{}'", name));
    }
    to.insert(to.end(), from.begin(), from.end());
  });
  position.insert(position.end(), other.position.begin(), other.position.end());
}

}  // namespace fovea
