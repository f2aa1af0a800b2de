#include "fovea/drive/recordings/point_cloud_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fovea/drive/scans/recognized_format.h"
#include "fovea/errors.h"

namespace fovea::point_cloud_rows_test {

constexpr TimeNs kStamp = 1'700'000'000 * kNsPerSecond + 250'000'000;

/// A cloud of points at (i, 0, 1) with a ring and a time of a type.
template <class Time>
struct TestCloud {
  TestCloud(std::uint8_t time_type, std::string_view time_name, std::uint32_t count,
            const std::function<Time(int)>& time_of) {
    const std::uint32_t step = 2 + 12 + 4 + sizeof(Time) + 3;  // with three bytes of padding
    for (std::uint32_t i = 0; i < count; ++i) {
      put(std::uint16_t(i));
      for (const float value : {float(i + 1), 0.0f, 1.0f, 0.5f}) put(value);
      put(time_of(int(i)));
      data += "pad";
    }
    message.header.stamp = kStamp;
    message.height = 2, message.width = count / 2;
    message.fields = {{"ring", 0, 4, 1}, {"x", 2, 7, 1},          {"y", 6, 7, 1},
                      {"z", 10, 7, 1},   {"intensity", 14, 7, 1}, {time_name, 18, time_type, 1}};
    message.point_step = step, message.row_step = step * message.width;
    message.data = data;
  }
  template <class T>
  void put(T value) {
    sizes.push_back(sizeof value);
    data.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  /// Reverses the bytes of each number.
  void make_big_endian() {
    auto at = data.begin();
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      std::reverse(at, at + std::ptrdiff_t(sizes[i]));
      at += std::ptrdiff_t(sizes[i]) + (i % 6 == 5 ? 3 : 0);  // the padding
    }
    message.big_endian = true;
    message.data = data;
  }

