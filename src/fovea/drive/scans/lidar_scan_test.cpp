#include "fovea/drive/scans/lidar_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <limits>

#include "../../../../tests/kitti_test_drive.h"
#include "fovea/errors.h"

namespace fovea::lidar_scan_test {

using test::error_of;
using test::write_text;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr TimeNs kStamp = 1'700'000'000'500'000'000;

class LidarScanTest : public testing::Test {
 protected:
  LidarScan read(const std::string& name, const std::string& content) const {
    write_text(folder_ / name, content);
    return read_lidar_scan(folder_ / name, format_, kStamp);
  }

  TemporaryFolder folder_;
  ScanFormat format_;
};

std::string pcd(const std::string& fields, const std::string& sizes, const std::string& types,
                int points, const std::string& data) {
  return "VERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nWIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nDATA " + data;
}

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

TEST_F(LidarScanTest, WholeTimesAreNanosecondsAndRealOnesSeconds) {
  std::string ouster = pcd("x y z intensity t ring", "4 4 4 4 4 2", "F F F F U U", 2, "binary\n");
  for (const std::uint32_t t : {0u, 99'000'000u}) {
    for (const float value : {1.0f, 2.0f, 3.0f, 0.5f}) put(ouster, value);
    put(ouster, t);
    put(ouster, std::uint16_t{7});
  }
  const LidarScan whole = read("a.pcd", ouster);
  EXPECT_THAT(whole.points.time, ElementsAre(0.0f, 0.099f));
  EXPECT_THAT(whole.points.intensity, ElementsAre(0.5f, 0.5f));
  EXPECT_EQ(whole.points.position[1], Eigen::Vector3f(1, 2, 3));
  EXPECT_NO_THROW(whole.points.check());

  const LidarScan real =
      read("b.PCD", pcd("x y z time", "4 4 4 4", "F F F F", 2, "ascii\n1 2 3 -0.05\n4 5 6 0.05\n"));
  EXPECT_THAT(real.points.time, ElementsAre(-0.05f, 0.05f));
  EXPECT_THAT(real.points.intensity, ElementsAre(0, 0));
}

TEST_F(LidarScanTest, TheFormatSaysWhatTheFileDoesNot) {
  format_.time_unit = 1e-6;
  format_.intensity_max = 200;
  const LidarScan scan = read(
      "a.pcd", pcd("x y z intensity t", "4 4 4 4 4", "F F F F U", 1, "ascii\n1 2 3 100 40000\n"));
  EXPECT_THAT(scan.points.time, ElementsAre(0.04f));
  EXPECT_THAT(scan.points.intensity, ElementsAre(0.5f));

  format_ = {};
  format_.time_reference = TimeReference::kAbsolute;
  std::string bytes = pcd("x y z timestamp", "4 4 4 8", "F F F F", 2, "binary\n");
  for (const double time : {1'700'000'000.45, 1'700'000'000.55}) {
    for (const float value : {1.0f, 2.0f, 3.0f}) put(bytes, value);
    put(bytes, time);
  }
  const LidarScan absolute = read("b.pcd", bytes);
  ASSERT_EQ(absolute.points.time.size(), 2u);
  EXPECT_NEAR(absolute.points.time[0], -0.05, 1e-6);
  EXPECT_NEAR(absolute.points.time[1], 0.05, 1e-6);
}

TEST_F(LidarScanTest, ReadsPly) {
  const std::string header =
      "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property float intensity\nproperty uint offset_time\nend_header\n";
  const LidarScan text =
      read("a.ply", "ply\nformat ascii 1.0\n" + header + "1 2 3 0.25 0\n4 5 6 1 50000000\n");
  EXPECT_THAT(text.points.time, ElementsAre(0.0f, 0.05f));
  EXPECT_THAT(text.points.intensity, ElementsAre(0.25f, 1.0f));
  std::string bytes = "ply\nformat binary_little_endian 1.0\n" + header;
  for (const std::uint32_t t : {0u, 50'000'000u}) {
    for (const float value : {1.0f, 2.0f, 3.0f, 0.25f}) put(bytes, value);
    put(bytes, t);
  }
  EXPECT_THAT(read("b.ply", bytes).points.time, ElementsAre(0.0f, 0.05f));
}

TEST_F(LidarScanTest, BinScansHaveNoTimes) {
  test::write_scan(folder_ / "a.bin", {{1, 2, 3, 0.5f}});
  const LidarScan scan = read_lidar_scan(folder_ / "a.bin", {}, kStamp);
  EXPECT_TRUE(scan.points.time.empty());
  EXPECT_THAT(scan.points.intensity, ElementsAre(0.5f));
}

TEST_F(LidarScanTest, DropsAndCountsWhatNoLidarMeasures) {
  const LidarScan scan = read("a.pcd", pcd("x y z t", "4 4 4 4", "F F F F", 7,
                                           "ascii\nnan 2 3 0\n1 inf 3 0\n1e30 0 0 0\n1 2 3 nan\n"
                                           "1 2 3 1.5\n0 0 0 0.01\n1 2 3 0.01\n"));
  EXPECT_EQ(scan.dropped.total(), 6u);  // the origin is what drivers write where nothing came back
  EXPECT_EQ(scan.points.size(), 1u);
}

TEST_F(LidarScanTest, DroppedPointsAreCountedByReason) {
  const std::string points =
      "ascii\nnan nan nan 0\n1 inf 3 0\n1e30 0 0 0\n1 2 3 1.5\n0 0 0 0.01\n1 2 3 0.01\n";
  const LidarScan scan = read("a.pcd", pcd("x y z t", "4 4 4 4", "F F F F", 6, points));
  EXPECT_EQ(scan.dropped, (DroppedPoints{1, 2, 1, 1}));
  EXPECT_EQ(reasons_of(scan.dropped),
            "2 not finite, 1 beyond 1 km, 1 over 1 s off the stamp, 1 without a return");
  // In a grid of points, NaN marks a missing return.
  std::string grid = pcd("x y z t", "4 4 4 4", "F F F F", 3, points);
  grid.replace(grid.find("HEIGHT 1"), 8, "HEIGHT 2");
  EXPECT_EQ(read("b.pcd", grid).dropped, (DroppedPoints{2, 1, 1, 1}));
}

TEST_F(LidarScanTest, OverATenthOfFaultyPointsIsTooMany) {
  EXPECT_NO_THROW(require_few_dropped({900, 0, 0, 10}, 90, "drive"));
  EXPECT_THAT(
      error_of<InputError>([] { require_few_dropped({0, 0, 0, 11}, 89, "d"); }),
      testing::AllOf(HasSubstr("11 of 100 points (11 %)"), HasSubstr("11 over 1 s off the stamp"),
                     HasSubstr("time_unit"), HasSubstr("--allow-dropped")));
}

TEST_F(LidarScanTest, CoordinatesInOtherUnitsAndAsWholeNumbers) {
  format_.length_unit = 1e-3;
  const LidarScan whole =
      read("a.pcd", pcd("X Y Z", "4 4 4", "I I I", 1, "ascii\n-1500 20000 3\n"));
  EXPECT_LT((whole.points.position[0] - Eigen::Vector3f(-1.5f, 20, 0.003f)).norm(), 1e-5f);
  EXPECT_THAT(error_of<InputError>(
                  [&] { read("b.pcd", pcd("x y z", "4 4 4", "I F F", 1, "ascii\n1 2 3\n")); }),
              HasSubstr("must be of type F"));
}

TEST_F(LidarScanTest, UnusableFilesAreErrorsThatNameThem) {
  const auto error = [&](const std::string& name, const std::string& content) {
    return error_of<InputError>([&] { read(name, content); });
  };
  EXPECT_THAT(error("a.pcd", pcd("x y z", "4 4 4", "F F F", 0, "ascii\n")),
              testing::AllOf(HasSubstr("no usable point"), HasSubstr("a.pcd")));
  EXPECT_THAT(error("a.pcd", pcd("x y", "4 4", "F F", 1, "ascii\n1 2\n")), HasSubstr("no field z"));
  EXPECT_THAT(error("a.pcd", "nonsense"), HasSubstr("no PCD file"));
  EXPECT_THAT(error("a.ply", "nonsense"), HasSubstr("no PLY file"));
  EXPECT_THAT(error("a.xyz", "1 2 3"), HasSubstr("no multiple of the 16"));
  EXPECT_THAT(error_of<InputError>([&] { read_lidar_scan(folder_ / "none.pcd", {}, 0); }),
              HasSubstr("none.pcd"));
}

TEST_F(LidarScanTest, TheContentDecidesTheFormat) {
  const std::string pcd_text = pcd("x y z", "4 4 4", "F F F", 1, "ascii\n1 2 3\n");
  const std::string ply_text =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n4 5 6\n";
  std::string bin;
  for (const float value : {7.0f, 8.0f, 9.0f, 0.5f}) put(bin, value);
  for (const char* name : {"a.bin", "a.BIN", "a.pcd", "a.ply", "a.dat", "a"}) {
    EXPECT_EQ(read(name, pcd_text).points.position[0], Eigen::Vector3f(1, 2, 3)) << name;
    EXPECT_EQ(read(name, ply_text).points.position[0], Eigen::Vector3f(4, 5, 6)) << name;
  }
  for (const char* name : {"a.bin", "a.BIN", "a.dat", "a"}) {
    EXPECT_EQ(read(name, bin).points.position[0], Eigen::Vector3f(7, 8, 9)) << name;
  }
}

TEST_F(LidarScanTest, BlanksAndUpperCaseInHeadersDoNotMatter) {
  const char* const head = "format ascii 1.0 \nelement vertex 1 \n";
  const std::string properties =
      "property float X \nproperty float Y\nproperty float Z\nproperty float Intensity\n"
      "end_header \n4 5 6 0.5 \n";
  for (const char* first : {"ply \n", "ply\t\r\n", "ply  \n", "\xef\xbb\xbfply\n"}) {
    const LidarScan scan = read("a.ply", first + (head + properties));
    EXPECT_EQ(scan.points.position[0], Eigen::Vector3f(4, 5, 6)) << first;
    EXPECT_THAT(scan.points.intensity, ElementsAre(0.5f)) << first;
  }
  const LidarScan scan =
      read("a.pcd", pcd("X Y Z INTENSITY", "4 4 4 4", "F F F F", 1, "ascii\n1 2 3 0.25\n"));
  EXPECT_EQ(scan.points.position[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_THAT(scan.points.intensity, ElementsAre(0.25f));
}

TEST_F(LidarScanTest, OtherFormatsAreNamed) {
  const auto error = [&](const std::string& content) {
    return error_of<InputError>([&] { read("a.bin", content); });
  };
  using namespace std::string_literals;
  // Each as long as some points of 16 bytes.
  const auto filled = [](std::string bytes) {
    bytes.resize(480, '\x41');
    return bytes;
  };
  EXPECT_THAT(error(filled("LASF"s + std::string(100, '\0') + "\3")), HasSubstr("a LAS point"));
  EXPECT_THAT(error(filled("LASF"s + std::string(100, '\0') + "\x83")), HasSubstr("LAZ"));
  EXPECT_THAT(error(filled("ASTM-E57\1\0\0\0"s)), HasSubstr("an E57 point cloud, no scan"));
  EXPECT_THAT(error(filled("\x89PNG\r\n\x1a\n")), HasSubstr("a PNG image"));
  EXPECT_THAT(error(filled("\xff\xd8\xff\xe0")), HasSubstr("a JPEG image"));
  EXPECT_THAT(error(filled("\x1f\x8b\x08\0"s)), HasSubstr("gzip"));
  EXPECT_THAT(error(filled("\x93NUMPY\1\0"s)), HasSubstr("a NumPy array"));
  EXPECT_THAT(error(filled("SQLite format 3\0"s)), HasSubstr("an SQLite database"));
  EXPECT_THAT(error("1.5 2.5 3.5 0.25\n1.5 2.5 3.5 0.25\n"), HasSubstr("a text file"));
}

TEST_F(LidarScanTest, APipeInPlaceOfAScanIsRefused) {
  ASSERT_EQ(mkfifo((folder_ / "a.bin").c_str(), 0600), 0);
  EXPECT_THAT(error_of<InputError>([&] { read_lidar_scan(folder_ / "a.bin", {}, 0); }),
              HasSubstr("it is a pipe"));
}

TEST_F(LidarScanTest, AFileLargerThanAnyScanIsRefused) {
  write_text(folder_ / "a.bin", "");
  test::fs::resize_file(folder_ / "a.bin", 6'000'000'000);  // sparse
  EXPECT_THAT(
      error_of<InputError>([&] { read_lidar_scan(folder_ / "a.bin", {}, 0); }),
      testing::AllOf(HasSubstr("6000000000 bytes, more than any scan"), HasSubstr("a.bin")));
}

TEST(ScanRows, TimesOfAnyClockMayCountFromTheFirstPoint) {
  ScanFormat format;
  format.time_reference = TimeReference::kFirstPoint;
  format.time_unit = 1e-9;
  ScanRows rows(format, 1'700'000'000 * kNsPerSecond);
  const std::vector<std::optional<Scalar>> types(rows.columns().size(), Scalar::kDouble);
  rows.begin(4, types);
  rows.add(std::vector<double>{0, 0, 0, 0, 0, 0}, 0);  // nothing came back
  // The first in the file need not be the first in time.
  for (const double time : {5e15 + 2e7, 5e15, 5e15 + 9e7}) {
    rows.add(std::vector<double>{1, 2, 3, 0.5, 0, time}, 0);
  }
  const LidarScan scan = rows.take("a");
  ASSERT_EQ(scan.points.time.size(), 3u);
  EXPECT_FLOAT_EQ(scan.points.time[0], 0.02f);
  EXPECT_EQ(scan.points.time[1], 0);
  EXPECT_FLOAT_EQ(scan.points.time[2], 0.09f);
}

}  // namespace fovea::lidar_scan_test
