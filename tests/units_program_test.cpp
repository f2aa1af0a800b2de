// Drives whose scans and tables have other units, epochs and names than the usual ones, and scans
// with points that cannot be used.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "fovea/map/map_store.h"
#include "tests/kitti_writer.h"
#include "tests/program.h"
#include "tests/synthetic_drive.h"

namespace fovea::units_program_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

namespace fs = std::filesystem;

constexpr std::int64_t kEpoch = 1'700'000'000;  // s
constexpr int kRings = 32, kColumns = 360, kPoints = kRings * kColumns;

struct Point {
  Eigen::Vector3d position;          // m
  double intensity = 0.2, time = 0;  // s from the stamp
};

/// Adds the numbers of a point to the data of a PCD file.
using Encode = std::function<void(std::string&, const Point&, int frame)>;

template <class T>
void put(std::string& bytes, double value) {
  const T number = std::is_integral_v<T> ? T(std::llround(value)) : T(value);
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

struct Fields {
  std::string names, sizes, types;
};
const Fields kUsual = {"x y z intensity time", "4 4 4 4 4", "F F F F F"};

void encode_usual(std::string& bytes, const Point& point, int /*frame*/) {
  for (const double value :
       {point.position.x(), point.position.y(), point.position.z(), point.intensity, point.time}) {
    put<float>(bytes, value);
  }
}

class UnitsProgram : public testing::Test {
 protected:
  std::string quoted(const std::string& name) const {
    return fmt::format("'{}'", (folder_ / name).string());
  }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  ProgramRun map(const std::string& drive, const std::string& more = "") const {
    return run_fovea("map " + quoted(drive) + " -o " + quoted(drive + ".fovea") + " " + more);
  }
  std::vector<FrameRecord> frames_of(const std::string& drive) const {
    return MapReader(folder_ / (drive + ".fovea")).frames();
  }

  /// Scans in a yard, 0.9 m apart along x. Each sweep is taken on the spot, from the stamp on.
  void write_drive(const std::string& drive, int frames, const Fields& fields, const Encode& encode,
                   const std::string& lidar_keys = "", const std::string& stamps = "") const {
    const BoxScene yard{{{{-14, -9, -1.7}, {14, 9, 8}},
                         {{4, 2, -1.7}, {6, 5, 0.3}},
                         {{-7, -6, -1.7}, {-5, -4, 1.3}},
                         {{7, -7, -1.7}, {8, -3, 0.8}}}};
    write(drive + "/drive.toml", "version = 1\n[lidar]\n" + lidar_keys);
    std::string table = "index,time_ns\n";
    for (int frame = 0; frame < frames; ++frame) {
      std::string data;
      for (int column = 0; column < kColumns; ++column) {
        for (int ring = 0; ring < kRings; ++ring) {
          const double elevation = (ring - 20) * 1.2 * std::numbers::pi / 180,
                       azimuth = column * std::numbers::pi / 180;
          const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                    std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
          const double range = yard.cast({0.9 * frame, 0, 0}, ray).value();
          encode(data, {range * ray, 0.2, 0.1 * column / kColumns}, frame);
        }
      }
      write(fmt::format("{}/lidar/{:06}.pcd", drive, frame),
            fmt::format("VERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nWIDTH {}\nHEIGHT 1\n"
                        "DATA binary\n",
                        fields.names, fields.sizes, fields.types, kPoints) +
                data);
      table += fmt::format("{},{}\n", frame, kEpoch * kNsPerSecond + frame * kNsPerSecond / 10);
    }
    write(drive + "/lidar/stamps.csv", stamps.empty() ? table : stamps);
  }

  /// Expects that all points of the first frame are mapped as those of the usual drive.
  void expect_as_usual(const std::string& drive, const std::string& note) const {
    const ProgramRun run = map(drive);
    ASSERT_EQ(run.exit_code, 0) << drive << ": " << run.err;
    EXPECT_THAT(run.out, HasSubstr(note));
    const FrameRecord frame = frames_of(drive).at(0), usual = frames_of("usual").at(0);
    EXPECT_EQ(frame.figures.at("points_scan"), double(kPoints)) << drive;
    EXPECT_EQ(frame.figures.at("points_dropped"), 0);
    const PointCloud points = MapReader(folder_ / (drive + ".fovea")).all_points_local(),
                     expected = MapReader(folder_ / "usual.fovea").all_points_local();
    ASSERT_NEAR(double(points.size()), double(expected.size()), 0.01 * double(expected.size()));
    EXPECT_NEAR(points.intensity.at(0), 0.2, 2e-3) << drive;
  }
  void map_usual() const {
    write_drive("usual", 1, kUsual, encode_usual);
    const ProgramRun run = map("usual");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, AllOf(Not(HasSubstr("recognized")), Not(HasSubstr("dropped"))));
  }
  void expect_error(const std::string& drive, const testing::Matcher<std::string>& message) const {
    const ProgramRun run = map(drive);
    EXPECT_EQ(run.exit_code, 1) << drive;
    EXPECT_THAT(run.err, AllOf(StartsWith("fovea: error: "), message));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(fs::exists(folder_ / (drive + ".fovea")));
  }

  TemporaryFolder folder_;
};

