#include "fovea/pipeline/map_live.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <thread>

#include "../../../tests/temporary_folder.h"
#include "fovea/drive/live/test_live_drive.h"
#include "fovea/errors.h"
#include "fovea/map/camera_models.h"
#include "fovea/map/map_store.h"
#include "fovea/pipeline/earlier_run.h"
#include "fovea/pipeline/live_state.h"
#include "fovea/pipeline/mapper_test_support.h"

namespace fovea::map_live_test {
namespace {

constexpr int kFrames = 24;

const SyntheticDrive& town() {
  static const SyntheticDrive drive(town_scene(), kFrames, 0.8);
  return drive;
}

/// What the sensors of the town's vehicle send during some frames. Its poses are true.
test::LiveData town_data(int begin, int end) {
  test::LiveData data;
  data.drive.lidar.sweep_compensated = true;
  const Camera& camera = town().info().calibration.cameras.front();
  data.drive.cameras = {
      {"front",
       2,
       {camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, Lens()},
       camera.T_cam_lidar.inverse()}};
  for (int i = begin; i < end; ++i) {
    const Frame frame = std::get<Frame>(town().load(i));
    const TimeNs stamp = test::kLiveStart + frame.stamp;
    data.scans.push_back({"", stamp, frame.scan});
    const std::vector<std::uint8_t> png = encode_png(frame.images.front());
    data.images.push_back({"front", stamp, std::string(png.begin(), png.end())});
    data.poses.push_back({stamp, town().T_local_lidar[std::size_t(i)]});
  }
  return data;
}

}  // namespace

class MapLive : public testing::Test {
 protected:
  MapJob job(const std::string& name) const {
    MapJob job;
    job.output = folder_ / name;
    job.settings.mapper().surface.spacing = 0.05;  // a sparse map is soon made
    job.texture_every_frame = true;
    return job;
  }

  std::string drive_toml() const { return town_data(0, 1).write(folder_ / "sensors"); }

  /// Maps data as they come.
  MapSummary map(const test::LiveData& data, const MapJob& job, const LiveOptions& options) const {
    LiveSource source(drive_toml(), options);
    const std::jthread sensors([&] {
      for (const auto& [stamp, call] : data.calls()) call(source);
      source.close();
    });
    return map_live(source, job, {});
  }

  /// Maps the town. Frames may add nothing to the map.
  /// @param before  called with the number of a scan before its data are sent
  /// @param after   called with the number of mapped frames after each
  MapSummary map_in_time(const LiveOptions& options, const std::function<void(int)>& before,
                         const std::function<void(int)>& after) const {
    LiveSource source(drive_toml(), options);
    const std::jthread sensors([&] {
      for (const auto& [stamp, call] : town_data(0, kFrames).calls()) {
        before(int((stamp - test::kLiveStart) / SyntheticDrive::stamp_of(1)));
        call(source);
      }
      source.close();
    });
    MapJob job = this->job("map.fovea");
    job.texture_every_frame = false;
    return map_live(source, job, [&](const RunProgress& progress) { after(progress.done); });
  }

  TemporaryFolder folder_;
};

namespace {

struct PointsOfMap {
  std::vector<std::pair<TileId, std::size_t>> tiles;
  std::vector<Eigen::Vector3f> position;
  std::vector<std::array<std::uint8_t, 3>> color;
};

PointsOfMap points_in(const MapReader& map) {
  PointsOfMap points;
  points.tiles = map.tile_sizes();
  map.for_each_tile([&](std::size_t, const TileKey&, const PointCloud& tile) {
    points.position.insert(points.position.end(), tile.position.begin(), tile.position.end());
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const Rgb color = to_rgb(tile.color[i]);
      points.color.push_back({color.r, color.g, color.b});
    }
  });
  return points;
}

}  // namespace

