#include "fovea/mapping/registration/pair_equations.h"

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

using Lanes3 = std::array<Lanes, 3>;

constexpr std::size_t kGrain = 128;  // blocks

inline Lanes dot(const Lanes3& a, const Lanes3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Sums of the pairs' terms, lane by lane. The perturbation is in target axes, which saves a
/// rotation of M for each pair.
struct Sums {
  std::array<Lanes, 21> H{}, H_planes{};  // upper triangles, row by row
  std::array<Lanes, 6> b{};
  Lanes error{}, squared_distance{}, weight{};
};

class Accumulator {
 public:
  Accumulator(const RigidMotion& T, double robust_width)
      : R_(T.linear().cast<float>()),
        t_(T.translation().cast<float>()),
        width2_(static_cast<float>(robust_width * robust_width)) {}

  void add(const PairBlock& pair, Sums& sums) const {
    Lanes3 arm, d;  // rotated source point; error
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      arm[k] = R_(i, 0) * pair.source[0] + R_(i, 1) * pair.source[1] + R_(i, 2) * pair.source[2];
      d[k] = arm[k] + t_[i] - pair.target[k];
    }
    const auto& m = pair.information;
    const std::array<Lanes3, 3> M{Lanes3{m[0], m[1], m[2]}, {m[1], m[3], m[4]}, {m[2], m[4], m[5]}};
    const Lanes3 Md{dot(M[0], d), dot(M[1], d), dot(M[2], d)};
    const Lanes squared_error = dot(d, Md);

    // Geman-McClure: rho(e^2) = w^2 e^2 / (w^2 + e^2). Its derivative is the weight of the pair.
    Lanes share = all_lanes(1);
    if (width2_ > 0) share = width2_ / (width2_ + squared_error);
    const Lanes robust = share * share * pair.valid;
    sums.error += share * squared_error * pair.valid;
    sums.squared_distance += dot(d, d) * pair.valid;
    sums.weight += robust;

    // Jacobian J of d in target axes: [-hat(arm), I]. H += J^T M J and b += J^T M d.
    std::array<Lanes3, 3> AM;  // AM[j]: arm x column j of M
    for (std::size_t j = 0; j < 3; ++j) AM[j] = cross(arm, M[j]);
    const Lanes3 torque = cross(arm, Md);
    for (std::size_t i = 0; i < 3; ++i) {
      sums.b[i] += robust * torque[i];
      sums.b[3 + i] += robust * Md[i];
    }
    std::size_t k = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Lanes3 row{AM[0][i], AM[1][i], AM[2][i]};
      const Lanes3 rotated = cross(arm, row);  // row i of hat(arm) M hat(arm)^T
      for (std::size_t j = i; j < 3; ++j) sums.H[k++] += robust * rotated[j];
      for (std::size_t j = 0; j < 3; ++j) sums.H[k++] += robust * row[j];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = i; j < 3; ++j) sums.H[k++] += robust * M[i][j];
    }

    const Lanes3 rotation_slope = cross(arm, pair.normal);
    // Gradient of the distance to the target's plane.
    const std::array<Lanes, 6> slope{rotation_slope[0], rotation_slope[1], rotation_slope[2],
                                     pair.normal[0],    pair.normal[1],    pair.normal[2]};
    k = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      const Lanes weighted = robust * slope[i];
      for (std::size_t j = i; j < 6; ++j) sums.H_planes[k++] += weighted * slope[j];
    }
  }

 private:
  Eigen::Matrix3f R_;
  Eigen::Vector3f t_;
  float width2_;
};

struct Totals {
  std::array<double, 21> H{}, H_planes{};
  std::array<double, 6> b{};
  double error = 0, squared_distance = 0, weight = 0;

  Totals() = default;
  explicit Totals(const Sums& sums) {
    const auto total = [](const Lanes& lanes) { return double{sum_of_lanes(lanes)}; };
    for (std::size_t i = 0; i < H.size(); ++i) H[i] = total(sums.H[i]);
    for (std::size_t i = 0; i < H.size(); ++i) H_planes[i] = total(sums.H_planes[i]);
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = total(sums.b[i]);
    error = total(sums.error);
    squared_distance = total(sums.squared_distance);
    weight = total(sums.weight);
  }
  Totals& operator+=(const Totals& other) {
    for (std::size_t i = 0; i < H.size(); ++i) H[i] += other.H[i];
    for (std::size_t i = 0; i < H.size(); ++i) H_planes[i] += other.H_planes[i];
    for (std::size_t i = 0; i < b.size(); ++i) b[i] += other.b[i];
    error += other.error;
    squared_distance += other.squared_distance;
    weight += other.weight;
    return *this;
  }
};

/// Rotates the equations from target axes to source axes, those of the right perturbation.
Eigen::Matrix<double, 6, 6> to_source_axes(const std::array<double, 21>& triangle,
                                           const Eigen::Matrix3d& R) {
  Eigen::Matrix<double, 6, 6> m;
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) m(i, j) = m(j, i) = triangle[k++];
  }
  for (int i : {0, 3}) {
    for (int j : {0, 3}) m.block<3, 3>(i, j) = (R.transpose() * m.block<3, 3>(i, j) * R).eval();
  }
  return m;
}

}  // namespace

PairBlocks::PairBlocks(std::span<const Pair> all) {
  const auto put = [](auto& columns, std::size_t lane, const auto& values) {
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i][lane] = values[Eigen::Index(i)];
  };
  for (const Pair& pair : all) {
    if (pair.target_index == Pair::kNone) continue;
    const std::size_t lane = pairs++ % kLanes;
    if (lane == 0) blocks.emplace_back();
    PairBlock& block = blocks.back();
    put(block.source, lane, pair.source);
    put(block.target, lane, pair.target);
    put(block.normal, lane, pair.normal);
    put(block.information, lane, pair.information);
    block.valid[lane] = 1;
  }
}

PairEquations accumulate(const PairBlocks& pairs, const RigidMotion& T_target_source,
                         double robust_width) {
  const Accumulator accumulator(T_target_source, robust_width);
  const Totals totals =
      parallel_sum(pairs.blocks.size(), kGrain, Totals(), [&](std::size_t begin, std::size_t end) {
        Sums sums;
        for (std::size_t i = begin; i < end; ++i) accumulator.add(pairs.blocks[i], sums);
        return Totals(sums);
      });
  const Eigen::Matrix3d R = T_target_source.linear();
  PairEquations equations;
  equations.H = to_source_axes(totals.H, R);
  equations.H_planes = to_source_axes(totals.H_planes, R);
  const Eigen::Map<const Twist> b(totals.b.data());
  equations.b.head<3>() = R.transpose() * b.head<3>();
  equations.b.tail<3>() = R.transpose() * b.tail<3>();
  equations.error = totals.error;
  equations.squared_distance = totals.squared_distance;
  equations.weight = totals.weight;
  equations.pairs = pairs.pairs;
  return equations;
}

}  // namespace fovea
