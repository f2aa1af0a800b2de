#include "fovea/map/point_files/las_writer.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "../../../../tests/file_size_limit.h"
#include "../../../../tests/sample_map.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map/map_meta.h"

namespace fovea::las_writer_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::size_t kRecord = 36 + 13;  // point format 7 and our extra bytes

/// The bytes of a LAS file, read by the offsets of the specification (LAS 1.4 - R15).
struct Las {
  explicit Las(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    bytes = text.str();
  }
  template <class T>
  T at(std::size_t offset) const {
    T value{};
    std::memcpy(&value, bytes.substr(offset, sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::size_t count() const { return at<std::uint64_t>(247); }
  std::size_t point(std::size_t index) const { return at<std::uint32_t>(96) + index * kRecord; }
  Eigen::Vector3d position(std::size_t index) const {
    Eigen::Vector3d p;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p[int(axis)] = at<std::int32_t>(point(index) + 4 * axis) * at<double>(131 + 8 * axis) +
                     at<double>(155 + 8 * axis);
    }
    return p;
  }
  double gps_time(std::size_t index) const { return at<double>(point(index) + 22); }
  std::string bytes;
};

class LasWriter : public testing::Test {
 protected:
  void SetUp() override {
    write_sample_map(folder_ / "a.fovea");
    change([](MapWriter& writer) {  // every frame has a date
      for (FrameRecord frame : sample_frames()) {
        if (frame.index == 8) frame.stamp = *sample_frames()[0].stamp + 100'000'000;
        writer.put_frame(frame);
      }
    });
  }
  void change(const std::function<void(MapWriter&)>& f) const {
    const auto writer = MapWriter::open(folder_ / "a.fovea");
    f(*writer);
    writer->commit();
  }
  LasFigures write(const LasOptions& options = {}) {
    return write_las(MapReader(folder_ / "a.fovea"), folder_ / "a.las", options);
  }
  double gps_time_of(int frame, LasOptions options = {}) {
    options.points.where = PointFilter::parse(fmt::format("frame == {}", frame));
    options.points.include_uncolored = true;
    options.force = true;
    write(options);
    return Las(folder_ / "a.las").gps_time(0);
  }
  TemporaryFolder folder_;
};

TEST_F(LasWriter, HeaderSaysWhatFollows) {
  const LasFigures figures = write();
  const Las las(folder_ / "a.las");
  EXPECT_EQ(las.bytes.substr(0, 4), "LASF");
  EXPECT_EQ(las.at<std::uint16_t>(6), 1 | 8 | 16);  // GPS time, synthetic returns, WKT
  EXPECT_EQ(las.at<std::uint8_t>(24), 1);
  EXPECT_EQ(las.at<std::uint8_t>(25), 4);
  EXPECT_EQ(las.at<std::uint16_t>(90), 269);  // 26 September, the drive's day
  EXPECT_EQ(las.at<std::uint16_t>(92), 2011);
  EXPECT_EQ(las.at<std::uint16_t>(94), 375);
  EXPECT_EQ(las.at<std::uint32_t>(100), 3u);
  EXPECT_EQ(las.at<std::uint8_t>(104), 7);
  EXPECT_EQ(las.at<std::uint16_t>(105), kRecord);
  for (std::size_t legacy = 107; legacy < 131; legacy += 4) {
    EXPECT_EQ(las.at<std::uint32_t>(legacy), 0u);
  }
  EXPECT_EQ(las.at<std::uint64_t>(227), 0u);
  EXPECT_EQ(las.at<std::uint64_t>(235), 0u);
  EXPECT_EQ(las.count(), figures.points);
  EXPECT_EQ(las.at<std::uint64_t>(255), figures.points);
  EXPECT_EQ(las.bytes.size(), las.point(las.count()));
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < las.count(); ++i) box.extend(las.position(i));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(las.at<double>(179 + 16 * axis), box.max()[int(axis)]);
    EXPECT_EQ(las.at<double>(187 + 16 * axis), box.min()[int(axis)]);
  }
}

