#include "fovea/sensor/kitti_scan.h"

#include <gtest/gtest.h>

#include <limits>

#include "../../../tests/kitti_test_drive.h"
#include "fovea/base/errors.h"

namespace fovea::kitti_scan_test {

using test::error_of;
using test::TemporaryFolder;
using test::write_scan;
using test::write_text;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

TEST(KittiScan, ReadsPointsInOrder) {
  const TemporaryFolder folder;
  write_scan(folder.path() / "a.bin", {{1, 2, 3, 0.5f}, {-4, 5, -6, 0.99f}});
  const LidarScan scan = read_kitti_scan(folder.path() / "a.bin");
  ASSERT_EQ(scan.points.size(), 2u);
  EXPECT_EQ(scan.points.position[1], Eigen::Vector3f(-4, 5, -6));
  EXPECT_EQ(scan.points.intensity, (std::vector<float>{0.5f, 0.99f}));
  EXPECT_EQ(scan.dropped.total(), 0u);
  EXPECT_NO_THROW(scan.points.check());
}

TEST(KittiScan, DropsAndCountsWhatNoLidarMeasures) {
  const TemporaryFolder folder;
  write_scan(folder.path() / "a.bin", {{kNan, 0, 0, 0},
                                       {0, kInf, 0, 0},
                                       {0, 0, -kInf, 0},
                                       {0, 0, 0, kNan},
                                       {0, 1000.5f, 0, 0},
                                       {0, 0, -1e30f, 0},
                                       {7, 8, 9, 0.1f}});
  const LidarScan scan = read_kitti_scan(folder.path() / "a.bin");
  EXPECT_EQ(scan.dropped.total(), 6u);
  ASSERT_EQ(scan.points.size(), 1u);
  EXPECT_EQ(scan.points.position[0], Eigen::Vector3f(7, 8, 9));
  EXPECT_EQ(scan.points.intensity.size(), 1u);
}

TEST(KittiScan, OnesThatAreDroppedTakeNoneOfTheirNeighboursAlong) {
  const TemporaryFolder folder;
  std::vector<std::array<float, 4>> points;
  for (int i = 0; i < 1000; ++i) points.push_back({float(i + 1), 0, 0, float(i) / 1000});
  points[300][1] = kNan;
  points[999] = {0, 0, 0, 0.5f};  // nothing came back
  write_scan(folder.path() / "a.bin", points);
  const LidarScan scan = read_kitti_scan(folder.path() / "a.bin");
  EXPECT_EQ(scan.dropped.total(), 2u);
  ASSERT_EQ(scan.points.size(), 998u);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const std::array<float, 4>& point = points[i < 300 ? i : i + 1];
    EXPECT_EQ(scan.points.position[i], Eigen::Vector3f(point[0], 0, 0));
    EXPECT_EQ(scan.points.intensity[i], point[3]);
  }
}

TEST(KittiScan, DamagedFilesAreErrorsThatNameThem) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.bin";
  const auto message = [&] { return error_of<InputError>([&] { read_kitti_scan(file); }); };
  EXPECT_NE(message().find("a.bin"), std::string::npos);  // missing
  write_text(file, "");
  EXPECT_NE(message().find("the scan is empty"), std::string::npos);
  write_text(file, std::string(16 * 3 + 5, '\0'));
  EXPECT_NE(message().find("53 bytes"), std::string::npos);
  write_scan(file, {{kNan, 0, 0, 0}});
  EXPECT_NE(message().find("no usable point"), std::string::npos);
  EXPECT_NE(message().find("a.bin"), std::string::npos);
}

}  // namespace fovea::kitti_scan_test
