#include "fovea/drive/motion_keys.h"

#include <fmt/format.h>

#include <cmath>

#include "fovea/drive/plausible.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

template <int N>
Eigen::Matrix<double, N, 1> numbers_of(const std::vector<double>& numbers, const std::string& key) {
  if (numbers.size() == N) return Eigen::Map<const Eigen::Matrix<double, N, 1>>(numbers.data());
  reject_key(fmt::format("there are {} numbers, not {}", numbers.size(), N), key,
             "give x y z, or a quaternion x y z w");
}

void read_matrix(const std::vector<double>& m, const std::string& key, Eigen::Matrix3d& R,
                 Eigen::Vector3d& t) {
  if (m.size() != 12 && m.size() != 16) {
    reject_key(fmt::format("there are {} numbers, not 12 or 16", m.size()), key,
               "give a matrix of 3 x 4 or 4 x 4, row by row");
  }
  if (m.size() == 16 && !(m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1)) {
    reject_key("the matrix's last row is not 0 0 0 1", key, "give a rigid motion");
  }
  for (int row = 0; row < 3; ++row) {
    const double* first = m.data() + 4 * row;
    R.row(row) << first[0], first[1], first[2];
    t[row] = first[3];
  }
}

Eigen::Matrix3d read_quaternion(const Eigen::Vector4d& q, const std::string& key) {
  if (!(std::abs(q.norm() - 1) < 0.01)) {
    reject_key("the quaternion is not of length 1", key, "give x y z w");
  }
  return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
}

}  // namespace

[[noreturn]] void reject_key(std::string_view problem, const std::string& key,
                             std::string_view remedy) {
  throw ConfigError(problem, key, remedy);
}

void check_key(const std::string& key, double value, double low, double high) {
  if (value >= low && value <= high) return;
  reject_key(fmt::format("{:.6g} is out of range", value), key,
             fmt::format("give {:g} to {:g}", low, high));
}

void check_lever(const std::string& key, const Eigen::Vector3d& t) {
  if (t.norm() <= kMaxLever) return;
  reject_key(fmt::format("the distance is {:.6g} m, over {:g} m", t.norm(), kMaxLever), key,
             "give it in meters: these are likely millimeters");
}

void MotionText::visit(SettingVisitor& visit) {
  // A table under the key is the other form.
  visit(key + ".translation", translation);
  visit(key + ".rotation", rotation);
  if (!translation && !rotation) visit(key, matrix);
}

RigidMotion MotionText::motion() const {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  if (matrix) {
    read_matrix(*matrix, key, R, t);
  } else {
    if (translation) t = numbers_of<3>(*translation, key + ".translation");
    if (rotation)
      R = read_quaternion(numbers_of<4>(*rotation, key + ".rotation"), key + ".rotation");
  }
  if (!is_rotation(R, kRotationTolerance)) {
    reject_key("the matrix is not a rotation", key, "give a rotation beside the translation");
  }
  check_lever(key, t);
  RigidMotion T = RigidMotion::Identity();
  T.linear() = nearest_rotation(R);
  T.translation() = t;
  return T;
}

void MotionKeys::visit(SettingVisitor& visitor) {
  forward.visit(visitor);
  backward.visit(visitor);
}

std::optional<RigidMotion> MotionKeys::motion() const {
  if (forward.given() && backward.given()) {
    reject_key("the motion is given both ways", backward.key, "remove it, or " + forward.key);
  }
  if (forward.given()) return forward.motion();
  if (backward.given()) return backward.motion().inverse();
  return std::nullopt;
}

}  // namespace fovea
