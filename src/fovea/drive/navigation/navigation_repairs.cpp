#include "fovea/drive/navigation/navigation_repairs.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "fovea/core/angle.h"
#include "fovea/core/median.h"

namespace fovea {
namespace {

/// Applies a function to the poses T_local_lidar of all steps.
template <class F>
NavigationSteps changed(NavigationSteps steps, F&& change) {
  for (NavigationStep& step : steps) {
    step.T_local_first = change(step.T_local_first);
    step.T_local_last = change(step.T_local_last);
  }
  return steps;
}

/// Corrects latitude and longitude in radians.
Eigen::Vector3d from_radians(const Eigen::Vector3d& p, const GeodeticPoint& origin) {
  const double stretch = std::cos(origin.latitude) / std::cos(origin.latitude * kDegree);
  return {p.x() / kDegree * stretch, p.y() / kDegree, p.z()};
}

/// Swaps latitude and longitude.
Eigen::Vector3d swapped(const Eigen::Vector3d& p, const GeodeticPoint& origin) {
  return {p.y() * std::cos(origin.longitude * kDegree), p.x() / std::cos(origin.latitude * kDegree),
          p.z()};
}

/// Rz(yaw) Ry(pitch) Rx(roll), as docs/drives.md defines them.
struct Angles {
  double yaw = 0, pitch = 0, roll = 0;
};

Angles angles_of(const Eigen::Matrix3d& R) {
  return {std::atan2(R(1, 0), R(0, 0)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
          std::atan2(R(2, 1), R(2, 2))};
}

Eigen::Matrix3d rotation_of(const Angles& angles) {
  return (Eigen::AngleAxisd(angles.yaw, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(angles.pitch, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles.roll, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// Errors of positions and attitudes of the body.
class BodyRepairs {
 public:
  BodyRepairs(const NavigationSteps& steps, const RigidMotion& T_body_lidar)
      : steps_(steps), T_body_lidar_(T_body_lidar) {}

  /// Changes positions by a linear function. Adds a second repair in which the heading, computed
  /// from positions, changes too.
  template <class F>
  void move(const char* error, F&& change) {
    for (const bool turns_heading : {false, true}) {
      add(error, [&](RigidMotion T_local_body) {
        const Eigen::Vector3d forward = T_local_body.linear().col(0), direction = change(forward);
        const double turn =
            std::atan2(direction.y(), direction.x()) - std::atan2(forward.y(), forward.x());
        if (turns_heading) {
          T_local_body.linear() =
              Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * T_local_body.linear();
        }
        T_local_body.translation() = change(Eigen::Vector3d(T_local_body.translation()));
        return T_local_body;
      });
    }
  }

  /// Changes angles of the attitude.
  template <class F>
  void turn(const char* error, F&& change) {
    add(error, [&](RigidMotion T_local_body) {
      T_local_body.linear() = rotation_of(change(angles_of(T_local_body.linear())));
      return T_local_body;
    });
  }

  /// Changes the pose of the body.
  template <class F>
  void add(const char* error, F&& change) {
    const RigidMotion T_lidar_body = T_body_lidar_.inverse();
    repairs_.push_back({error, changed(steps_, [&](const RigidMotion& T_local_lidar) {
                          return RigidMotion(change(T_local_lidar * T_lidar_body) * T_body_lidar_);
                        })});
  }

  std::vector<NavigationRepair> take() { return std::move(repairs_); }

 private:
  const NavigationSteps& steps_;
  const RigidMotion& T_body_lidar_;
  std::vector<NavigationRepair> repairs_;
};

}  // namespace

std::vector<NavigationRepair> repaired_positions(const NavigationSteps& steps,
                                                 const GeodeticPoint& origin,
                                                 const RigidMotion& T_body_lidar) {
  BodyRepairs repairs(steps, T_body_lidar);
  constexpr double kQuarter = std::numbers::pi / 2;
  repairs.move("latitude and longitude are in radians, not in degrees",
               [&](const Eigen::Vector3d& p) { return from_radians(p, origin); });
  repairs.move("latitude and longitude are swapped",
               [&](const Eigen::Vector3d& p) { return swapped(p, origin); });
  repairs.turn("yaw grows clockwise from north, not counter-clockwise from east",
               [](const Angles& a) { return Angles{kQuarter - a.yaw, a.pitch, a.roll}; });
  repairs.turn("yaw counts from north, not from east",
               [](const Angles& a) { return Angles{a.yaw + kQuarter, a.pitch, a.roll}; });
  repairs.turn("roll, pitch and yaw are in degrees, not in radians", [](const Angles& a) {
    return Angles{a.yaw * kDegree, a.pitch * kDegree, a.roll * kDegree};
  });
  repairs.add("attitudes are of east-north-up in the body, not of the body", [](RigidMotion T) {
    T.linear() = Eigen::Matrix3d(T.linear().transpose());
    return T;
  });
  return repairs.take();
}

NavigationRepair repaired_inversion(const NavigationSteps& steps, const RigidMotion& T_body_lidar) {
  const RigidMotion T_lidar_body = T_body_lidar.inverse();
  std::vector<RigidMotion> motions;  // of the body, with the world's origin at 0
  Eigen::Matrix3d A = 1e-6 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const NavigationStep& step : steps) {
    motions.push_back(step.T_local_first * T_lidar_body *
                      (step.T_local_last * T_lidar_body).inverse());
    const RigidMotion expected = T_body_lidar * step.T_first_last * T_lidar_body;
    const Eigen::Matrix3d J = Eigen::Matrix3d::Identity() - motions.back().linear();
    A += J.transpose() * J;
    b += J.transpose() * (expected.translation() - motions.back().translation());
  }
  const Eigen::Vector3d origin = A.ldlt().solve(b);
  NavigationRepair repair{"poses are T_body_world, not T_world_body", steps};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    RigidMotion motion = motions[i];
    motion.translation() += origin - motion.linear() * origin;
    repair.steps[i].T_local_first.setIdentity();
    repair.steps[i].T_local_last = T_lidar_body * motion * T_body_lidar;
  }
  return repair;
}

NavigationRepair repaired_place(const NavigationSteps& steps, const RigidMotion& T_body_lidar) {
  const RigidMotion T_lidar_body = T_body_lidar.inverse();
  return {"T_body_lidar is inverted", changed(steps, [&](const RigidMotion& T) {
            return RigidMotion(T * T_lidar_body * T_lidar_body);
          })};
}

NavigationRepair repaired_scale(const NavigationSteps& steps) {
  std::vector<double> ratios;
  for (const NavigationStep& step : steps) {
    ratios.push_back(step.by_navigation().translation().norm() /
                     step.T_first_last.translation().norm());
  }
  const double scale = median_of(std::move(ratios));
  return {fmt::format("lengths are {:.3g} times the true ones, in another unit", scale),
          changed(steps, [&](RigidMotion T) {
            T.translation() /= scale;
            return T;
          })};
}

NavigationRepair repaired_turn(const NavigationSteps& steps) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const NavigationStep& step : steps) {
    covariance += step.by_navigation().translation() * step.T_first_last.translation().transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d R_navigation_scans;
  if (svd.singularValues()[1] < 0.01 * svd.singularValues()[0]) {
    // A straight path determines only one direction: uses the smallest rotation.
    R_navigation_scans =
        Eigen::Quaterniond::FromTwoVectors(svd.matrixV().col(0), svd.matrixU().col(0))
            .toRotationMatrix();
  } else {
    const Eigen::Matrix3d UVt = svd.matrixU() * svd.matrixV().transpose();
    const Eigen::Vector3d signs(1, 1, UVt.determinant());
    R_navigation_scans = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  }
  return {fmt::format("T_body_lidar or the attitudes are turned by {:.0f} degrees",
                      rotation_angle(R_navigation_scans) / kDegree),
          changed(steps, [&](RigidMotion T) {
            T.linear() = T.linear() * R_navigation_scans;
            return T;
          })};
}

}  // namespace fovea