TEST_F(LasWriter, EveryFieldOfEveryPoint) {
  LasOptions options;
  options.points.include_uncolored = true;
  const LasFigures figures = write(options);
  const Las las(folder_ / "a.las");
  ASSERT_EQ(las.count(), sample_tile_map().size());
  const ColorDisplay display = color_display({}, MapReader(folder_ / "a.fovea").frames());
  std::size_t row = 0, without_time = 0;
  for_each_sample_point([&](const Eigen::Vector3d& p_local, const PointCloud& tile, std::size_t i) {
    const std::size_t at = las.point(row);
    EXPECT_LE((las.position(row) - p_local).cwiseAbs().maxCoeff(), 0.0005 + 1e-9);
    EXPECT_EQ(las.at<std::uint16_t>(at + 12), std::lround(tile.intensity[i] * 65535.0));
    EXPECT_EQ(las.at<std::uint8_t>(at + 14), 0x11);
    EXPECT_EQ(las.at<std::uint8_t>(at + 15), tile.interpolated[i]);
    EXPECT_EQ(las.at<std::uint8_t>(at + 16), 1);
    const Rgb color = tile.camera[i] == kNoCamera ? kUncolored : display(tile.color[i]);
    EXPECT_EQ(las.at<std::uint16_t>(at + 30), color.r * 257);
    EXPECT_EQ(las.at<std::uint16_t>(at + 32), color.g * 257);
    EXPECT_EQ(las.at<std::uint16_t>(at + 34), color.b * 257);
    EXPECT_EQ(las.at<std::int8_t>(at + 36), tile.camera[i]);
    EXPECT_EQ(las.at<std::int32_t>(at + 37), tile.frame[i]);
    EXPECT_EQ(las.at<float>(at + 41), tile.range[i]);
    EXPECT_EQ(las.at<std::uint8_t>(at + 45), tile.interpolated[i]);
    EXPECT_EQ(las.at<std::uint8_t>(at + 46), tile.views[i]);
    EXPECT_EQ(las.at<std::uint8_t>(at + 47), tile.spread[i]);
    EXPECT_EQ(las.at<std::uint8_t>(at + 48), tile.reason[i]);
    // Frame 7 is of 2011-09-26 14:14:13.07 UTC, and GPS was 15 leap seconds ahead.
    if (tile.frame[i] == 7) {
      EXPECT_NEAR(las.gps_time(row), 1317046453.072943 - 315964800 + 15 - 1e9, 1e-6);
    } else if (tile.frame[i] != 8) {
      EXPECT_EQ(las.gps_time(row), 0);
      ++without_time;
    }
    ++row;
  });
  EXPECT_EQ(figures.points_without_time, without_time);
  EXPECT_TRUE(figures.dated);
}

// Frame 7 is of 14:14:13.07 by its stamp. GPS seconds at 2011-09-26 00:00:00 UTC: 1655 weeks and
// one day since 1980-01-06, and 15 leap seconds.
constexpr double kMidnight = (1655 * 7 + 1) * 86400.0 + 15 - 1e9;
constexpr double kStamp = 14 * 3600 + 14 * 60 + 13.072943;

TEST_F(LasWriter, KittiStampsAreTheSummerTimeOfKarlsruhe) {
  for (const char* kind : {"kitti-raw", "kitti-odometry"}) {
    change([&](MapWriter& writer) {
      DriveRecord drive = sample_drive();
      drive.kind = kind;
      writer.put_drive(0, drive);
    });
    EXPECT_NEAR(gps_time_of(7), kMidnight + kStamp - 7200, 1e-6) << kind;
  }
}

TEST_F(LasWriter, EachDriveOfAMapHasItsOwnClock) {
  change([](MapWriter& writer) {
    DriveRecord drive = sample_drive();
    drive.first_frame = 8;
    writer.put_drive(1, drive);
    drive.kind = "kitti-raw";
    drive.first_frame = 7;
    drive.end_frame = 8;
    writer.put_drive(0, drive);
  });
  EXPECT_NEAR(gps_time_of(7), kMidnight + kStamp - 7200, 1e-6);
  EXPECT_NEAR(gps_time_of(8), kMidnight + kStamp + 0.1, 1e-6);
}

TEST_F(LasWriter, StampsOfAMapWithoutDrivesAreUtc) {
  change([](MapWriter& writer) {
    DriveRecord drive = sample_drive();
    drive.kind = "";
    writer.put_drive(0, drive);
  });
  EXPECT_NEAR(gps_time_of(7), kMidnight + kStamp, 1e-6);
}

