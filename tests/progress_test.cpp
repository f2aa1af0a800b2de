// What the program says while it works: on a terminal, into a file, and when it is to be quiet.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/progress_text.h"
#include "tests/kitti_writer.h"
#include "tests/program.h"

namespace fovea::progress_test {

using app::duration_text;
using app::progress_bar;
using app::progress_text;
using app::ProgressRate;
using testing::HasSubstr;
using testing::Not;

TEST(ProgressRate, IsThatOfTheLastSeconds) {
  ProgressRate rate;
  EXPECT_NEAR(rate.at(1, 1000, 0.5).per_second, 2, 1e-9);
  for (int i = 2; i <= 100; ++i) rate.at(i, 1000, 0.5 * i);  // 2 a second, until 50 s
  ProgressRate::Reading reading;
  for (int i = 1; i <= 400; ++i) reading = rate.at(100 + i, 1000, 50 + 0.1 * i);  // then 10
  EXPECT_NEAR(reading.per_second, 10, 0.1);
  EXPECT_NEAR(reading.seconds_left, 50, 0.5);
  EXPECT_EQ(reading.done, 500);
}

TEST(ProgressRate, WhatAnEarlierRunHasDoneIsNoSpeed) {
  ProgressRate rate;
  EXPECT_NEAR(rate.at(901, 1000, 0.5).per_second, 2, 1e-9);
  EXPECT_NEAR(rate.at(902, 1000, 1.0).seconds_left, 49, 1e-9);
}

TEST(ProgressRate, NothingIsDividedByZero) {
  ProgressRate rate;
  EXPECT_GT(rate.at(1, 1, 0).per_second, 0);
  EXPECT_EQ(rate.at(1, 1, 0).seconds_left, 0);
}

TEST(ProgressText, Durations) {
  EXPECT_EQ(duration_text(0.2), "0 s");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(59.6), "1 min 00 s");
  EXPECT_EQ(duration_text(125), "2 min 05 s");
  EXPECT_EQ(duration_text(4331), "1 h 12 min");
  EXPECT_EQ(duration_text(-1), "0 s");
}

TEST(ProgressText, TellsAllInALine) {
  const ProgressRate::Reading reading{120, 1200, 10.24, 105.5};
  const std::string text = progress_text(reading, "frames", "4.31 M points, 512 MB");
  EXPECT_EQ(text, "120 of 1200 frames, 10.2/s, 4.31 M points, 512 MB, 1 min 46 s left");
  EXPECT_EQ(progress_text(reading, "rows", ""), "120 of 1200 rows, 10.2/s, 1 min 46 s left");
  EXPECT_EQ(progress_text({120, 0, 10.24, 0}, "frames", "512 MB"), "120 frames, 10.2/s, 512 MB");
  const std::string bar = progress_bar(reading, text, 0);
  EXPECT_THAT(bar, testing::StartsWith("[###                           ] 120 of 1200"));
  EXPECT_THAT(bar, testing::EndsWith(" left"));
  EXPECT_EQ(progress_bar(reading, text, 40), bar.substr(0, 39));
  EXPECT_EQ(progress_bar({0, 0, 0, 0}, "", 80).substr(0, 32), "[" + std::string(30, '#') + "]");
}

class Progress : public testing::Test {
 protected:
  /// What a terminal of 120 columns would show of a short run.
  std::string on_terminal(const std::string& more) const {
    const SyntheticDrive synthetic(street_scene(), 3, 0.8);
    const auto drive = write_kitti_drive(synthetic, own_ / "drive");
    const std::string command =
        fmt::format("stty cols 120; '{}' map '{}' -o '{}' --force {}", FOVEA_PROGRAM,
                    drive.string(), (own_ / "a.fovea").string(), more);
    // script (bsdutils) gives the program a terminal.
    const std::string shown = (own_ / "shown").string();
    EXPECT_EQ(
        std::system(
            fmt::format("script -qec \"{}\" '{}' > /dev/null < /dev/null", command, shown).c_str()),
        0);
    return read_text(shown);
  }
  TemporaryFolder own_;
};

TEST_F(Progress, ATerminalGetsABarWithRatePointsMemoryAndTimeLeft) {
  const std::string shown = on_terminal("");
  EXPECT_THAT(shown, HasSubstr("\r["));
  EXPECT_THAT(shown, HasSubstr("1 of 3 frames"));
  EXPECT_THAT(shown, HasSubstr("3 of 3 frames"));
  EXPECT_THAT(shown, testing::ContainsRegex("/s, [0-9.]+ M points, [0-9]+ MB, 0 s left"));
}

TEST_F(Progress, QuietIsQuietOnATerminal) {
  EXPECT_THAT(on_terminal("--quiet"), Not(HasSubstr("frames")));
}

}  // namespace fovea::progress_test
