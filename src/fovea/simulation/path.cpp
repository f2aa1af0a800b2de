#include "fovea/simulation/path.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace fovea {

Path::Path(std::function<double(double)> heading, std::function<double(double)> curvature,
           double begin, double end, const Eigen::Vector2d& start)
    : heading_(std::move(heading)), curvature_(std::move(curvature)), begin_(begin), end_(end) {
  if (!(begin <= 0 && end >= 0 && std::isfinite(end - begin))) {
    throw std::invalid_argument("a path must hold s = 0");
  }
  const auto steps = static_cast<std::size_t>(std::ceil((end - begin) / kStep));
  knots_.reserve(steps + 1);
  knots_.emplace_back(Eigen::Vector2d::Zero());
  for (std::size_t i = 0; i < steps; ++i) {
    const double s = begin_ + static_cast<double>(i) * kStep;
    knots_.push_back(knots_.back() + way_between(s, s + kStep));
  }
  const Eigen::Vector2d shift = start - at(0).position;
  for (Eigen::Vector2d& knot : knots_) knot += shift;
}

Path::Point Path::at(double s) const {
  if (!(s >= begin_ && s <= end_)) throw std::out_of_range("a way beyond the path's range");
  const auto knot = static_cast<std::size_t>((s - begin_) / kStep);
  const double from = begin_ + static_cast<double>(knot) * kStep;
  return {knots_[knot] + way_between(from, s), heading_(s), curvature_(s)};
}

Eigen::Vector2d Path::offset(double s, double d) const {
  const Point point = at(s);
  return point.position + d * Eigen::Vector2d(-std::sin(point.heading), std::cos(point.heading));
}

Eigen::Vector2d Path::way_between(double from, double to) const {
  // Gauss-Legendre with 6 points: exact for polynomials of degree 11.
  static constexpr std::array<std::pair<double, double>, 3> kNodeAndWeight{
      {{0.2386191860831969, 0.4679139345726910},
       {0.6612093864662645, 0.3607615730481386},
       {0.9324695142031521, 0.1713244923791704}}};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& [node, weight] : kNodeAndWeight) {
    for (const double x : {-node, node}) {
      const double heading = heading_(middle + half * x);
      sum += weight * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    }
  }
  return half * sum;
}

}  // namespace fovea
