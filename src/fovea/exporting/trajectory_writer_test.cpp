#include "fovea/exporting/trajectory_writer.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/core/read_file.h"
#include "fovea/errors.h"
#include "fovea/geometry/georeference.h"

namespace fovea::trajectory_writer_test {

constexpr GeodeticPoint kKarlsruhe{49.0, 8.4, 115};

/// East by 1000 m, turned by 90 degrees to the left; and a frame that was skipped.
std::vector<FrameRecord> frames() {
  std::vector<FrameRecord> frames(2);
  frames[0].index = 7;
  frames[0].stamp = 1'317'046'453'072'943'357;
  frames[0].T_local_lidar.translation() = Eigen::Vector3d(1000, 0, 0);
  frames[0].T_local_lidar.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  frames[1].index = 8;
  frames[1].status = FrameStatus::kSkipped;
  return frames;
}

TEST(TrajectoryWriter, TumHasSecondsPositionAndQuaternion) {
  const TemporaryFolder folder;
  write_tum_trajectory(frames(), folder / "a.tum", false);
  std::istringstream line(read_text(folder / "a.tum"));
  std::string stamp;
  line >> stamp;
  EXPECT_EQ(stamp, "1317046453.072943357");
  for (const double expected : {1000.0, 0.0, 0.0, 0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)}) {
    double number = -1;
    line >> number;
    EXPECT_NEAR(number, expected, 1e-15);
  }
  EXPECT_TRUE((line >> std::ws).eof());
}

TEST(TrajectoryWriter, TumHasNegativeStamps) {
  const TemporaryFolder folder;
  std::vector<FrameRecord> early = frames();
  early[0].stamp = -5;
  write_tum_trajectory(early, folder / "a.tum", false);
  EXPECT_THAT(read_text(folder / "a.tum"), testing::StartsWith("-0.000000005 "));
}

TEST(TrajectoryWriter, TheTableHasUtmIfTheMapHasAnOrigin) {
  const TemporaryFolder folder;
  write_trajectory_table(frames(), std::nullopt, folder / "local.csv", false);
  EXPECT_THAT(read_text(folder / "local.csv"),
              testing::StartsWith("index,time_ns,status,x_m,y_m,z_m,qx,qy,qz,qw\n7,"
                                  "1317046453072943357,mapped,1000,0,0,0,0,"));
  write_trajectory_table(frames(), kKarlsruhe, folder / "utm.csv", false);
  const std::string text = read_text(folder / "utm.csv");
  EXPECT_THAT(text, testing::HasSubstr(",easting_m,northing_m,height_m,crs\n"));
  EXPECT_THAT(text, testing::HasSubstr("UTM zone 32N"));
  // A kilometer east of the origin, by the scale of UTM there. The earth falls off by 8 cm.
  const Georeference utm(Crs::kUtm, kKarlsruhe, "");
  const Eigen::Vector3d moved = utm.from_local({1000, 0, 0}) - utm.from_local({0, 0, 0});
  EXPECT_NEAR(moved.head<2>().norm(), 1000, 1);
  EXPECT_NEAR(moved.z(), 0.078, 0.002);
  EXPECT_THAT(text, testing::HasSubstr(fmt::format(",{:.4f},", utm.from_local({1000, 0, 0}).x())));
}

TEST(TrajectoryWriter, GeojsonIsALineAndPointsOnTheEarth) {
  const TemporaryFolder folder;
  write_geojson_trajectory(frames(), kKarlsruhe, folder / "a.geojson", false);
  const auto json = nlohmann::json::parse(read_text(folder / "a.geojson"));
  ASSERT_EQ(json["features"].size(), 2u);
  EXPECT_EQ(json["features"][0]["geometry"]["type"], "LineString");
  const auto& point = json["features"][1];
  // 1000 m on a parallel at 49 degrees: 1000 / (a cos(lat) / sqrt(1 - e^2 sin(lat)^2)).
  const double expected_degrees = 0.013666;
  EXPECT_NEAR(point["geometry"]["coordinates"][0].get<double>(), 8.4 + expected_degrees, 1e-6);
  EXPECT_NEAR(point["geometry"]["coordinates"][1].get<double>(), 49, 1e-5);
  EXPECT_EQ(point["properties"]["index"], 7);
  EXPECT_EQ(point["properties"]["time_ns"], "1317046453072943357");
}

TEST(TrajectoryWriter, RefusesWhatItCannotWrite) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_geojson_trajectory(frames(), std::nullopt, folder / "a", false), InputError);
  EXPECT_THROW(write_tum_trajectory({}, folder / "a", false), InputError);
  std::vector<FrameRecord> without_stamp = frames();
  without_stamp[0].stamp.reset();
  EXPECT_THROW(write_tum_trajectory(without_stamp, folder / "a", false), InputError);
  EXPECT_TRUE(folder.names().empty());
  write_trajectory_table(frames(), std::nullopt, folder / "a", false);
  EXPECT_THROW(write_trajectory_table(frames(), std::nullopt, folder / "a", false), OutputError);
}

}  // namespace fovea::trajectory_writer_test
