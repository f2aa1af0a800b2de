#include "fovea/mapping/fusion/plan_view.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fovea {
namespace {

constexpr float kColumn = 1;  // m, a column's edge

Eigen::Vector2i column_of(const Eigen::Vector3f& p) {
  return {static_cast<int>(std::floor(p.x() / kColumn)),
          static_cast<int>(std::floor(p.y() / kColumn))};
}

}  // namespace

PlanView::PlanView(std::span<const Eigen::Vector3f> points) {
  if (points.empty()) return;
  first_ = column_of(points.front());
  Eigen::Vector2i last = first_;
  for (const Eigen::Vector3f& p : points) {
    first_ = first_.cwiseMin(column_of(p));
    last = last.cwiseMax(column_of(p));
  }
  size_ = last - first_ + Eigen::Vector2i::Ones();
  columns_.resize(std::size_t(size_.x()) * std::size_t(size_.y()));
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector2i at = column_of(p) - first_;
    Column& column = columns_[std::size_t(at.y()) * std::size_t(size_.x()) + std::size_t(at.x())];
    const bool empty = column.low > column.high;
    column.low = empty ? p.z() : std::min(column.low, p.z());
    column.high = empty ? p.z() : std::max(column.high, p.z());
  }
}

bool PlanView::covers(const Eigen::Vector3f& p, float height) const {
  const Eigen::Vector2i at = column_of(p) - first_;
  if ((at.array() < 0).any() || (at.array() >= size_.array()).any()) return false;
  const Column& column =
      columns_[std::size_t(at.y()) * std::size_t(size_.x()) + std::size_t(at.x())];
  return column.low <= column.high && p.z() >= column.low - height && p.z() <= column.high + height;
}

std::vector<Eigen::Vector3f> PlanView::covered(std::span<const Eigen::Vector3f> points,
                                               const RigidMotion& T_plan_points,
                                               double height) const {
  std::vector<Eigen::Vector3f> covered;
  const Eigen::Isometry3f T = T_plan_points.cast<float>();
  std::copy_if(points.begin(), points.end(), std::back_inserter(covered),
               [&](const Eigen::Vector3f& p) { return covers(T * p, float(height)); });
  return covered;
}

}  // namespace fovea
