#include "fovea/drive/time_stamps.h"

#include <gtest/gtest.h>

#include "../../../tests/kitti_test_drive.h"
#include "fovea/errors.h"

namespace fovea::time_stamps_test {

using test::TemporaryFolder;
using test::write_text;
using Times = std::vector<std::optional<TimeNs>>;

TEST(TimeStamps, DateTimesAreExactToTheNanosecond) {
  // date -u -d '2011-09-26 13:08:24' +%s
  EXPECT_EQ(parse_date_time("2011-09-26 13:08:24.967930880"), 1'317'042'504'967'930'880);
  EXPECT_EQ(parse_date_time("1970-01-01 00:00:00.000000001"), 1);
  EXPECT_EQ(parse_date_time("2012-02-29 00:00:00"), 1'330'473'600'000'000'000);
  EXPECT_EQ(parse_date_time("2011-09-26 13:08:24.5"), 1'317'042'504'500'000'000);
  EXPECT_EQ(parse_date_time("2011-09-26 13:08:24.9679308805"), 1'317'042'504'967'930'880);
}

TEST(TimeStamps, MalformedDateTimesAreNone) {
  for (const char* text :
       {"", "2011-09-26", "2011-09-26T13:08:24.1", "2011-13-26 13:08:24.1", "2011-02-29 13:08:24.1",
        "2011-09-26 24:08:24.1", "2011-09-26 13:60:24.1", "2011-09-26 13:08:60.1",
        "2011-09-26 13:08:24.", "2011-09-26 13:08:24.12x", "2011-09-26 13:08:24,12",
        "2011-09-26 13:08:2", "x011-09-26 13:08:24.1", "9999-09-26 13:08:24.1",
        "1969-12-31 23:00:00"}) {
    EXPECT_FALSE(parse_date_time(text)) << text;
  }
}

TEST(TimeStamps, BlankLinesKeepTheirPlace) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "timestamps.txt";
  write_text(file,
             "2011-09-26 13:00:00.0\r\n2011-09-26 13:00:00.1\r\n\r\n  \n2011-09-26 13:00:00.4\n"
             "rubbish\n2011-09-26 13:00:00.6");
  const TimeStamps stamps = read_date_times(file);
  constexpr TimeNs kTenth = kNsPerSecond / 10;
  const TimeNs start = *parse_date_time("2011-09-26 13:00:00");
  EXPECT_EQ(stamps.times, (Times{start, start + kTenth, std::nullopt, std::nullopt,
                                 start + 4 * kTenth, std::nullopt, start + 6 * kTenth}));
  EXPECT_EQ(stamps.malformed, std::vector<int>{5});
  EXPECT_TRUE(stamps.out_of_order.empty());
  EXPECT_NEAR(*median_period(stamps), 0.1, 1e-12);
}

TEST(TimeStamps, WildStampsCostOnlyThemselves) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "times.txt";
  const auto out_of_order = [&](const char* text) {
    write_text(file, text);
    return read_seconds(file).out_of_order;
  };
  EXPECT_EQ(out_of_order("0\n1\n2\n3\n"), std::vector<int>{});
  EXPECT_EQ(out_of_order("0\n1\n1\n2\n"), std::vector<int>{2});    // repeated
  EXPECT_EQ(out_of_order("0\n1\n0.5\n2\n"), std::vector<int>{2});  // back
  EXPECT_EQ(out_of_order("0\n900\n2\n3\n"), std::vector<int>{1});  // far ahead: the others stay
  EXPECT_EQ(out_of_order("800\n1\n2\n3\n"), std::vector<int>{0});
  EXPECT_EQ(out_of_order("0\n\n3\n2\n4\n"), std::vector<int>{3});  // blank lines do not count
}

TEST(TimeStamps, SecondsInAnyNotation) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "times.txt";
  write_text(file, "0.000000e+00\n1.037359e-01\n0.5\nnan\n1 2\n\n1e300\n7\n");
  const TimeStamps stamps = read_seconds(file);
  EXPECT_EQ(stamps.times, (Times{0, 103'735'900, 500'000'000, {}, {}, {}, {}, 7 * kNsPerSecond}));
  EXPECT_EQ(stamps.malformed, (std::vector<int>{3, 4, 6}));
}

TEST(TimeStamps, MedianIgnoresGaps) {
  TimeStamps stamps;
  for (const int tenth : {0, 1, 2, 50, 51, 52}) stamps.times.push_back(tenth * kNsPerSecond / 10);
  EXPECT_NEAR(*median_period(stamps), 0.1, 1e-12);
  stamps.times = {TimeNs{0}, std::nullopt, kNsPerSecond};
  EXPECT_FALSE(median_period(stamps));
  EXPECT_FALSE(median_period({}));
}

TEST(TimeStamps, NothingUsable) {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.txt", "\n\nx\n");
  EXPECT_FALSE(read_date_times(folder.path() / "a.txt").any());
  EXPECT_THROW(read_date_times(folder.path() / "b.txt"), InputError);
}

}  // namespace fovea::time_stamps_test
