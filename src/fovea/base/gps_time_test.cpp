#include "fovea/base/gps_time.h"

#include <gtest/gtest.h>

#include <limits>

namespace fovea::gps_time_test {

// Unix times by `date -u -d ... +%s`.
TEST(GpsTime, CountsLeapSeconds) {
  EXPECT_EQ(gps_leap_seconds(315'964'800 * kNsPerSecond), 0);     // 1980-01-06
  EXPECT_EQ(gps_leap_seconds(362'793'600 * kNsPerSecond), 1);     // 1981-07-01
  EXPECT_EQ(gps_leap_seconds(1'317'042'000 * kNsPerSecond), 15);  // 2011-09-26 13:00
  EXPECT_EQ(gps_leap_seconds(1'341'100'799 * kNsPerSecond), 15);  // 2012-06-30 23:59:59
  EXPECT_EQ(gps_leap_seconds(1'341'100'800 * kNsPerSecond), 16);
  EXPECT_EQ(gps_leap_seconds(1'767'225'600 * kNsPerSecond), 18);  // 2026-01-01
}

TEST(GpsTime, AdjustedSecondsAgreeWithPublishedDates) {
  // GPS time 1,000,000,000 was 2011-09-14 01:46:25 UTC.
  EXPECT_EQ(adjusted_gps_seconds(1'315'964'785 * kNsPerSecond), 0.0);
  EXPECT_NEAR(*adjusted_gps_seconds(1'315'964'786 * kNsPerSecond + 123'456'789), 1.123456789, 1e-9);
  EXPECT_NEAR(*adjusted_gps_seconds(315'964'800 * kNsPerSecond), -1e9, 1e-6);
}

TEST(GpsTime, StampsThatAreNoDatesHaveNone) {
  for (const TimeNs time :
       {TimeNs{0}, TimeNs{-5}, 300 * kNsPerSecond, std::numeric_limits<TimeNs>::min(),
        std::numeric_limits<TimeNs>::max()}) {
    EXPECT_FALSE(adjusted_gps_seconds(time)) << time;
  }
}

}  // namespace fovea::gps_time_test
