#include "fovea/drive/scans/recognized_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "fovea/drive/scans/scan_columns.h"
#include "fovea/errors.h"

namespace fovea::recognized_format_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr TimeNs kEpoch = 1'700'000'000 * kNsPerSecond, kStep = kNsPerSecond / 10;
constexpr int kPoints = 1000;

struct Point {
  double range = 10, intensity = 0.5, time = 0;
};

/// A scan whose points are made by their share of the sweep, 0 to 1.
ScanNumbers scan_of(TimeNs stamp, Scalar time_type, const std::function<Point(double)>& point,
                    Scalar axis_type = Scalar::kFloat) {
  ScanNumberRows rows(stamp);
  const std::array<std::string, 5> names = {"x", "y", "z", "intensity", "time"};
  rows.describe(names, false);
  std::array<std::optional<Scalar>, kScanColumns.size()> types;
  types[kScanX] = types[kScanY] = types[kScanZ] = axis_type;
  types[kScanIntensity] = Scalar::kFloat;
  types[kScanTime] = time_type;
  rows.begin(kPoints, types);
  for (int i = 0; i < kPoints; ++i) {
    const Point p = point(double(i) / (kPoints - 1));
    std::array<double, kScanColumns.size()> row{};
    row[kScanX] = p.range;
    row[kScanIntensity] = p.intensity;
    row[kScanTime] = p.time;
    rows.add(row, std::size_t(i));
  }
  return rows.take();
}

/// Five scans, 0.1 s apart from `first` on, with sweeps of 0.1 s from the stamp on.
std::vector<ScanNumbers> sweeps(double unit, bool absolute, TimeNs first = kEpoch,
                                Scalar type = Scalar::kDouble, int count = 5) {
  std::vector<ScanNumbers> scans;
  for (int i = 0; i < count; ++i) {
    const TimeNs stamp = first + i * kStep;
    scans.push_back(scan_of(stamp, type, [&](double share) {
      const double time = ((absolute ? seconds(stamp) : 0) + 0.1 * share) / unit;
      return Point{.time = is_real(type) ? time : std::round(time)};
    }));
  }
  return scans;
}

std::vector<std::string> notes_of(const RecognizedFormat& recognized) {
  std::vector<std::string> notes;
  for (const FormatNote& note : recognized.notes) notes.push_back(note.what);
  return notes;
}

