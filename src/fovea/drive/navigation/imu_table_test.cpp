#include "fovea/drive/navigation/imu_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../../tests/kitti_test_drive.h"
#include "../../../../tests/temporary_folder.h"

namespace fovea::imu_table_test {

using test::write_text;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr TimeNs kStart = 1'700'000'000'000'000'000;
constexpr const char* kHeader = "time_ns,qx,qy,qz,qw,wx,wy,wz,ax,ay,az\n";

class ImuTableTest : public testing::Test {
 protected:
  /// Records at 100 Hz.
  /// @param values  of a record: "wx,wy,wz,ax,ay,az"
  template <class Values>
  ImuTable read(int count, Values&& values, const ImuDescription& description = {}) {
    std::string text = kHeader;
    for (int i = 0; i < count; ++i) {
      text += fmt::format("{},,,,,{}\n", kStart + i * (kNsPerSecond / 100), values(i));
    }
    write_text(folder_ / "imu.csv", text);
    return read_imu(folder_ / "imu.csv", description, std::nullopt);
  }
  TemporaryFolder folder_;
};

std::string usual(int i) {
  return fmt::format("{},0.02,-0.03,0.1,-0.2,{}", 0.01 * i, 9.7 + 1e-3 * i);
}

TEST_F(ImuTableTest, ReadsRatesAndAccelerations) {
  ImuDescription description;
  description.T_lidar_imu.translation() << 1, 2, 3;
  description.delay = -0.02;
  description.noise.gyroscope_noise_density = 0.5;
  const ImuTable table = read(100, usual, description);
  ASSERT_TRUE(table.imu);
  EXPECT_THAT(table.warnings, IsEmpty());
  ASSERT_EQ(table.imu->samples.size(), 100u);
  const ImuSample& sample = table.imu->samples[7];
  EXPECT_EQ(sample.time, kStart + 7 * kNsPerSecond / 100 - kNsPerSecond / 50);
  EXPECT_TRUE(sample.rate.isApprox(Eigen::Vector3d(0.07, 0.02, -0.03)));
  EXPECT_TRUE(sample.force.isApprox(Eigen::Vector3d(0.1, -0.2, 9.707)));
  EXPECT_EQ(table.imu->T_lidar_imu.translation().z(), 3);
  EXPECT_EQ(table.imu->noise.gyroscope_noise_density, 0.5);
}

TEST_F(ImuTableTest, AccelerationsOfOneAreMultiplesOfGravity) {
  const auto in_g = [](int i) { return fmt::format("{},0,0,0.02,0,0.99", 0.01 * i); };
  const ImuTable table = read(100, in_g);
  EXPECT_NEAR(table.imu->samples[0].force.z(), 0.99 * 9.80665, 1e-9);
  EXPECT_THAT(table.notes, Contains(HasSubstr("imu.acceleration_unit")));
  ImuDescription metric;
  metric.force_unit = ForceUnit::kMetric;
  EXPECT_NEAR(read(100, in_g, metric).imu->samples[0].force.z(), 0.99, 1e-12);
}

TEST_F(ImuTableTest, AccelerationsWithoutGravityAreTold) {
  const ImuTable table = read(100, [](int i) { return fmt::format("{},0,0,0.1,0,0.2", 0.01 * i); });
  EXPECT_THAT(table.warnings, Contains(HasSubstr("are no gravity")));
}

TEST_F(ImuTableTest, RatesMayBeInDegrees) {
  ImuDescription degrees;
  degrees.rate_unit = RateUnit::kDegrees;
  EXPECT_NEAR(read(100, usual, degrees).imu->samples[50].rate.x(), 0.5 * kDegree, 1e-12);
}

TEST_F(ImuTableTest, GapsAndSlowRecordsAreTold) {
  std::string text = kHeader;
  for (int i = 0; i < 100; ++i) {
    const TimeNs time = kStart + i * (kNsPerSecond / 100) + (i < 50 ? 0 : kNsPerSecond / 2);
    text += fmt::format("{},,,,,{}\n", time, usual(i));
  }
  write_text(folder_ / "imu.csv", text);
  EXPECT_THAT(read_imu(folder_ / "imu.csv", {}, std::nullopt).warnings,
              Contains(HasSubstr("1 gaps, the longest of 0.51 s")));
  text = kHeader;
  for (int i = 0; i < 50; ++i) {
    text += fmt::format("{},,,,,{}\n", kStart + i * (kNsPerSecond / 10), usual(i));
  }
  write_text(folder_ / "imu.csv", text);
  EXPECT_THAT(read_imu(folder_ / "imu.csv", {}, std::nullopt).warnings,
              Contains(HasSubstr("10 records a second")));
}

TEST_F(ImuTableTest, SaturationIsTold) {
  const ImuTable table = read(200, [](int i) {
    return fmt::format("0.1,{},0,0,0,{}", std::clamp(0.02 * (i - 100), -1.5, 1.5), 9.7 + 1e-3 * i);
  });
  EXPECT_THAT(table.warnings, Contains(HasSubstr("rates about y are at the end of the range")));
}

TEST_F(ImuTableTest, LinesWithoutValuesAreLeftOut) {
  const ImuTable table = read(100, [](int i) { return i == 5 ? "1,2,,4,5,6" : usual(i); });
  EXPECT_EQ(table.imu->samples.size(), 99u);
  EXPECT_THAT(table.warnings, Contains(HasSubstr("without rates and accelerations")));
  const ImuTable wild = read(100, [](int i) { return i == 5 ? "1,2,0,4,5,98123" : usual(i); });
  EXPECT_EQ(wild.imu->samples.size(), 99u);
  EXPECT_THAT(wild.warnings, Contains(HasSubstr("out of range")));
  const ImuTable none = read(100, [](int) { return ",,,,,"; });
  EXPECT_FALSE(none.imu);
  EXPECT_THAT(none.warnings, Contains(HasSubstr("the IMU is not used")));
}

TEST_F(ImuTableTest, WheelsHaveSpeeds) {
  write_text(folder_ / "wheels.csv",
             fmt::format("time_ns,speed\n{},5\n{},x\n{},7.5\n", kStart, kStart + 1, kStart + 2));
  WheelDescription description;
  description.sigma = 0.2;
  const WheelTable table = read_wheels(folder_ / "wheels.csv", description, std::nullopt);
  ASSERT_EQ(table.wheels->samples.size(), 2u);
  EXPECT_EQ(table.wheels->samples[1].speed, 7.5);
  EXPECT_EQ(table.wheels->sigma, 0.2);
  EXPECT_EQ(table.warnings.size(), 1u);
}

}  // namespace fovea::imu_table_test
