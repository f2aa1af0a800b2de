// Registration of real scans: the sample drive at 1.0 to 1.2 m a step, straight ahead.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "../../../../tests/kitti_sample.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/registration/local_map.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea::registration_kitti_test {

/// A raw scan, thinned to one point in 0.25 m. At full density, rings pull toward no motion.
std::vector<Eigen::Vector3f> thinned_scan(const std::filesystem::path& drive, int frame) {
  char name[32];
  std::snprintf(name, sizeof name, "%010d.bin", frame);
  std::ifstream file(drive / "velodyne_points" / "data" / name, std::ios::binary);
  std::vector<Eigen::Vector3f> points, thinned;
  std::array<float, 4> record;  // x y z reflectance
  while (file.read(reinterpret_cast<char*>(record.data()), sizeof record)) {
    points.emplace_back(record[0], record[1], record[2]);
  }
  for (const std::uint32_t i : voxel_sample(points, 0.25f)) thinned.push_back(points[i]);
  return thinned;
}

struct Scan {
  RegistrationCloud cloud;
  PointIndex index;
  explicit Scan(RegistrationCloud prepared) : cloud(std::move(prepared)), index(cloud.points) {}
};

TEST(RegistrationKitti, NeighboringScansAlignFromIdentity) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  for (const RegistrationMethod method :
       {RegistrationMethod::kGicp, RegistrationMethod::kPointToPlane,
        RegistrationMethod::kPointToPoint}) {
    RegistrationOptions options;
    options.method = method;
    options.max_iterations = 100;
    const bool point_to_point = method == RegistrationMethod::kPointToPoint;
    for (const int frame : {2, 20, 38}) {
      const Scan a(prepare_cloud(thinned_scan(drive, frame), options));
      const Scan b(prepare_cloud(thinned_scan(drive, frame + 1), options));
      const Scan c(prepare_cloud(thinned_scan(drive, frame + 2), options));
      ASSERT_GT(a.cloud.points.size(), 10'000u);
      const auto align = [&](const Scan& target, const Scan& source, const RigidMotion& guess) {
        const RegistrationResult result =
            register_clouds(target.cloud, target.index, source.cloud, guess, options);
        EXPECT_TRUE(result.converged) << "frame " << frame;
        EXPECT_EQ(result.degenerate_directions, 0);
        return result.T_target_source;
      };
      const RigidMotion T_a_b = align(a, b, RigidMotion::Identity());
      const RigidMotion T_b_c = align(b, c, RigidMotion::Identity());
      for (const RigidMotion& T : {T_a_b, T_b_c}) {
        const Eigen::Vector3d step = T.translation();
        // The ring pattern of the scans pulls point to point by a few centimeters.
        EXPECT_GT(step.norm(), point_to_point ? 0.95 : 1.0) << "frame " << frame;
        EXPECT_LT(step.norm(), point_to_point ? 1.3 : 1.2) << "frame " << frame;
        EXPECT_GT(step.x(), 0.99 * step.norm()) << "frame " << frame;
        EXPECT_LT(rotation_angle(T.linear()), 0.02);
      }
      if (point_to_point) continue;  // the rings' pull grows with the step
      const RigidMotion T_a_c = align(a, c, T_a_b * T_b_c);
      const Twist loop = log_se3((T_a_b * T_b_c).inverse() * T_a_c);
      EXPECT_LT(loop.tail<3>().norm(), 0.05) << "frame " << frame;
      EXPECT_LT(loop.head<3>().norm(), 0.003) << "frame " << frame;
    }
  }
}

TEST(RegistrationKitti, LocalMapCarriesTheDrive) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  const RegistrationOptions options;
  LocalMap map{LocalMapOptions()};
  RigidMotion T_local_lidar = RigidMotion::Identity(), last_step = RigidMotion::Identity();
  std::size_t iterations = 0;
  constexpr int kFrames = 12;
  for (int frame = 0; frame < kFrames; ++frame) {
    RegistrationCloud cloud = prepare_cloud(thinned_scan(drive, frame), options);
    if (frame > 0) {
      const RegistrationResult result = register_to(map, cloud, T_local_lidar * last_step, options);
      EXPECT_TRUE(result.converged) << "frame " << frame;
      EXPECT_EQ(result.degenerate_directions, 0);
      iterations += static_cast<std::size_t>(result.iterations);
      last_step = T_local_lidar.inverse() * result.T_target_source;
      T_local_lidar = result.T_target_source;
      EXPECT_GT(last_step.translation().x(), 1.0) << "frame " << frame;
      EXPECT_LT(last_step.translation().x(), 1.2) << "frame " << frame;
    }
    map.add(std::move(cloud.points), T_local_lidar);
  }
  EXPECT_LT(iterations, 10u * kFrames);
}

// From a guess several meters behind, few pairs are correct, and plain steps are short.
TEST(RegistrationKitti, AitkenAccelerationFindsAScanFarAheadInFewRounds) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  RegistrationOptions options;
  options.max_points = 12000;
  options.robust_width = 0.1;
  const auto cloud = [&](int frame) {
    return prepare_cloud(thinned_scan(drive, frame), options, 0.25);
  };
  LocalMap map{LocalMapOptions()};
  RigidMotion T_local_lidar = RigidMotion::Identity(), step = RigidMotion::Identity();
  map.add(cloud(0).points, T_local_lidar);
  for (int frame = 1; frame < 10; ++frame) {
    RegistrationCloud source = cloud(frame);
    const RigidMotion found =
        register_to(map, source, T_local_lidar * step, options).T_target_source;
    step = T_local_lidar.inverse() * found;
    T_local_lidar = found;
    map.add(std::move(source.points), T_local_lidar);
  }
  RegistrationOptions plain = options;
  plain.policies.aitken_acceleration = false;
  for (const int frame : {12, 13, 14}) {
    const RegistrationCloud source = cloud(frame);
    // Several guesses, so that success is not by chance.
    int iterations = 0, plain_iterations = 0;
    for (int k = -3; k <= 3; ++k) {
      const RigidMotion guess =
          T_local_lidar * RigidMotion(Eigen::Translation3d(0.02 * k, 0.007 * (k % 3), 0));
      const RegistrationResult result = register_to(map, source, guess, options);
      EXPECT_TRUE(result.converged) << "frame " << frame << ", " << k;
      iterations += result.iterations;
      plain_iterations += register_to(map, source, guess, plain).iterations;
      const double ahead = (T_local_lidar.inverse() * result.T_target_source).translation().x();
      EXPECT_NEAR(ahead, 1.1 * (frame - 9), 0.05) << "frame " << frame << ", " << k;
    }
    EXPECT_LT(iterations, 0.7 * plain_iterations) << "frame " << frame;
  }
}

}  // namespace fovea::registration_kitti_test
