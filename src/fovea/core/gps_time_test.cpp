#include "fovea/core/gps_time.h"

#include <gtest/gtest.h>

#include <array>
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

/// Days since 1970-01-01 of a date in the Gregorian calendar, by counting its years and months.
long days_since_1970(int year, int month, int day) {
  const auto is_leap_year = [](int y) { return (y % 4 == 0 && y % 100 != 0) || y % 400 == 0; };
  constexpr std::array<int, 12> kDays = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  long days = day - 1;
  for (int y = 1970; y < year; ++y) days += is_leap_year(y) ? 366 : 365;
  for (int m = 1; m < month; ++m)
    days += kDays.at(std::size_t(m - 1)) + (m == 2 && is_leap_year(year));
  return days;
}

// GPS weeks and leap seconds (TAI - UTC - 19 s) as the IERS and NOAA's NGS calendar state them.
TEST(GpsTime, AgreesWithWeekAndDayOfTheGpsCalendar) {
  struct Date {
    int year, month, day, week, weekday, leap_seconds;
  };
  for (const Date& date : {Date{1980, 1, 6, 0, 0, 0}, Date{1999, 8, 22, 1024, 0, 13},
                           Date{2011, 9, 26, 1655, 1, 15}, Date{2015, 7, 1, 1851, 3, 17},
                           Date{2019, 4, 7, 2048, 0, 18}, Date{2026, 1, 1, 2399, 4, 18}}) {
    const long unix_day = days_since_1970(date.year, date.month, date.day);
    const auto gps = adjusted_gps_seconds(TimeNs{unix_day} * 86'400 * kNsPerSecond);
    const double expected = (date.week * 7 + date.weekday) * 86'400.0 + date.leap_seconds - 1e9;
    ASSERT_TRUE(gps);
    EXPECT_NEAR(*gps, expected, 1e-6) << date.year << "-" << date.month << "-" << date.day;
  }
}

TEST(GpsTime, StampsThatAreNoDatesHaveNone) {
  for (const TimeNs time :
       {TimeNs{0}, TimeNs{-5}, 300 * kNsPerSecond, std::numeric_limits<TimeNs>::min(),
        std::numeric_limits<TimeNs>::max()}) {
    EXPECT_FALSE(adjusted_gps_seconds(time)) << time;
  }
}

}  // namespace fovea::gps_time_test
