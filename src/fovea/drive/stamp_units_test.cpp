#include "fovea/drive/stamp_units.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "../../../tests/kitti_test_drive.h"
#include "fovea/errors.h"

namespace fovea::stamp_units_test {

using test::error_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr TimeNs kEpoch = 1'700'000'000, kStart = kEpoch * kNsPerSecond;

class StampUnits : public testing::Test {
 protected:
  CsvRows rows(const std::string& text) const {
    test::write_text(file_, text);
    constexpr std::array<CsvColumn, 1> kColumns = {{{"index"}}};
    return read_csv(file_, kColumns);
  }
  std::vector<TimeNs> scans(const std::string& text) {
    CsvRows table = rows(text);
    notes_.clear();
    set_scan_time_unit(table, file_, notes_);
    return table.times;
  }
  std::vector<TimeNs> others(const std::string& text, const ScanPeriod& period) {
    CsvRows table = rows(text);
    notes_.clear();
    set_time_unit_by_scans(table, period, file_, notes_);
    return table.times;
  }
  std::string error(const std::string& text) {
    return error_of<InputError>([&] { scans(text); });
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "stamps.csv";
  std::vector<std::string> notes_;
};

/// Three lines, 0.1 s apart from `first` on.
std::string table(const std::string& column, TimeNs first, TimeNs unit) {
  std::string text = "index," + column + "\n";
  for (int i = 0; i < 3; ++i) {
    const TimeNs time = first + i * kNsPerSecond / 10;
    text += fmt::format("{},{}", i, time / unit);
    if (time % unit != 0) text += fmt::format(".{}", i);
    text += "\n";
  }
  return text;
}

TEST_F(StampUnits, ScansAreATenthOfASecondApart) {
  for (const TimeNs first : {TimeNs{0}, kStart}) {
    const auto expected = ElementsAre(first, first + 100'000'000, first + 200'000'000);
    for (const TimeNs unit : {TimeNs{1}, TimeNs{1000}, TimeNs{1'000'000}, kNsPerSecond}) {
      for (const char* column : {"time_ns", "timestamp"}) {
        EXPECT_THAT(scans(table(column, first, unit)), expected) << unit;
        EXPECT_EQ(notes_.empty(), unit == 1) << unit;
      }
    }
  }
  scans(table("time_ns", kStart, 1000));
  EXPECT_THAT(notes_, ElementsAre(AllOf(HasSubstr("stamps.csv are in us"), HasSubstr("time_us"))));
}

TEST_F(StampUnits, TheColumnStatesTheUnit) {
  for (const auto& [column, unit] :
       {std::pair("time_us", TimeNs{1000}), std::pair("Timestamp_MS", TimeNs{1'000'000}),
        std::pair("time_s", kNsPerSecond)}) {
    EXPECT_THAT(scans(table(column, kStart, unit)),
                ElementsAre(kStart, kStart + 100'000'000, kStart + 200'000'000));
    EXPECT_THAT(notes_, IsEmpty());
  }
  EXPECT_THAT(error(table("time_ms", 0, 1)),
              AllOf(HasSubstr("1e+05 s apart by the column time_ms"), HasSubstr("time_ns")));
  EXPECT_THAT(error(table("time_us", kStart, kNsPerSecond)), HasSubstr("1e-07 s apart"));
}

TEST_F(StampUnits, DatesDecideWhereStepsDoNot) {
  // 2 s apart in us, or 2 ms apart in ns.
  EXPECT_THAT(scans("index,time_ns\n0,1700000000000000\n1,1700000002000000\n"),
              ElementsAre(kStart, kStart + 2 * kNsPerSecond));
  EXPECT_THAT(scans("index,time_ns\n0,5000000\n1,7000000\n"), ElementsAre(5'000'000, 7'000'000));
  EXPECT_THAT(scans("index,time_ns\n7,1700000000000\n"), ElementsAre(kStart));
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("in ms")));
}

TEST_F(StampUnits, KeyframesFarApartStayNanoseconds) {
  EXPECT_THAT(scans("index,time_ns\n0,0\n1,30000000000\n"), ElementsAre(0, 30 * kNsPerSecond));
  EXPECT_THAT(notes_, IsEmpty());
}

TEST_F(StampUnits, StepsOfNoUnitAreAnError) {
  EXPECT_THAT(error("index,time_ns\n0,5.001\n1,5.002\n2,5.003\n"),
              AllOf(HasSubstr("0.001 apart"), HasSubstr("stamps.csv"), HasSubstr("time_us")));
}

TEST_F(StampUnits, FloatingPointNumbersAreTimes) {
  EXPECT_THAT(scans("index,time_ns\n0,1.700000000000000000e+18\n1,1.700000000100000000e+18\n"),
              ElementsAre(kStart, kStart + 100'000'000));
  EXPECT_THAT(scans("index,time_ns\n0,1700000000000000000.0\n1,1700000000100000000.0\n"),
              ElementsAre(kStart, kStart + 100'000'000));
  EXPECT_THAT(scans("index,time\n0,1700000000.000000001\n1,1700000000.1\n"),
              ElementsAre(kStart + 1, kStart + 100'000'000));
}

TEST_F(StampUnits, OtherTablesHaveTheTimeOfTheScans) {
  for (const TimeNs first : {TimeNs{0}, kStart}) {
    const ScanPeriod period{first, first + 60 * kNsPerSecond};
    for (const TimeNs unit : {TimeNs{1}, TimeNs{1000}, TimeNs{1'000'000}, kNsPerSecond}) {
      EXPECT_THAT(others(table("time_ns", first, unit), period),
                  ElementsAre(first, first + 100'000'000, first + 200'000'000))
          << unit;
    }
  }
}

TEST_F(StampUnits, TablesOfAnotherTimeStayAsTheyAre) {
  const ScanPeriod period{kStart, kStart + 60 * kNsPerSecond};
  EXPECT_THAT(others("index,time_ns\n0,5000000000\n1,5100000000\n", period),
              ElementsAre(5'000'000'000, 5'100'000'000));
  EXPECT_THAT(notes_, IsEmpty());
  // A short table of a long drive.
  EXPECT_THAT(others("index,time_ns\n0,0\n1,1000000\n2,2000000\n", {0, 3600 * kNsPerSecond}),
              ElementsAre(0, 1'000'000, 2'000'000));
}

}  // namespace fovea::stamp_units_test
