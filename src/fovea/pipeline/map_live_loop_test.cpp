// A live map that is cut before its loop closes, and continued.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <thread>

#include "../../../tests/synthetic_drive.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/core/random.h"
#include "fovea/drive/live/test_live_drive.h"
#include "fovea/map/map_store.h"
#include "fovea/pipeline/live_state.h"
#include "fovea/pipeline/map_live.h"

namespace fovea::map_live_loop_test {
namespace {

constexpr int kLap = 86;                 // frames
constexpr double kRadius = 11;           // m: 0.8 m a frame
constexpr int kCut = 60, kFrames = 104;  // the loop closes after frame 80

/// Pillars on both sides of a circle.
BoxScene roundabout() {
  BoxScene scene{{{{-40, -30, -3}, {40, 52, -1.73}}}};
  constexpr int kPillars = 22;
  for (int i = 0; i < kPillars; ++i) {
    Random random = Random::of_item(3, 1, std::uint64_t(i));
    const double angle = 2 * std::numbers::pi * (i + 0.7 * random.uniform()) / kPillars;
    const double radius = kRadius + (i % 2 == 0 ? 5 : -5) * random.uniform(1, 1.6);
    const double x = radius * std::sin(angle), y = kRadius - radius * std::cos(angle);
    const double width = random.uniform(0.4, 1.2), depth = random.uniform(0.4, 1.2);
    scene.boxes.push_back({{x - width, y - depth, -1.73}, {x + width, y + depth, 3}});
  }
  return scene;
}

/// Round the circle, without camera and navigation.
const SyntheticDrive& lap() {
  static const SyntheticDrive drive = [] {
    SyntheticDrive made(roundabout(), kFrames, 0);
    made.beams = 32;
    made.columns = 500;
    made.editable_info().calibration.cameras.clear();
    for (int i = 0; i < kFrames; ++i) {
      const double angle = 2 * std::numbers::pi * i / kLap;
      RigidMotion T = RigidMotion::Identity();
      T.translation() =
          Eigen::Vector3d(kRadius * std::sin(angle), kRadius * (1 - std::cos(angle)), 0);
      T.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
      made.T_local_lidar[std::size_t(i)] = T;
    }
    return made;
  }();
  return drive;
}

test::LiveData lap_data(int begin, int end) {
  test::LiveData data;
  data.drive.lidar.sweep_compensated = true;
  for (int i = begin; i < end; ++i) {
    const Frame frame = std::get<Frame>(lap().load(i));
    data.scans.push_back({"", test::kLiveStart + frame.stamp, frame.scan});
  }
  return data;
}

class MapLiveLoop : public testing::Test {
 protected:
  MapSummary map(int begin, int end, bool resume) const {
    MapJob job;
    job.output = folder_ / "map.fovea";
    job.settings.mapper().surface.spacing = 0.2;
    job.texture_every_frame = true;
    job.resume = resume;
    LiveOptions options = test::patient_options();
    options.drive.use_images = false;
    if (resume) continue_map(job.output, options);
    LiveSource source(lap_data(0, 1).write(folder_ / "sensors"), options);
    const std::jthread sensors([&] {
      for (const auto& [stamp, call] : lap_data(begin, end).calls()) call(source);
      source.close();
    });
    return map_live(source, job, {});
  }

  TemporaryFolder folder_;
};

}  // namespace

TEST_F(MapLiveLoop, ALoopClosesToPlacesOfTheRunBefore) {
  EXPECT_EQ(map(0, kCut, /*resume=*/false).loops_closed, 0);
  const MapSummary summary = map(kCut, kFrames, /*resume=*/true);
  EXPECT_EQ(summary.frames_mapped, kFrames);
  EXPECT_GT(summary.loops_closed, 0);

  const std::vector<FrameRecord> frames = MapReader(folder_ / "map.fovea").frames();
  const int first_submap_of_second_run = frames.at(kCut).submap;
  for (const FrameRecord& frame : frames) {
    const RigidMotion& truth = lap().T_local_lidar[std::size_t(frame.index)];
    EXPECT_LT((frame.T_local_lidar.translation() - truth.translation()).norm(), 0.1) << frame.index;
    if (!frame.revisit) continue;
    EXPECT_GE(frame.index, kCut);
    EXPECT_LT(frame.revisit->submap, first_submap_of_second_run);
  }
}

}  // namespace fovea::map_live_loop_test