template <class Time>
Encode with_time(double unit, bool absolute) {
  return [=](std::string& bytes, const Point& point, int frame) {
    for (int axis = 0; axis < 3; ++axis) put<float>(bytes, point.position[axis]);
    put<float>(bytes, point.intensity);
    put<Time>(bytes, ((absolute ? double(kEpoch) + 0.1 * frame : 0) + point.time) / unit);
  };
}

TEST_F(UnitsProgram, TimesOfPointsInAnyUnitAndFromAnyEpoch) {
  map_usual();
  write_drive("ms", 1, kUsual, with_time<float>(1e-3, false));
  expect_as_usual("ms", "the points' times are in ms and count from the scan's stamp");
  write_drive("us", 1, {"x y z intensity t", "4 4 4 4 4", "F F F F U"},
              with_time<std::uint32_t>(1e-6, false));
  expect_as_usual("us", "the points' times are in us and count from the scan's stamp");
  const Fields wide = {"x y z intensity timestamp", "4 4 4 4 8", "F F F F F"};
  write_drive("since_1970", 1, wide, with_time<double>(1, true));
  expect_as_usual("since_1970",
                  "the points' times are in s and count from the epoch of the stamps");
  write_drive("ns", 1, {wide.names, wide.sizes, "F F F F U"}, with_time<std::uint64_t>(1e-9, true));
  expect_as_usual("ns", "the points' times are in ns and count from the epoch of the stamps");
}

TEST_F(UnitsProgram, ColumnsOfOtherProgramsAndOtherUnits) {
  map_usual();
  write_drive("pdal", 1, {"X Y Z Intensity Time_Stamp", kUsual.sizes, kUsual.types}, encode_usual);
  expect_as_usual("pdal", "X as x, Y as y, Z as z, Intensity as intensity, Time_Stamp as time");
  write_drive("mm", 1, {"x y z i time", "4 4 4 1 4", "I I I U F"},
              [](std::string& bytes, const Point& point, int) {
                for (int axis = 0; axis < 3; ++axis) {
                  put<std::int32_t>(bytes, 1e3 * point.position[axis]);
                }
                put<std::uint8_t>(bytes, 255 * point.intensity);
                put<float>(bytes, point.time);
              });
  expect_as_usual("mm", "coordinates are in mm");
  write_drive("bits", 1, {"x y z scalar_Intensity time", kUsual.sizes, kUsual.types},
              [](std::string& bytes, Point point, int frame) {
                point.intensity *= 65535;
                encode_usual(bytes, point, frame);
              });
  expect_as_usual("bits", "65535 stands for a reflectance of 1");
}

TEST_F(UnitsProgram, StampsInMicrosecondsAndSeconds) {
  for (const auto& [name, header, note] :
       {std::tuple("us", "index,time_ns\n", "stamps.csv are in us"),
        std::tuple("s", "Index,Timestamp\n", "stamps.csv are in s"),
        std::tuple("stated", "index,time_us\n", "frames")}) {
    std::string stamps = header;
    for (int i = 0; i < 3; ++i) {
      stamps += std::string_view(name) == "s" ? fmt::format("{},{}.{}00\n", i, kEpoch, i)
                                              : fmt::format("{},{}{}00000\n", i, kEpoch, i);
    }
    write_drive(name, 3, kUsual, encode_usual, "", stamps);
    const ProgramRun run = map(name);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, AllOf(HasSubstr(note), Not(HasSubstr("steps by"))));
    const std::vector<FrameRecord> frames = frames_of(name);
    ASSERT_EQ(frames.size(), 3u);
    EXPECT_EQ(frames[2].stamp, kEpoch * kNsPerSecond + 2 * kNsPerSecond / 10);
  }
}

