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
  EXPECT_EQ(scan.dropped, 0u);
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
  EXPECT_EQ(scan.dropped, 6u);
  ASSERT_EQ(scan.points.size(), 1u);
  EXPECT_EQ(scan.points.position[0], Eigen::Vector3f(7, 8, 9));
  EXPECT_EQ(scan.points.intensity.size(), 1u);
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
