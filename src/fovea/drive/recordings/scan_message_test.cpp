#include "fovea/drive/recordings/scan_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../../../../tests/cdr_writer.h"
#include "../../../../tests/mcap_writer.h"
#include "fovea/drive/recordings/bag_sink.h"
#include "fovea/drive/scans/lidar_scan.h"
#include "fovea/drive/scans/recognized_format.h"
#include "fovea/errors.h"

namespace fovea::scan_message_test {

using testing::AllOf;
using testing::HasSubstr;

constexpr int kSecond = 1'700'000'000;
constexpr TimeNs kStamp = kSecond * kNsPerSecond + 250'000'000;

LidarScan scan_of(std::string_view type, std::string_view bytes, std::string_view encoding) {
  MessageReader reader(bytes, encoding, "/scans");
  const ScanMessage message(type, reader);
  EXPECT_EQ(message.header().stamp, kStamp);
  EXPECT_EQ(message.header().frame, "lidar");
  ScanNumberRows numbers(kStamp);
  message.read("/scans", numbers);
  ScanRows rows(recognize_format(std::vector{numbers.take()}, {}).format, kStamp);
  message.read("/scans", rows);
  return rows.take("/scans");
}

struct TestPoint {
  std::uint32_t time;  // ns
  float x;
  std::uint8_t reflectivity;
};

const std::vector<TestPoint> kPoints = {{0, 3, 0},
                                        {20'000'000, 4, 51},
                                        {40'000'000, 0, 0},  // nothing came back
                                        {60'000'000, 5, 255},
                                        {99'000'001, 6, 102}};

std::string livox_cdr() {
  CdrWriter message;
  message.header(kSecond, 250'000'000, "lidar").number(std::uint64_t{kStamp});
  message.number(std::uint32_t(kPoints.size())).number(std::uint8_t{1});
  for (int i = 0; i < 3; ++i) message.number(std::uint8_t{0});
  message.number(std::uint32_t(kPoints.size()));
  for (const TestPoint& p : kPoints) {
    const float y = p.x == 0 ? 0 : -1;
    message.number(p.time).number(p.x).number(y).number(2 * y);
    message.number(p.reflectivity).number(std::uint8_t{0x10}).number(std::uint8_t{3});
  }
  return message.message();
}

std::string livox_ros1() {
  using mcap::number;
  std::string message = number(7u) + number(std::uint32_t{kSecond}) + number(250'000'000u) +
                        mcap::text("lidar") + number(std::uint64_t{kStamp}) +
                        number(std::uint32_t(kPoints.size())) + std::string(4, '\1') +
                        number(std::uint32_t(kPoints.size()));
  for (const TestPoint& p : kPoints) {
    const float y = p.x == 0 ? 0 : -1;
    message += number(p.time) + number(p.x) + number(y) + number(2 * y) + number(p.reflectivity) +
               "\x10\x03";
  }
  return message;
}

TEST(ScanMessage, ReadsLivoxScansOfRos2AndRos1) {
  for (const LidarScan& scan : {scan_of(ros::kLivox2, livox_cdr(), kCdrEncoding),
                                scan_of(ros::kLivox, livox_ros1(), kRos1Encoding)}) {
    ASSERT_EQ(scan.points.size(), 4u);
    EXPECT_EQ(scan.dropped.no_return, 1u);
    EXPECT_EQ(scan.points.position[2], Eigen::Vector3f(5, -1, -2));
    EXPECT_FLOAT_EQ(scan.points.intensity[1], 0.2f);
    EXPECT_FLOAT_EQ(scan.points.intensity[2], 1);
    EXPECT_NEAR(scan.points.time[1], 0.02f, 1e-9);
    EXPECT_NEAR(scan.points.time[3], 0.099000001, 1e-8);
  }
}

/// A Velodyne that turns in a room with flat walls, and what it would measure.
class TestVelodyne {
 public:
  /// @param hour_us  time of the first packet by its clock, microseconds since the full hour
  TestVelodyne(std::uint8_t product, bool has_two_returns, std::uint32_t hour_us)
      : product_(product) {
    const int firings_per_block = product == 0x22 ? 2 : 1;
    const int blocks_at_once = has_two_returns ? 2 : 1;
    const double block_duration = 55.296e-6 * firings_per_block;
    CdrWriter message;
    message.header(kSecond, 250'000'000, "lidar").number(std::uint32_t{kPackets});
    for (std::uint32_t packet = 0; packet < kPackets; ++packet) {
      const double begin = packet * 12 / blocks_at_once * block_duration;
      std::string data;
      for (int block = 0; block < 12; ++block) {
        const double time = begin + block / blocks_at_once * block_duration;
        const bool is_repeated = block % blocks_at_once == 1;
        data += "\xff\xee" + mcap::number(std::uint16_t(std::lround(100 * azimuth(time)) % 36000));
        for (int firing = 0; firing < firings_per_block; ++firing) {
          fire(time + 55.296e-6 * firing, !is_repeated, data);
        }
      }
      const auto clock = std::uint32_t((hour_us + std::llround(1e6 * begin)) % 3'600'000'000);
      data += mcap::number(clock) + (has_two_returns ? '\x39' : '\x37') + char(product);
      // The host has received some packets late.
      const auto received = TimeNs(1e9 * begin) + (packet % 3 == 2 ? 5'000'000 : 0);
      message.number(std::int32_t{kSecond}).number(std::uint32_t(250'000'000 + received));
      for (const char byte : data) message.number(byte);
    }
    message_ = message.message();
  }

  const std::string& message() const { return message_; }
  const PointCloud& truth() const { return truth_; }

 private:
  static constexpr std::uint32_t kPackets = 60;

  static double azimuth(double time) { return 350 + 3600 * time; }  // degrees, ten turns a second

  void fire(double time, bool is_noted, std::string& data) {
    static const std::vector<double> kVlp16 = {-15, 1, -13, 3,  -11, 5,  -9, 7,
                                               -7,  9, -5,  11, -3,  13, -1, 15};
    static const std::vector<double> kVlp16Above = {11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                                    5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};
    static const std::vector<double> kVlp32 = {
        -25,    -1,     -1.667, -15.639, -11.31, 0,      -0.667, -8.843, -7.254, 0.333,  -0.333,
        -6.148, -5.333, 1.333,  0.667,   -4,     -4.667, 1.667,  1,      -3.667, -3.333, 3.333,
        2.333,  -2.667, -3,     7,       4.667,  -2.333, -2,     15,     10.333, -1.333};
    static const std::vector<double> kVlp32Turned = {
        1.4, -4.2, 1.4, -1.4, 1.4, -1.4, 4.2, -1.4, 1.4, -4.2, 1.4, -1.4, 4.2, -1.4, 4.2, -1.4,
        1.4, -4.2, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4, 1.4, -1.4, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4};
    const bool is_16 = product_ == 0x22;
    const std::vector<double>& elevations = is_16 ? kVlp16 : kVlp32;
    for (std::size_t laser = 0; laser < elevations.size(); ++laser) {
      const double at = time + 2.304e-6 * double(is_16 ? laser : laser / 2);
      const double turned = azimuth(at) + (is_16 ? 0 : kVlp32Turned[laser]);
      const double a = turned * std::numbers::pi / 180;
      const double e = elevations[laser] * std::numbers::pi / 180;
      const Eigen::Vector3d ray(std::cos(e) * std::cos(a), -std::cos(e) * std::sin(a), std::sin(e));
      const Eigen::Vector3d origin(0, 0, is_16 ? 1e-3 * kVlp16Above[laser] : 0);
      double range = 100;
      for (int axis = 0; axis < 3; ++axis) {
        const double wall = Eigen::Vector3d(12, 9, 3)[axis] * (ray[axis] < 0 ? -1 : 1);
        range = std::min(range, (wall - origin[axis]) / ray[axis]);
      }
      const bool is_lost = laser == 4;
      const auto steps = std::uint16_t(std::lround(range / (is_16 ? 0.002 : 0.004)));
      data += mcap::number(is_lost ? std::uint16_t{0} : steps) + char(10 * (laser % 16));
      if (is_lost || !is_noted) continue;
      truth_.position.push_back((origin + range * ray).cast<float>());
      truth_.intensity.push_back(float(10 * (laser % 16)) / 255);
      truth_.time.push_back(float(at));
      truth_.ring.push_back(
          std::uint16_t(std::count_if(elevations.begin(), elevations.end(),
                                      [&](double other) { return other < elevations[laser]; })));
    }
  }

  std::uint8_t product_;
  std::string message_;
  PointCloud truth_;
};

TEST(ScanMessage, DecodesVelodynePackets) {
  for (const std::uint8_t product : {std::uint8_t{0x22}, std::uint8_t{0x28}}) {
    for (const bool has_two_returns : {false, true}) {
      for (const std::uint32_t hour_us : {1000u, 3'599'999'000u}) {
        const TestVelodyne sensor(product, has_two_returns, hour_us);
        const LidarScan scan = scan_of(ros::kVelodyneScan, sensor.message(), kCdrEncoding);
        const PointCloud& truth = sensor.truth();
        ASSERT_EQ(scan.points.size(), truth.size());
        EXPECT_EQ(scan.points.ring, truth.ring);
        const float step = product == 0x22 ? 0.002f : 0.004f;
        for (std::size_t i = 0; i < truth.size(); ++i) {
          // Half a step of the range, and of the azimuth at both ends of a block.
          const float reach = truth.position[i].norm();
          const float bound = 0.5f * step + 2 * reach * 0.005f * 0.01745f + 1e-4f;
          ASSERT_LT((scan.points.position[i] - truth.position[i]).norm(), bound) << i;
          ASSERT_NEAR(scan.points.time[i], truth.time[i], 2e-6) << i;
          ASSERT_NEAR(scan.points.intensity[i], truth.intensity[i], 1e-6) << i;
        }
      }
    }
  }
}

TEST(ScanMessage, RefusesOtherAndDamagedPackets) {
  const auto error_of = [](const std::string& message) -> std::string {
    MessageReader reader(message, kCdrEncoding, "/packets");
    try {
      ScanNumberRows rows(kStamp);
      ScanMessage(ros::kVelodyneScan, reader).read("/packets", rows);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  constexpr std::uint8_t kHdl32 = 0x21;
  EXPECT_THAT(error_of(TestVelodyne(kHdl32, false, 0).message()),
              AllOf(HasSubstr("0x21"), HasSubstr("/packets"), HasSubstr("velodyne_pointcloud")));
  std::string mixed = TestVelodyne(0x22, false, 0).message();
  mixed.back() = '\x28';
  EXPECT_THAT(error_of(mixed), HasSubstr("different LiDARs"));
  std::string damaged = TestVelodyne(0x22, false, 0).message();
  damaged[damaged.find("\xff\xee")] = 'x';
  EXPECT_THAT(error_of(damaged), AllOf(HasSubstr("damaged"), HasSubstr("/packets")));
}

TEST(ScanMessage, NamesTheDriversOfPackets) {
  EXPECT_EQ(driver_of_packets("ouster_ros/msg/PacketMsg"), "ouster_ros");
  EXPECT_EQ(driver_of_packets("sensor_msgs/msg/PointCloud2"), "");
  EXPECT_FALSE(is_scan_type("ouster_ros/msg/PacketMsg"));
}

}  // namespace fovea::scan_message_test