std::string error_of(const std::vector<ScanNumbers>& scans, const StatedScanFormat& stated = {}) {
  try {
    recognize_format(scans, stated);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RecognizedFormat, EveryUnitAndReferenceOfTimes) {
  for (const double unit : {1.0, 1e-3, 1e-6, 1e-9}) {
    for (const bool absolute : {false, true}) {
      for (const Scalar type : {Scalar::kDouble, Scalar::kInt64}) {
        if (unit == 1 && type == Scalar::kInt64) continue;  // whole seconds of a sweep: all equal
        for (const TimeNs first : {kEpoch, TimeNs{0}, TimeNs{300 * kNsPerSecond}}) {
          const auto found = recognize_format(sweeps(unit, absolute, first, type), {});
          EXPECT_EQ(found.format.time_unit, unit) << absolute << " " << first;
          EXPECT_EQ(found.format.time_reference,
                    absolute ? TimeReference::kAbsolute : TimeReference::kStamp)
              << unit << " " << first;
          const bool usual = !absolute && unit == (is_real(type) ? 1 : 1e-9);
          EXPECT_EQ(found.notes.empty(), usual) << unit << absolute;
        }
      }
    }
  }
}

TEST(RecognizedFormat, TheNoteSaysUnitAndReference) {
  const auto found = recognize_format(sweeps(1e-6, true), {});
  EXPECT_THAT(notes_of(found),
              ElementsAre(AllOf(HasSubstr("in us"), HasSubstr("epoch of the stamps"))));
  EXPECT_EQ(found.notes.front().keys, "time_unit, time_reference");
}

TEST(RecognizedFormat, AFewWrongTimesDoNotDecide) {
  std::vector<ScanNumbers> scans = {scan_of(kEpoch, Scalar::kDouble, [](double share) {
    return Point{.time = share < 0.01 ? 1e9 : 100 * share};
  })};
  EXPECT_EQ(recognize_format(scans, {}).format.time_unit, 1e-3);
  // A fifth of the points has another time, which would fit another unit.
  scans = {scan_of(kEpoch, Scalar::kDouble,
                   [](double share) { return Point{.time = share < 0.2 ? 7 : 0.1 * share}; })};
  EXPECT_EQ(recognize_format(scans, {}).format.time_unit, 1);
}

TEST(RecognizedFormat, TimesInTwoGroupsAreAnErrorUnlessStated) {
  std::vector<ScanNumbers> scans = {scan_of(kEpoch, Scalar::kDouble, [](double share) {
    return Point{.time = (share < 0.4 ? 5 : 0) + 0.1 * share};
  })};
  EXPECT_THAT(error_of(scans), AllOf(HasSubstr("two groups"), HasSubstr("lidar.time_unit")));
  StatedScanFormat stated;
  stated.time_unit = 1;
  stated.time_reference = TimeReference::kNone;
  EXPECT_EQ(error_of(scans, stated), "no error");
  // A LiDAR that sees something ahead and behind only.
  scans = {scan_of(kEpoch, Scalar::kDouble, [](double share) {
    return Point{.time = 0.1 * (share < 0.5 ? 0.1 * share : 1 - 0.1 * share)};
  })};
  EXPECT_EQ(recognize_format(scans, {}).format.time_unit, 1);
}

TEST(RecognizedFormat, SlowAndFastSweepsAreSweeps) {
  for (const double duration : {0.004, 0.05, 0.5, 1.5}) {
    const std::vector<ScanNumbers> scans = {scan_of(kEpoch, Scalar::kDouble, [&](double share) {
      return Point{.time = 1e6 * duration * (share - 0.5)};
    })};
    EXPECT_EQ(recognize_format(scans, {}).format.time_unit, 1e-6) << duration;
  }
}

TEST(RecognizedFormat, EqualTimesAreNone) {
  const std::vector<ScanNumbers> scans = {
      scan_of(kEpoch, Scalar::kFloat, [](double) { return Point{.time = 0}; })};
  const auto found = recognize_format(scans, {});
  EXPECT_EQ(found.format.time_reference, TimeReference::kNone);
  EXPECT_THAT(notes_of(found), ElementsAre(HasSubstr("all times of a scan are equal")));
  // Stated, the times count.
  StatedScanFormat stated;
  stated.time_reference = TimeReference::kStamp;
  EXPECT_EQ(recognize_format(scans, stated).format.time_reference, TimeReference::kStamp);
}

TEST(RecognizedFormat, TimesOfAnotherClockAreAnError) {
  // GPS time instead of Unix time; the time since the start of the drive.
  for (const double offset : {-315'964'782.0, -1.7e9}) {
    std::vector<ScanNumbers> scans;
    for (int i = 0; i < 5; ++i) {
      const TimeNs stamp = kEpoch + i * kStep;
      scans.push_back(scan_of(stamp, Scalar::kDouble, [&](double share) {
        return Point{.time = seconds(stamp) + offset + 0.1 * share};
      }));
    }
    EXPECT_THAT(error_of(scans), AllOf(HasSubstr("off the stamps"), HasSubstr("time_reference"),
                                       HasSubstr("\"none\"")));
    StatedScanFormat stated;
    stated.time_reference = TimeReference::kNone;
    EXPECT_EQ(error_of(scans, stated), "no error");
  }
}

TEST(RecognizedFormat, OneScanNearTheEpochMayBeAmbiguous) {
  // The stamp is 50 ms: a sweep from 0 to 0.1 s is one from the stamp on, or around it.
  const std::vector<ScanNumbers> scans = {
      scan_of(kStep / 2, Scalar::kDouble, [](double share) { return Point{.time = 0.1 * share}; })};
  EXPECT_THAT(error_of(scans), AllOf(HasSubstr("time_reference"), HasSubstr("\"absolute\"")));
  // At 0.3 s, only one reference has the stamp within the sweep.
  for (const bool absolute : {false, true}) {
    const auto found =
        recognize_format(sweeps(1, absolute, 3 * kStep, Scalar::kDouble, 1), {}).format;
    EXPECT_EQ(found.time_reference, absolute ? TimeReference::kAbsolute : TimeReference::kStamp);
  }
}

TEST(RecognizedFormat, NoUnitMakesItASweep) {
  const std::vector<ScanNumbers> scans = {scan_of(
      kEpoch, Scalar::kInt32, [](double share) { return Point{.time = std::round(4 * share)}; })};
  EXPECT_THAT(error_of(scans), AllOf(HasSubstr("time_unit"), HasSubstr("\"none\"")));
}

TEST(RecognizedFormat, NoSweepTakesManyStepsOfTheStamps) {
  // 1.5 ms in ns, as of a flash LiDAR, are no 1.5 s in us.
  std::vector<ScanNumbers> scans;
  for (int i = 0; i < 5; ++i) {
    scans.push_back(scan_of(kEpoch + i * kStep, Scalar::kUint32,
                            [](double share) { return Point{.time = std::round(1.5e6 * share)}; }));
  }
  EXPECT_THAT(error_of(scans), HasSubstr("lidar.time_unit"));
  StatedScanFormat stated;
  stated.time_unit = 1e-9;
  EXPECT_EQ(recognize_format(scans, stated).format.time_unit, 1e-9);
}

TEST(RecognizedFormat, WhatIsStatedWinsUnlessItCannotBeRight) {
  StatedScanFormat stated;
  stated.time_unit = 1e-3;
  const auto found = recognize_format(sweeps(1e-3, true), stated);
  EXPECT_EQ(found.format.time_reference, TimeReference::kAbsolute);
  stated.time_reference = TimeReference::kAbsolute;
  EXPECT_THAT(recognize_format(sweeps(1e-3, true), stated).notes, IsEmpty());
  stated.time_unit = 1;
  EXPECT_THAT(error_of(sweeps(1e-3, true), stated),
              AllOf(HasSubstr("a sweep takes 100"), HasSubstr("lidar.time_unit")));
  stated.time_unit = 1e-6;
  EXPECT_THAT(error_of(sweeps(1e-3, true), stated), HasSubstr("lidar.time_unit"));
  stated.time_unit.reset();
  stated.time_reference = TimeReference::kStamp;
  EXPECT_THAT(error_of(sweeps(1e-3, true), stated),
              AllOf(HasSubstr("1.7e+09 s off"), HasSubstr("lidar.time_reference")));
}

std::vector<ScanNumbers> of_range(double range, Scalar axis_type = Scalar::kFloat) {
  return {scan_of(
      kEpoch, Scalar::kFloat,
      [&](double share) { return Point{.range = range * (0.5 + share), .time = 0.1 * share}; },
      axis_type)};
}

TEST(RecognizedFormat, LengthsInMillimeters) {
  EXPECT_EQ(recognize_format(of_range(12), {}).format.length_unit, 1);
  for (const Scalar type : {Scalar::kFloat, Scalar::kInt32}) {
    const auto found = recognize_format(of_range(12'000, type), {});
    EXPECT_EQ(found.format.length_unit, 1e-3);
    EXPECT_THAT(notes_of(found), ElementsAre(HasSubstr("coordinates are in mm")));
  }
  // Centimeters, or millimeters in a room; whole meters; a map's coordinates.
  for (const auto& scans : {of_range(1200), of_range(20, Scalar::kInt16), of_range(5.4e6)}) {
    EXPECT_THAT(error_of(scans), AllOf(HasSubstr("lidar.length_unit"), HasSubstr("\"cm\"")));
  }
  StatedScanFormat stated;
  stated.length_unit = 0.01;
  EXPECT_EQ(recognize_format(of_range(1200), stated).format.length_unit, 0.01);
  EXPECT_THAT(recognize_format(of_range(1200), stated).notes, IsEmpty());
  stated.length_unit = 1;
  EXPECT_THAT(error_of(of_range(12'000), stated), HasSubstr("lidar.length_unit"));
  stated.length_unit = 1e-3;
  EXPECT_THAT(error_of(of_range(12), stated), HasSubstr("lidar.length_unit"));
}

TEST(RecognizedFormat, IntensitiesOfEightAndSixteenBits) {
  const auto up_to = [](double most) {
    return std::vector<ScanNumbers>{scan_of(kEpoch, Scalar::kFloat, [&](double share) {
      return Point{.intensity = most * share, .time = 0.1 * share};
    })};
  };
  EXPECT_EQ(recognize_format(up_to(1), {}).format.intensity_max, 1);
  EXPECT_EQ(recognize_format(up_to(200), {}).format.intensity_max, 255);
  EXPECT_EQ(recognize_format(up_to(4000), {}).format.intensity_max, 65535);
  StatedScanFormat stated;
  stated.intensity_max = 100;
  EXPECT_EQ(recognize_format(up_to(150), stated).format.intensity_max, 100);
  EXPECT_THAT(recognize_format(up_to(150), stated).notes, IsEmpty());
  stated.intensity_max = 1;
  EXPECT_THAT(error_of(up_to(200), stated),
              AllOf(HasSubstr("most intensities exceed 1"), HasSubstr("lidar.intensity_max"),
                    HasSubstr("state 255")));
}

TEST(RecognizedFormat, ColumnsOfOtherNamesAndColumnsThatAreNotRead) {
  ScanNumbers scan;
  scan.columns = {"X", "Y", "Z", "scalar_Intensity", "t"};
  EXPECT_THAT(notes_of(recognize_format(std::vector{scan}, {})),
              ElementsAre(HasSubstr("X as x, Y as y, Z as z, scalar_Intensity as intensity")));
  scan.columns = {"x", "y", "z", "strength", "when"};
  EXPECT_THAT(notes_of(recognize_format(std::vector{scan}, {})),
              ElementsAre(HasSubstr("known as intensity or time; not read: strength, when")));
  scan.columns = {"x", "y", "z", "intensity", "ring", "time", "label"};
  EXPECT_THAT(recognize_format(std::vector{scan}, {}).notes, IsEmpty());
}

TEST(RecognizedFormat, WithoutAScanItIsTheUsualFormat) {
  const auto found = recognize_format({}, {});
  EXPECT_EQ(found.format.time_reference, TimeReference::kStamp);
  EXPECT_EQ(found.format.length_unit, 1);
  EXPECT_EQ(found.format.intensity_max, 1);
  EXPECT_THAT(found.notes, IsEmpty());
}

}  // namespace fovea::recognized_format_test
