#include "fovea/drive/kitti/kitti_scan.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "../../../../tests/kitti_test_drive.h"
#include "fovea/errors.h"

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

/// A turn of 16 rings with x y z intensity ring, as nuScenes has it.
std::vector<std::array<float, 5>> ring_points() {
  std::vector<std::array<float, 5>> points;
  for (int i = 0; i < 1600; ++i) {
    const float azimuth = float(i / 16) * 0.0628f, ring = float(i % 16);
    points.push_back(
        {20 * std::cos(azimuth), 20 * std::sin(azimuth), 0.4f * (ring - 10), float(i % 256), ring});
  }
  return points;
}

template <std::size_t N>
std::string bytes_of(const std::vector<std::array<float, N>>& points) {
  return {reinterpret_cast<const char*>(points.data()), points.size() * sizeof points[0]};
}

TEST(KittiScan, PointsOfTwentyBytesHaveRings) {
  const TemporaryFolder folder;
  const auto points = ring_points();
  write_text(folder.path() / "a.bin", bytes_of(points));  // 2000 points of 16 bytes by its size
  const LidarScan scan = read_kitti_scan(folder.path() / "a.bin");
  ASSERT_EQ(scan.points.size(), points.size());
  EXPECT_EQ(scan.dropped.total(), 0u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [x, y, z, intensity, ring] = points[i];
    ASSERT_EQ(scan.points.position[i], Eigen::Vector3f(x, y, z));
    ASSERT_EQ(scan.points.intensity[i], intensity);
    ASSERT_EQ(float(scan.points.ring[i]), ring);
  }
}

TEST(KittiScan, PointsOfSixteenBytesAreReadAsSuchWhateverTheFilesSize) {
  const TemporaryFolder folder;
  std::vector<std::array<float, 4>> points;
  for (const auto& [x, y, z, intensity, ring] : ring_points())
    points.push_back({x, y, z, intensity});
  for (const std::size_t count : {1600u, 1595u, 1591u, 80u, 5u}) {  // 20 divides some sizes
    points.resize(count);
    write_text(folder.path() / "a.bin", bytes_of(points));
    const LidarScan scan = read_kitti_scan(folder.path() / "a.bin");
    ASSERT_EQ(scan.points.size(), count);
    EXPECT_TRUE(scan.points.ring.empty());
    EXPECT_EQ(scan.points.intensity.back(), points.back()[3]);
  }
}

TEST(KittiScan, PointsOfOtherSizesAreRefusedByTheirSize) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& bytes) {
    write_text(folder.path() / "a.bin", bytes);
    return error_of<InputError>([&] { read_kitti_scan(folder.path() / "a.bin"); });
  };
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 5>> timed;
  std::vector<std::array<float, 6>> both;
  for (const auto& [x, y, z, intensity, ring] : ring_points()) {
    positions.push_back({x, y, z});
    timed.push_back({x, y, z, intensity, 1e-3f * (ring + 0.5f)});
    both.push_back({x, y, z, intensity, ring, 1e-3f * (ring + 0.5f)});
  }
  EXPECT_NE(message(bytes_of(positions)).find("3 numbers each (12 bytes)"), std::string::npos);
  EXPECT_NE(message(bytes_of(both)).find("6 numbers each (24 bytes)"), std::string::npos);
  EXPECT_NE(message(bytes_of(timed)).find("not x y z intensity ring"), std::string::npos);
  const std::string cut = bytes_of(ring_points()).substr(0, 16 * 1999);  // no multiple of 20
  EXPECT_NE(message(cut).find("no multiple of the 20"), std::string::npos);
}

}  // namespace fovea::kitti_scan_test