TEST_F(MapLive, TheMapIsThatOfTheDrive) {
  const test::LiveData data = town_data(0, kFrames);
  data.write(folder_ / "drive");
  const MapSummary of_file = map_drive(*open_drive(folder_ / "drive", {}), job("file.fovea"), {});
  const MapSummary of_live = map(data, job("live.fovea"), test::patient_options());
  EXPECT_EQ(of_live.frames_mapped, kFrames);
  EXPECT_EQ(of_live.textures_skipped, 0);
  EXPECT_TRUE(is_complete(MapReader(folder_ / "live.fovea").meta()));
  EXPECT_EQ(of_live.points, of_file.points);

  const MapReader file(folder_ / "file.fovea"), live(folder_ / "live.fovea");
  const std::vector<FrameRecord> frames = live.frames();
  for (const FrameRecord& frame : file.frames()) {
    const FrameRecord& same = frames.at(std::size_t(frame.index));
    EXPECT_EQ(same.stamp, frame.stamp);
    EXPECT_EQ(same.T_local_lidar.matrix(), frame.T_local_lidar.matrix()) << frame.index;
    EXPECT_EQ(same.figures, frame.figures) << frame.index;
  }
  const std::vector<Camera> cameras = camera_models(live.meta(), 0),
                            of_drive = camera_models(file.meta(), 0);
  ASSERT_EQ(cameras.size(), 1u);
  ASSERT_EQ(of_drive.size(), 1u);
  EXPECT_EQ(cameras[0].fx, of_drive[0].fx);
  EXPECT_EQ(cameras[0].T_cam_lidar.matrix(), of_drive[0].T_cam_lidar.matrix());
  const PointsOfMap a = points_in(file), b = points_in(live);
  EXPECT_EQ(a.tiles, b.tiles);
  EXPECT_EQ(a.position, b.position);
  EXPECT_TRUE(a.color == b.color);
  const DriveRecord drive = live.drives().front(), same = file.drives().front();
  EXPECT_EQ(drive.stamps_fingerprint, same.stamps_fingerprint);
  EXPECT_EQ(drive.calibration_fingerprint, same.calibration_fingerprint);
  EXPECT_EQ(drive.end_frame, kFrames);
}

TEST_F(MapLive, ALaterRunContinuesTheMap) {
  constexpr int kBefore = 14;
  map(town_data(0, kBefore), job("map.fovea"), test::patient_options());
  MapJob further = job("map.fovea");
  further.resume = true;
  LiveOptions options = test::patient_options();
  continue_map(further.output, options);
  EXPECT_EQ(options.first_frame, kBefore);
  const MapSummary summary = map(town_data(kBefore, kFrames), further, options);
  EXPECT_EQ(summary.frames_mapped, kFrames);
  EXPECT_EQ(summary.frames_new, std::size_t(kFrames - kBefore));

  map(town_data(0, kFrames), job("whole.fovea"), test::patient_options());
  const MapReader resumed(further.output), whole(folder_ / "whole.fovea");
  const DriveRecord drive = resumed.drives().front(), same = whole.drives().front();
  EXPECT_EQ(drive.first_frame, 0);
  EXPECT_EQ(drive.end_frame, kFrames);
  EXPECT_EQ(drive.stamps_fingerprint, same.stamps_fingerprint);
  EXPECT_EQ(drive.calibration_fingerprint, same.calibration_fingerprint);
  const std::vector<FrameRecord> frames = resumed.frames();
  ASSERT_EQ(frames.size(), std::size_t(kFrames));
  for (const FrameRecord& frame : whole.frames()) {
    const RigidMotion apart =
        frames[std::size_t(frame.index)].T_local_lidar.inverse() * frame.T_local_lidar;
    EXPECT_LT(apart.translation().norm(), 0.02) << frame.index;
  }
}

TEST_F(MapLive, AMapOfFilesIsNotContinuedLive) {
  const test::LiveData data = town_data(0, 6);
  data.write(folder_ / "drive");
  map_drive(*open_drive(folder_ / "drive", {}), job("file.fovea"), {});
  LiveOptions options;
  EXPECT_THROW(continue_map(folder_ / "file.fovea", options), InputError);
}

TEST_F(MapLive, OtherSettingsDoNotContinueAMap) {
  map(town_data(0, 12), job("map.fovea"), test::patient_options());
  LiveOptions options = test::patient_options();
  continue_map(folder_ / "map.fovea", options);
  MapJob further = job("map.fovea");
  further.resume = true;
  further.settings.mapper().surface.spacing = 0.1;
  EXPECT_THROW(map(town_data(12, kFrames), further, options), InputError);
}

TEST_F(MapLive, AClockBehindTheMapDoesNotContinueIt) {
  map(town_data(4, 14), job("map.fovea"), test::patient_options());
  const std::string before = MapReader(folder_ / "map.fovea").digest();
  MapJob further = job("map.fovea");
  further.resume = true;
  LiveOptions options = test::patient_options();
  continue_map(further.output, options);
  EXPECT_THROW(map(town_data(0, 12), further, options), InputError);
  EXPECT_EQ(MapReader(further.output).digest(), before);
}

