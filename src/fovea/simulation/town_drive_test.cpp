// Drives of one town share one local frame.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "../../../tests/temporary_folder.h"
#include "fovea/drive/drive_truth.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/simulation/rig.h"
#include "fovea/simulation/simulate.h"
#include "fovea/simulation/town_route.h"
#include "fovea/world/world_file.h"

namespace fovea::town_drive_test {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// A short drive without noise, whose navigation records are of the times of the scans.
SimulationOptions short_drive(const std::string& route, double begin) {
  SimulationOptions options = simulation_options(Scene::kTown, "none");
  options.format = DriveFormat::kGeneric;
  options.frames = 3;
  options.lidar.columns = 120;
  options.camera.cameras.resize(1);
  options.camera.width = 64;
  options.camera.height = 24;
  options.camera.focal = 40;
  options.camera.cx = 31.5;
  options.camera.cy = 11.5;
  options.navigation.min_delay = options.navigation.max_delay = 0;
  options.town.route = route;
  options.town.begin = begin;
  return options;
}

std::vector<GeodeticPoint> positions(const fs::path& gnss) {
  std::vector<GeodeticPoint> result;
  std::ifstream file(gnss);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    GeodeticPoint& p = result.emplace_back();
    EXPECT_EQ(
        std::sscanf(line.c_str(), "%*[^,],%lf,%lf,%lf", &p.latitude, &p.longitude, &p.altitude), 3);
  }
  return result;
}

std::uint32_t crossing_below(const fs::path& drive) {
  const DriveTruth truth(drive);
  const World world = read_world(truth.folder());
  const Eigen::Vector2d center = town_crossing({1, 1});
  std::uint32_t crossing = 0;
  int points = 0;
  for (const TrueReturn& r : truth.returns(1)) {
    if (world.surfaces.at(r.surface) != "crossing") continue;
    const Vector3d place = truth.T_local_lidar()[1] * r.hit_lidar.cast<double>();
    if ((place.head<2>() - center).norm() > 20) continue;  // another crossing
    EXPECT_NEAR(place.z(), 0, 1e-4);
    EXPECT_LT((place.head<2>() - center).cwiseAbs().maxCoeff(), kJunction + 0.01);
    crossing = r.surface;
    ++points;
  }
  EXPECT_GT(points, 100);
  return crossing;
}

TEST(TownDrive, AllDrivesShareTheFrameOfTheTown) {
  const TemporaryFolder folder;
  // Both drive over crossing 1,1 at once.
  SimulationOptions along_x = short_drive("0,1 4,1", 75), along_y = short_drive("1,0 1,4", 51);
  along_y.pass = 5;
  const fs::path drives[] = {simulate(along_x, folder / "x"), simulate(along_y, folder / "y")};
  const LocalTangentPlane town(along_x.navigation.origin);
  const Rig rig = make_rig(along_x);
  const Vector3d imu_lidar = rig.T_imu_lidar.inverse().translation();
  for (const fs::path& drive : drives) {
    const DriveTruth truth(drive);
    EXPECT_EQ(truth.origin().latitude, along_x.navigation.origin.latitude);
    EXPECT_EQ(truth.origin().altitude, along_x.navigation.origin.altitude);
    const auto records = positions(drive / "gnss.csv");
    ASSERT_EQ(records.size(), 3u);
    for (std::size_t k = 0; k < records.size(); ++k) {
      const RigidMotion& T_local_lidar = truth.T_local_lidar()[k];
      const Eigen::Vector2d center = town_crossing({1, 1});
      EXPECT_LT((T_local_lidar.translation().head<2>() - center).norm(), 6);
      EXPECT_NEAR(T_local_lidar.translation().z(), along_x.lidar.height, 0.05);
      const GeodeticPoint expected = town.to_geodetic(T_local_lidar * imu_lidar);
      constexpr double kMillimeter = 1e-8;  // degrees
      EXPECT_NEAR(records[k].latitude, expected.latitude, kMillimeter);
      EXPECT_NEAR(records[k].longitude, expected.longitude, kMillimeter);
      EXPECT_NEAR(records[k].altitude, expected.altitude, 1e-3);
    }
  }
  EXPECT_EQ(crossing_below(drives[0]), crossing_below(drives[1]));
}

}  // namespace fovea::town_drive_test