TEST_F(LasWriter, TheStatedOffsetOverridesTheDrive) {
  LasOptions options;
  options.utc_offset = -TimeNs{5} * 1800 * kNsPerSecond;
  EXPECT_NEAR(gps_time_of(7, options), kMidnight + kStamp + 9000, 1e-6);
}

// Stamps of an odometry sequence count from its begin.
TEST_F(LasWriter, StampsWithoutADateAreNoGpsTimes) {
  change([](MapWriter& writer) {
    FrameRecord frame = sample_frames()[0];
    frame.stamp = 12'500'000'000;
    writer.put_frame(frame);
  });
  LasOptions options;
  options.points.where = PointFilter::parse("frame == 7");
  options.points.include_uncolored = true;
  EXPECT_FALSE(write(options).dated);
  const Las las(folder_ / "a.las");
  EXPECT_EQ(las.at<std::uint16_t>(6), 8 | 16);
  EXPECT_EQ(las.at<std::uint16_t>(92), 0);
  EXPECT_EQ(las.gps_time(0), 12.5);
}

TEST_F(LasWriter, CoordinatesOfTheEarthToAMillimetre) {
  LasOptions options;
  for (const Crs crs : {Crs::kUtm, Crs::kEcef}) {
    options.points.crs = crs;
    write(options);
    options.force = true;
    const Las las(folder_ / "a.las");
    const Georeference expected(crs, map_origin(MapReader(folder_ / "a.fovea").meta()), "a.fovea");
    std::size_t row = 0;
    for_each_sample_point(
        [&](const Eigen::Vector3d& p_local, const PointCloud& tile, std::size_t i) {
          if (tile.camera[i] == kNoCamera) return;
          const Eigen::Vector3d error = las.position(row++) - expected.from_local(p_local);
          EXPECT_LE(error.cwiseAbs().maxCoeff(), 0.0005 + 1e-8);
        });
    EXPECT_EQ(row, las.count());
    EXPECT_THAT(las.bytes.substr(375, las.point(0) - 375),
                HasSubstr(expected.wkt1() + std::string(1, '\0')));
  }
}

TEST_F(LasWriter, TheSameMapGivesTheSameBytes) {
  write();
  const std::string first = Las(folder_ / "a.las").bytes;
  write({.force = true});
  EXPECT_EQ(Las(folder_ / "a.las").bytes, first);
}

TEST_F(LasWriter, RefusesPointsThatDoNotFitItsIntegers) {
  change([](MapWriter& writer) {
    RigidMotion far = RigidMotion::Identity();
    far.translation().x() = 2.2e6;
    writer.put_submap(1, far);
  });
  EXPECT_THROW(write(), InputError);
  EXPECT_THAT(folder_.names(), ElementsAre("a.fovea"));
}

TEST_F(LasWriter, NoStampIsTooWildToBeRead) {
  for (const TimeNs stamp :
       {std::numeric_limits<TimeNs>::min(), std::numeric_limits<TimeNs>::max(), TimeNs{0}}) {
    change([&](MapWriter& writer) {
      FrameRecord frame = sample_frames()[0];
      frame.stamp = stamp;
      writer.put_frame(frame);
    });
    EXPECT_FALSE(write({.force = true}).dated);
  }
}

TEST_F(LasWriter, AnEmptyMapGivesAnEmptyFile) {
  MapWriter::create(folder_ / "b.fovea", false)->commit();
  EXPECT_EQ(write_las(MapReader(folder_ / "b.fovea"), folder_ / "b.las").points, 0u);
  const Las las(folder_ / "b.las");
  EXPECT_EQ(las.count(), 0u);
  EXPECT_EQ(las.at<double>(179), 0);
}

TEST_F(LasWriter, LeavesNothingWhenTheDiskIsFull) {
  const MapReader reader(folder_ / "a.fovea");
  const FileSizeLimit limit(30'000);
  EXPECT_THROW(write_las(reader, folder_ / "a.las"), OutputError);
  EXPECT_THAT(folder_.names(), ElementsAre("a.fovea"));
}

}  // namespace fovea::las_writer_test