TEST_F(MapLive, ADamagedStateIsAnError) {
  map(town_data(0, 12), job("map.fovea"), test::patient_options());
  const CheckpointRecord whole = MapReader(folder_ / "map.fovea").checkpoint(kLiveState).value();
  LiveState state;
  state.image_delays[2] = std::numeric_limits<double>::quiet_NaN();
  const CheckpointRecord no_number = checkpoint_of(state, 11);
  state.image_delays.clear();
  state.targets.push_back({3, {Eigen::Vector3f::Constant(std::nanf(""))}});
  const CheckpointRecord no_point = checkpoint_of(state, 11);
  std::vector<std::vector<std::byte>> damaged = {{}, no_number.state, no_point.state};
  for (const std::size_t size : {1u, 8u, 9u, 40u}) {
    damaged.emplace_back(whole.state.begin(), whole.state.begin() + size);
  }
  damaged.emplace_back(whole.state.begin(), whole.state.end() - 1);
  damaged.emplace_back(16, std::byte{0xff});
  for (const std::vector<std::byte>& bytes : damaged) {
    {
      const auto writer = MapWriter::open(folder_ / "map.fovea");
      writer->put_checkpoint(kLiveState, {11, bytes});
      writer->finish();
    }
    LiveOptions options;
    EXPECT_THROW(continue_map(folder_ / "map.fovea", options), InputError) << bytes.size();
  }
}

TEST_F(MapLive, OtherSensorsDoNotContinueAMap) {
  map(town_data(0, 12), job("map.fovea"), test::patient_options());
  LiveOptions options = test::patient_options();
  continue_map(folder_ / "map.fovea", options);
  MapJob further = job("map.fovea");
  further.resume = true;
  options.image_delays[2] = 0.02;
  EXPECT_THROW(map(town_data(12, kFrames), further, options), InputError);
}

TEST_F(MapLive, EachFrameIsTrackedBeforeItIsMapped) {
  MapJob job = this->job("map.fovea");
  std::vector<int> tracked;
  job.on_tracked = [&](const FrameResult& frame) { tracked.push_back(frame.index); };
  map(town_data(0, 12), job, test::patient_options());
  std::vector<int> all(12);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(tracked, all);
}

TEST_F(MapLive, FramesAddNothingWhileTheMapIsBehind) {
  LiveOptions options = test::patient_options();
  options.max_scans = 2;
  const int ahead = 4 + 2;  // scans that are read or tracked, and those of the queue
  std::atomic<int> sent = 0;
  const MapSummary summary = map_in_time(
      options, [&](int scan) { sent = scan; },
      [&](int mapped) {
        while (sent < std::min(mapped + ahead, kFrames - 1)) std::this_thread::yield();
      });
  EXPECT_GT(summary.textures_skipped, 0);
  EXPECT_LT(summary.textures_skipped, kFrames);
  EXPECT_EQ(summary.frames_mapped, kFrames);
}

TEST_F(MapLive, EachFrameAddsToAMapThatKeepsUp) {
  const LiveOptions options = test::patient_options();
  const int first = int(options.first_scans);
  std::atomic<int> done = 0;
  const auto wait_for_map = [&](int scan) {
    while (scan > std::max(first, done + 1)) std::this_thread::yield();
  };
  const MapSummary summary = map_in_time(options, wait_for_map, [&](int mapped) { done = mapped; });
  EXPECT_EQ(summary.textures_skipped, 0);
  EXPECT_EQ(summary.frames_mapped, kFrames);
}

TEST_F(MapLive, WithoutAScanThereIsNoMap) {
  EXPECT_THROW(map({}, job("map.fovea"), test::patient_options()), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "map.fovea"));
}

TEST_F(MapLive, AStopEndsTheRunWithACompleteMap) {
  std::stop_source stop;
  MapJob job = this->job("map.fovea");
  job.stop = stop.get_token();
  LiveSource source(drive_toml(), test::patient_options());
  const std::jthread sensors([&] {
    for (const auto& [stamp, call] : town_data(0, kFrames).calls()) call(source);
    source.close();
  });
  int done = 0;
  const MapSummary summary = map_live(source, job, [&](const RunProgress& progress) {
    done = progress.done;
    if (progress.done == 6) stop.request_stop();
  });
  EXPECT_EQ(summary.frames_mapped, done);
  EXPECT_TRUE(is_complete(MapReader(job.output).meta()));
  EXPECT_EQ(MapReader(job.output).frames().size(), std::size_t(done));
}

}  // namespace fovea::map_live_test
