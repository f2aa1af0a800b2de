// Maps of live drives whose navigation begins later.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "../../../tests/temporary_folder.h"
#include "fovea/drive/live/test_live_drive.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/map_store.h"
#include "fovea/pipeline/live_state.h"
#include "fovea/pipeline/map_live.h"
#include "fovea/pipeline/mapper_test_support.h"

namespace fovea::map_live_navigation_test {
namespace {

constexpr int kFrames = 30, kBegin = 14;

const SyntheticDrive& town() {
  static const SyntheticDrive drive(town_scene(), kFrames, 0.8);
  return drive;
}

/// Where the vehicle is in the east-north-up frame of a point. The town is turned and shifted.
const GeodeticPoint kPlace{49, 8.4, 110};
RigidMotion T_enu_lidar(int frame) {
  RigidMotion T_enu_town(Eigen::Translation3d(40, -30, 2));
  T_enu_town.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  return T_enu_town * town().T_local_lidar[std::size_t(frame)];
}

/// @param fix  the first frame with a position
test::LiveData town_data(int begin, int end, int fix) {
  test::LiveData data;
  data.drive.lidar.sweep_compensated = true;
  const Camera& camera = town().info().calibration.cameras.front();
  data.drive.cameras = {
      {"front",
       2,
       {camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, Lens()},
       camera.T_cam_lidar.inverse()}};
  const LocalTangentPlane plane(kPlace);
  for (int i = begin; i < end; ++i) {
    const Frame frame = std::get<Frame>(town().load(i));
    const TimeNs stamp = test::kLiveStart + frame.stamp;
    data.scans.push_back({"", stamp, frame.scan});
    const std::vector<std::uint8_t> png = encode_png(frame.images.front());
    data.images.push_back({"front", stamp, std::string(png.begin(), png.end())});
    if (i < fix) continue;
    const RigidMotion T = T_enu_lidar(i);
    RecordedPosition& position = data.positions.emplace_back();
    position.time = stamp;
    position.antenna = plane.to_geodetic(T.translation());
    position.accuracy = 0.02;
    const Eigen::Matrix3d R = T.linear();
    position.roll_pitch_yaw =
        Eigen::Vector3d(std::atan2(R(2, 1), R(2, 2)), -std::asin(std::clamp(R(2, 0), -1.0, 1.0)),
                        std::atan2(R(1, 0), R(0, 0)));
  }
  return data;
}

}  // namespace

class MapLiveNavigation : public testing::Test {
 protected:
  MapSummary map(const test::LiveData& data, const LiveOptions& options,
                 bool resume = false) const {
    MapJob job;
    job.output = path_;
    job.settings.mapper().surface.spacing = 0.05;  // a sparse map is soon made
    job.texture_every_frame = true;
    job.resume = resume;
    LiveSource source(drive_toml(data.drive), options);
    const std::jthread sensors([&] {
      for (const auto& [stamp, call] : data.calls()) call(source);
      source.close();
    });
    return map_live(source, job, {});
  }
  MapSummary resume(const test::LiveData& data) const {
    LiveOptions options = test::patient_options();
    continue_map(path_, options);
    return map(data, options, /*resume=*/true);
  }

  /// The frames lie in east-north-up at the stated origin.
  void expect_true_places(double tolerance) const {
    const MapReader reader(path_);
    const std::optional<GeodeticPoint> origin = map_origin(reader.meta());
    ASSERT_TRUE(origin);
    EXPECT_EQ(reader.drives().front().origin->latitude, origin->latitude);
    EXPECT_EQ(reader.drives().front().datum, kWgs84);
    const LocalTangentPlane plane(kPlace);
    const RigidMotion T_enu_local = plane.T_local_enu(*origin);
    for (const FrameRecord& frame : reader.frames()) {
      const RigidMotion apart =
          T_enu_lidar(frame.index).inverse() * T_enu_local * frame.T_local_lidar;
      EXPECT_LT(apart.translation().norm(), tolerance) << frame.index;
    }
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "map.fovea";
};

TEST_F(MapLiveNavigation, AFirstFixPlacesTheMap) {
  EXPECT_EQ(map(town_data(0, kFrames, kBegin), test::patient_options()).frames_mapped, kFrames);
  expect_true_places(0.15);
  const MapReader reader(path_);
  for (const FrameRecord& frame : reader.frames()) {
    EXPECT_EQ(frame.T_local_lidar_navigation.has_value(), frame.index >= kBegin) << frame.index;
  }
}

// Poses in a world without coordinates, whose origin a later run has to take.
TEST_F(MapLiveNavigation, LaterPosesPlaceTheMapInTheirWorld) {
  const auto by_poses = [](int begin, int end) {
    test::LiveData data = town_data(begin, end, kFrames);
    for (int i = std::max(begin, kBegin); i < end; ++i) {
      data.poses.push_back({data.scans[std::size_t(i - begin)].stamp, T_enu_lidar(i)});
    }
    return data;
  };
  map(by_poses(0, 20), test::patient_options());
  resume(by_poses(20, kFrames));
  const MapReader reader(path_);
  EXPECT_FALSE(map_origin(reader.meta()));
  const RigidMotion T_world_local(
      Eigen::Translation3d(live_state(reader).value().world_origin.value()));
  for (const FrameRecord& frame : reader.frames()) {
    const RigidMotion apart =
        T_enu_lidar(frame.index).inverse() * T_world_local * frame.T_local_lidar;
    EXPECT_LT(apart.translation().norm(), 0.15) << frame.index;
  }
}

TEST_F(MapLiveNavigation, WithoutAFixTheMapHasNoPlace) {
  map(town_data(0, 14, kFrames), test::patient_options());
  EXPECT_FALSE(map_origin(MapReader(path_).meta()));
}

TEST_F(MapLiveNavigation, ALaterRunKeepsThePlace) {
  map(town_data(0, 20, kBegin), test::patient_options());
  resume(town_data(20, kFrames, kFrames));  // without a fix
  expect_true_places(0.15);
}

TEST_F(MapLiveNavigation, NavigationMayBeginWithALaterRun) {
  map(town_data(0, kBegin, kFrames), test::patient_options());
  resume(town_data(kBegin, kFrames, kBegin));
  expect_true_places(0.15);
}

}  // namespace fovea::map_live_navigation_test