TEST_F(UnitsProgram, WhatCannotBeRightIsAnErrorThatNamesTheKey) {
  write_drive("unit", 1, kUsual, with_time<float>(1e-3, false), "time_unit = \"s\"\n");
  expect_error("unit", AllOf(HasSubstr("lidar.time_unit"), HasSubstr("a sweep takes")));
  write_drive("reference", 1, {"x y z intensity time", "4 4 4 4 8", "F F F F F"},
              with_time<double>(1, true), "time_reference = \"stamp\"\n");
  expect_error("reference", HasSubstr("lidar.time_reference"));
  write_drive("length", 1, kUsual, [](std::string& bytes, Point point, int frame) {
    point.position *= 100;
    encode_usual(bytes, point, frame);
  });
  expect_error("length", HasSubstr("lidar.length_unit"));
  write_drive("stamps", 3, kUsual, encode_usual, "",
              "index,time_us\n0,0\n1,100000000\n2,200000000\n");
  expect_error("stamps",
               AllOf(HasSubstr("100 s apart by the column time_us"), HasSubstr("stamps.csv")));
}

/// Spoils every `every`th point.
Encode spoiled(int every, const std::function<void(Point&)>& spoil) {
  const auto count = std::make_shared<int>(0);
  return [=](std::string& bytes, Point point, int frame) {
    if ((*count)++ % every == 0) spoil(point);
    encode_usual(bytes, point, frame);
  };
}

TEST_F(UnitsProgram, ManyDroppedPointsAreAnErrorUnlessAllowed) {
  const auto not_finite = [](Point& p) {
    p.position.x() = std::numeric_limits<double>::quiet_NaN();
  };
  write_drive("nan", 1, kUsual, spoiled(5, not_finite));
  expect_error("nan", AllOf(HasSubstr("2304 of 11520 points (20 %)"), HasSubstr("2304 not finite"),
                            HasSubstr("--allow-dropped")));
  const ProgramRun allowed = map("nan", "--allow-dropped --report " + quoted("r.json"));
  ASSERT_EQ(allowed.exit_code, 0) << allowed.err;
  EXPECT_THAT(allowed.err,
              HasSubstr("warning: 2304 of 11520 points of the scans are dropped (20 %)"));
  const auto report = nlohmann::json::parse(read_text(folder_ / "r.json")).at("map");
  EXPECT_EQ(report.at("points_read"), kPoints);
  EXPECT_EQ(report.at("points_dropped").at("not_finite"), kPoints / 5);
  EXPECT_EQ(report.at("points_dropped").at("off_time"), 0);

  write_drive("late", 1, kUsual, spoiled(6, [](Point& p) { p.time = 7; }));
  expect_error("late", AllOf(HasSubstr("1920 over 1 s off the stamp"), HasSubstr("time_unit")));
  write_drive("far", 1, kUsual, spoiled(6, [](Point& p) { p.position *= 1e4; }));
  expect_error("far", AllOf(HasSubstr("1920 beyond 1 km"), HasSubstr("length_unit")));
}

TEST_F(UnitsProgram, FewDroppedPointsAndMissingReturnsAreCounted) {
  write_drive("few", 1, kUsual, spoiled(20, [](Point& p) { p.time = -3; }));
  const ProgramRun few = map("few");
  EXPECT_EQ(few.exit_code, 0) << few.err;
  EXPECT_THAT(few.err,
              HasSubstr("576 of 11520 points of the scans are dropped (5 %): 576 over 1 s"));
  write_drive("sky", 1, kUsual, spoiled(3, [](Point& p) { p.position.setZero(); }));
  const ProgramRun sky = map("sky");
  EXPECT_EQ(sky.exit_code, 0) << sky.err;
  EXPECT_THAT(sky.out, HasSubstr("3840 without a return"));
}

}  // namespace fovea::units_program_test