  std::string data;
  std::vector<std::size_t> sizes;  // of the numbers, bytes
  ros::PointCloud2 message;
};

constexpr std::uint8_t kUint32 = 6, kFloat32 = 7, kFloat64 = 8;

ScanFormat format_of(const ros::PointCloud2& cloud) {
  ScanNumberRows rows(kStamp);
  read_cloud_rows(cloud, "t", rows);
  return recognize_format(std::vector{rows.take()}, {}).format;
}

LidarScan scan_of(const ros::PointCloud2& cloud) {
  ScanRows rows(format_of(cloud), kStamp);
  read_cloud_rows(cloud, "t", rows);
  return rows.take("t");
}

TEST(PointCloudRows, ReadsFieldsWhereTheyAre) {
  const TestCloud<float> cloud(kFloat32, "time", 8, [](int i) { return 0.01f * float(i - 5); });
  const LidarScan scan = scan_of(cloud.message);
  ASSERT_EQ(scan.points.size(), 8u);
  EXPECT_EQ(scan.points.position[5], Eigen::Vector3f(6, 0, 1));
  EXPECT_EQ(scan.points.intensity[5], 0.5f);
  EXPECT_FLOAT_EQ(scan.points.time[7], 0.02f);
}

TEST(PointCloudRows, ReadsNumbersOfEitherByteOrder) {
  TestCloud<double> cloud(kFloat64, "time", 8, [](int i) { return 0.01 * (i - 5); });
  const LidarScan little = scan_of(cloud.message);
  cloud.make_big_endian();
  const LidarScan big = scan_of(cloud.message);
  EXPECT_EQ(big.points.position, little.points.position);
  EXPECT_EQ(big.points.intensity, little.points.intensity);
  EXPECT_EQ(big.points.time, little.points.time);
}

TEST(PointCloudRows, FindsOutWhatDriversMeanByTime) {
  const auto sweep = [](int i) { return 0.0125 * i; };  // s, of 0.1 s in all
  const auto expect_sweep = [&](const ros::PointCloud2& cloud, double first) {
    const LidarScan scan = scan_of(cloud);
    ASSERT_EQ(scan.points.time.size(), 8u);
    for (int i = 0; i < 8; ++i) {
      EXPECT_NEAR(scan.points.time[std::size_t(i)], first + sweep(i), 1e-6) << i;
    }
  };
  // Ouster: nanoseconds from the stamp. Velodyne: seconds to it. Hesai, RoboSense: seconds since
  // 1970.
  expect_sweep(TestCloud<std::uint32_t>(kUint32, "t", 8,
                                        [&](int i) { return std::uint32_t(sweep(i) * 1e9); })
                   .message,
               0);
  expect_sweep(
      TestCloud<float>(kFloat32, "time", 8, [&](int i) { return float(sweep(i) - 0.0875); })
          .message,
      -0.0875);
  expect_sweep(
      TestCloud<double>(kFloat64, "timestamp", 8, [&](int i) { return seconds(kStamp) + sweep(i); })
          .message,
      0);
  // Livox: nanoseconds since 1970, as real numbers. Microseconds from the stamp, too.
  expect_sweep(TestCloud<double>(kFloat64, "timestamp", 8,
                                 [&](int i) { return double(kStamp) + sweep(i) * 1e9; })
                   .message,
               0);
  expect_sweep(
      TestCloud<float>(kFloat32, "offset_time", 8, [&](int i) { return float(sweep(i) * 1e6); })
          .message,
      0);
}

TEST(PointCloudRows, TimesThatMakeNoSenseAreNone) {
  const TestCloud<float> zeros(kFloat32, "time", 8, [](int) { return 0.0f; });
  EXPECT_TRUE(scan_of(zeros.message).points.time.empty());
  const TestCloud<double> elsewhere(kFloat64, "timestamp", 8,
                                    [](int i) { return 12345.0 + 0.01 * i; });
  EXPECT_THROW(format_of(elsewhere.message), ConfigError);
}

TEST(PointCloudRows, PointsThatAreNoneDoNotCountForTheTimes) {
  TestCloud<double> cloud(kFloat64, "timestamp", 8,
                          [](int i) { return i == 3 ? 0.0 : seconds(kStamp) + 0.0125 * i; });
  const float nowhere = std::nanf("");
  std::memcpy(cloud.data.data() + 3 * cloud.message.point_step + 2, &nowhere, sizeof nowhere);
  cloud.message.data = cloud.data;
  const LidarScan scan = scan_of(cloud.message);
  ASSERT_EQ(scan.points.time.size(), 7u);
  EXPECT_NEAR(scan.points.time[6], 0.0875, 1e-6);
}

TEST(PointCloudRows, ARowStepThatWasNeverSetIsThatOfFullRows) {
  TestCloud<float> cloud(kFloat32, "time", 8, [](int i) { return 0.01f * float(i); });
  cloud.message.row_step = 0;
  EXPECT_EQ(scan_of(cloud.message).points.position[5], Eigen::Vector3f(6, 0, 1));
}

TEST(PointCloudRows, RefusesCloudsThatDoNotFitTheirData) {
  const TestCloud<float> cloud(kFloat32, "time", 8, [](int i) { return 0.01f * float(i); });
  const auto refused = [&](const std::function<void(ros::PointCloud2&)>& change) {
    ros::PointCloud2 changed = cloud.message;
    change(changed);
    EXPECT_THROW(scan_of(changed), InputError);
  };
  refused([](auto& c) { c.data.remove_suffix(1); });
  refused([](auto& c) { c.width = 0xffffffff; });
  refused([](auto& c) { c.height = 0xffffffff, c.row_step = 0xffffffff; });
  refused([](auto& c) { c.height = 0; });
  refused([](auto& c) { c.width = 0; });
  refused([](auto& c) { c.point_step = 0; });
  refused([](auto& c) { c.fields[2].offset = c.point_step - 3; });
  refused([](auto& c) { c.fields[2].offset = 0xffffffff; });
  refused([](auto& c) { c.fields[2].datatype = 9; });
  refused([](auto& c) { c.fields[2].datatype = 5; });
  refused([](auto& c) { c.fields.erase(c.fields.begin() + 1); });
}

}  // namespace fovea::point_cloud_rows_test
