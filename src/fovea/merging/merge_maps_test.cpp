// Maps of two drives through one scene whose every surface and colour is known.
#include "fovea/merging/merge_maps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../../tests/synthetic_drive.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/core/parallel.h"
#include "fovea/errors.h"
#include "fovea/map/camera_models.h"
#include "fovea/map/map_meta.h"
#include "fovea/pipeline/map_drive.h"

namespace fovea::merge_maps_test {

constexpr GeodeticPoint kOrigin{49.0, 8.4, 110};
constexpr double kMetresPerDegree = 111'200;  // of latitude there; errors count as GPS errors

/// Straight along the street from x = `start`, in a local frame of its own that lies there, whose
/// place is known with an error.
class Pass : public SyntheticDrive {
 public:
  double brightness = 1;

  Pass(const char* name, double start, double lateral, const Eigen::Vector3d& gps_error,
       double heading_error, int frames = 6)
      : SyntheticDrive(town_scene(), frames, 1.0) {
    T_town_start = RigidMotion(Eigen::Translation3d(start, lateral, 0));
    T_town_start.rotate(Eigen::AngleAxisd(heading_error, Eigen::Vector3d::UnitZ()));
    std::vector<StampedPose> navigation;
    for (int i = 0; i < frames; ++i) {
      RigidMotion& T = T_local_lidar[std::size_t(i)];  // of the scene, in this class
      T = RigidMotion(Eigen::Translation3d(start + i, lateral, 0));
      navigation.push_back({stamp_of(i), T_town_start.inverse() * T});
    }
    editable_info().navigation = Trajectory(navigation);
    editable_info().path = name;
    editable_info().origin = GeodeticPoint{
        kOrigin.latitude + (lateral + gps_error.y()) / kMetresPerDegree,
        kOrigin.longitude + (start + gps_error.x()) / (kMetresPerDegree * std::cos(0.8552)),
        kOrigin.altitude + gps_error.z()};
  }

  LoadedFrame load(int index) const override {
    LoadedFrame result = SyntheticDrive::load(index);
    for (Image& image : std::get<Frame>(result).images) {
      for (int v = 0; v < image.height; ++v) {
        for (int k = 0; k < 3 * image.width; ++k) {
          std::uint8_t& value = image.pixel(0, v)[k];
          value = static_cast<std::uint8_t>(std::lround(value * brightness));
        }
      }
    }
    return result;
  }

  /// True pose of its local frame; the first map's local frame is the town's, moved by its start.
  RigidMotion T_town_start;
};

class Merge : public testing::Test {
 protected:
  std::filesystem::path map(const Pass& drive, const std::string& name) {
    MapJob job;
    job.output = folder_ / name;
    job.pose_source = PoseSource::kNavigation;
    job.settings.mapper().surface.spacing = kSpacing;
    job.settings.run.range_image_spacing = 0;
    job.settings.mapper().fusion.submap_duration = 0.25;
    map_drive(drive, job, {});
    return job.output;
  }
  MergeJob job(const std::string& name, bool force = false) const {
    return {folder_ / name, force, kSpacing};
  }
  MergeFigures merge(const std::string& a, const std::string& b, const MergeJob& job) const {
    return merge_maps(MapReader(folder_ / a), MapReader(folder_ / b), job);
  }
  MergeFigures merge(const std::string& a, const std::string& b, const std::string& output) const {
    return merge(a, b, job(output));
  }
  std::string digest(const std::string& name) const { return MapReader(folder_ / name).digest(); }

  static constexpr double kSpacing = 0.06;
  const Pass first_{"first", 0, 0, {0, 0, 0}, 0};
  const Pass second_{"second", 3, 0.4, {0.7, -0.5, 0.3}, 0.01};
  TemporaryFolder folder_;
};

TEST_F(Merge, TheSecondDriveLiesWhereItWas) {
  map(first_, "a.fovea");
  map(second_, "b.fovea");
  const MergeFigures figures = merge("a.fovea", "b.fovea", "c.fovea");
  EXPECT_EQ(figures.drives_added, 1u);
  EXPECT_TRUE(figures.georeferenced);
  EXPECT_GT(figures.alignment.registered, 0u);
  EXPECT_NEAR(figures.alignment.moved, 0.9, 0.2);  // the error of GPS

  const MapReader merged(folder_ / "c.fovea");
  const std::vector<MergedDrive> drives = merged_drives(merged);
  ASSERT_EQ(drives.size(), 2u);
  EXPECT_EQ(drives[1].name, "second");
  EXPECT_EQ(drives[1].first_frame, 6);
  EXPECT_EQ(drives[1].end_frame, 12);
  EXPECT_EQ(drives[1].frame_shift, 6);
  for (const std::size_t drive : {0, 1}) EXPECT_EQ(camera_models(merged.meta(), drive).size(), 1u);
  const std::vector<FrameRecord> frames = merged.frames();
  ASSERT_EQ(frames.size(), 12u);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(frames[std::size_t(i)].T_local_lidar.matrix(),
              MapReader(folder_ / "a.fovea").frames()[std::size_t(i)].T_local_lidar.matrix());
    const RigidMotion error = first_.T_town_start.inverse() * second_.T_local_lidar[std::size_t(i)];
    const RigidMotion& found = frames[std::size_t(i) + 6].T_local_lidar;
    EXPECT_LT((found.translation() - error.translation()).norm(), 0.02) << i;
    EXPECT_LT(rotation_angle(found.linear().transpose() * error.linear()), 0.002) << i;
    EXPECT_GE(frames[std::size_t(i) + 6].submap, drives[1].first_submap);
    EXPECT_LT(frames[std::size_t(i) + 6].submap, drives[1].end_submap);
  }
}

TEST_F(Merge, MapsMayMeetInAPartOnly) {
  const Pass ahead("ahead", 7, -0.5, {-0.6, 0.4, 0.2}, -0.008, 8);
  map(first_, "a.fovea");
  map(ahead, "b.fovea");
  EXPECT_GT(merge("a.fovea", "b.fovea", "c.fovea").alignment.registered, 0u);
  const std::vector<FrameRecord> frames = MapReader(folder_ / "c.fovea").frames();
  ASSERT_EQ(frames.size(), 14u);
  for (std::size_t i = 0; i < 8; ++i) {
    const RigidMotion& found = frames[i + 6].T_local_lidar;
    EXPECT_LT((found.translation() - ahead.T_local_lidar[i].translation()).norm(), 0.04) << i;
  }
}

TEST_F(Merge, EachSurfaceIsThereOnceInTheColoursOfBoth) {
  map(first_, "a.fovea");
  map(second_, "b.fovea");
  const MergeFigures figures = merge("a.fovea", "b.fovea", "c.fovea");
  const MapReader a(folder_ / "a.fovea"), b(folder_ / "b.fovea"), c(folder_ / "c.fovea");
  EXPECT_EQ(figures.points, a.size() + figures.merged.added);
  EXPECT_EQ(figures.merged.added + figures.merged.known, b.size());
  EXPECT_GT(figures.merged.known, b.size() / 4);
  EXPECT_GT(figures.merged.added, b.size() / 10);
  EXPECT_GT(figures.merged.fused, figures.merged.known / 4);
  EXPECT_EQ(c.size(), figures.points);

  const PointCloud before = a.all_points_local(), after = c.all_points_local();
  std::size_t of_second = 0;
  double error = 0;
  std::size_t coloured = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    of_second += after.frame[i] >= 6;
    if (after.camera[i] == kNoCamera) continue;
    const Eigen::Vector3d p_town = first_.T_town_start * after.position[i].cast<double>();
    error += double((to_float(after.color[i]) - synthetic_color(p_town)).norm());
    ++coloured;
  }
  EXPECT_EQ(of_second, figures.merged.added);
  EXPECT_LT(error / double(coloured), 6);
  // A's points stand where they stood, in its own order, and more views have coloured them.
  std::size_t more_views = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_EQ(after.position[i], before.position[i]);
    ASSERT_EQ(after.frame[i], before.frame[i]);
    more_views += after.views[i] > before.views[i];
  }
  EXPECT_EQ(more_views, figures.merged.fused);
}

TEST_F(Merge, WhatIsThereAlreadyChangesNothing) {
  map(first_, "a.fovea");
  map(second_, "b.fovea");
  EXPECT_EQ(merge("a.fovea", "a.fovea", "aa.fovea").drives_added, 0u);
  EXPECT_EQ(digest("aa.fovea"), digest("a.fovea"));
  merge("a.fovea", "b.fovea", "c.fovea");
  for (const char* again : {"a.fovea", "b.fovea", "c.fovea"}) {
    EXPECT_EQ(merge("c.fovea", again, job("d.fovea", /*force=*/true)).drives_added, 0u);
    EXPECT_EQ(digest("d.fovea"), digest("c.fovea"));
  }
}

TEST_F(Merge, OfAMergedMapComesWhatIsNew) {
  const Pass third("third", -3, -0.5, {-0.4, 0.3, 0.1}, -0.01);
  map(first_, "a.fovea");
  map(second_, "b.fovea");
  map(third, "c.fovea");
  merge("a.fovea", "b.fovea", "ab.fovea");
  merge("a.fovea", "c.fovea", "ac.fovea");
  EXPECT_EQ(merge("ac.fovea", "ab.fovea", "acb.fovea").drives_added, 1u);
  const MapReader merged(folder_ / "acb.fovea");
  const std::vector<MergedDrive> drives = merged_drives(merged);
  ASSERT_EQ(drives.size(), 3u);
  EXPECT_EQ(drives[2].name, "second");
  EXPECT_EQ(drives[2].frame_shift, 12);
  const std::vector<FrameRecord> frames = merged.frames();
  ASSERT_EQ(frames.size(), 18u);
  EXPECT_LT(
      (frames[12].T_local_lidar.translation() - second_.T_local_lidar[0].translation()).norm(),
      0.03);
}

TEST_F(Merge, TheSecondDriveIsMadeAsBrightAsTheFirst) {
  Pass dark("dark", 3, 0.4, {0, 0, 0}, 0);
  dark.brightness = 0.6;
  map(first_, "a.fovea");
  map(dark, "b.fovea");
  const MergeFigures figures = merge("a.fovea", "b.fovea", "c.fovea");
  for (const float gain : figures.gain_of_b) EXPECT_NEAR(std::exp2(gain), 0.6, 0.02);
  const PointCloud points = MapReader(folder_ / "c.fovea").all_points_local();
  double error = 0;
  std::size_t coloured = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.camera[i] == kNoCamera || points.frame[i] < 6) continue;
    error += double(
        (to_float(points.color[i]) - synthetic_color(points.position[i].cast<double>())).norm());
    ++coloured;
  }
  ASSERT_GT(coloured, 100u);
  EXPECT_LT(error / double(coloured), 8);
}

TEST_F(Merge, IsTheSameAtAnyNumberOfThreadsAndInLittleMemory) {
  map(first_, "a.fovea");
  map(second_, "b.fovea");
  std::vector<std::string> digests;
  for (const auto& [threads, memory] :
       {std::pair(1, std::size_t{1} << 30), {2, std::size_t{1} << 30}, {2, std::size_t{1}}}) {
    const ThreadLimit limit(threads);
    MergeJob job = this->job("c.fovea", /*force=*/true);
    job.memory = memory;
    merge("a.fovea", "b.fovea", job);
    digests.push_back(digest("c.fovea"));
    EXPECT_EQ(digests.back(), digests.front()) << threads;
  }
}

TEST_F(Merge, MapsThatDoNotMeetAreRefusedUnlessForced) {
  const Pass elsewhere("elsewhere", 3, 0.4, {2000, 0, 0}, 0);
  const Pass misplaced("misplaced", 3, 0.4, {9, 0, 0}, 0);
  Pass nowhere("nowhere", 3, 0.4, {0, 0, 0}, 0);
  nowhere.editable_info().origin.reset();
  map(first_, "a.fovea");
  map(elsewhere, "elsewhere.fovea");
  map(misplaced, "misplaced.fovea");
  map(nowhere, "nowhere.fovea");
  for (const auto& [other, problem] :
       {std::pair("elsewhere.fovea", "the maps do not overlap"),
        {"misplaced.fovea", "the maps overlap, but nowhere do their surfaces fit"},
        {"nowhere.fovea",
         "a map without georeference: nothing says how the two lie to each other"}}) {
    try {
      merge("a.fovea", other, "c.fovea");
      FAIL() << other;
    } catch (const InputError& error) {
      EXPECT_EQ(error.problem(), problem);
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "c.fovea"));
    const MergeFigures forced = merge("a.fovea", other, job("c.fovea", true));
    EXPECT_EQ(forced.drives_added, 1u);
    std::filesystem::remove(folder_ / "c.fovea");
  }
  // Without georeference: identity, from which registration finds the 3 m.
  EXPECT_EQ(merge("a.fovea", "elsewhere.fovea", job("c.fovea", true)).alignment.registered, 0u);
  const MapReader apart(folder_ / "c.fovea");
  EXPECT_EQ(apart.size(),
            MapReader(folder_ / "a.fovea").size() + MapReader(folder_ / "elsewhere.fovea").size());
  const MergeFigures identity = merge("a.fovea", "nowhere.fovea", job("c.fovea", true));
  EXPECT_FALSE(identity.georeferenced);
  EXPECT_GT(identity.alignment.registered, 0u);
}

TEST_F(Merge, AMapThatDoesNotHaveItsDrivesIsRefused) {
  map(first_, "a.fovea");
  map(second_, "b.fovea");
  DriveRecord endless;
  endless.source_digest = "digest";
  endless.end_frame = 1 << 30;
  const auto put = [&](std::size_t id, const DriveRecord& drive) {
    const auto writer = MapWriter::open(folder_ / "b.fovea");
    writer->put_drive(id, drive);
    writer->commit();
  };
  put(0, endless);
  EXPECT_THROW(merge("a.fovea", "b.fovea", "c.fovea"), InputError);
  put(0, DriveRecord());
  put(1, endless);  // one drive with a digest, one without
  EXPECT_THROW(merge("a.fovea", "b.fovea", "c.fovea"), InputError);
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"a.fovea", "b.fovea"}));
}

// The tables of the merged map keep apart what belongs to the two drives.
TEST_F(Merge, DrivesSensorsViewsAndKeyframesAreThoseOfBoth) {
  map(first_, "a.fovea");
  map(second_, "b.fovea");
  {
    const auto writer = MapWriter::open(folder_ / "b.fovea");
    writer->put_keyframe({2, 0, {0.1}, 2, 0, 0.5, {700, 0}});
    writer->commit();
  }
  merge("a.fovea", "b.fovea", "c.fovea");
  const MapReader merged(folder_ / "c.fovea"), a(folder_ / "a.fovea"), b(folder_ / "b.fovea");
  const std::vector<DriveRecord> drives = merged.drives();
  ASSERT_EQ(drives.size(), 2u);
  EXPECT_EQ(drives[0].calibration_fingerprint, a.drives()[0].calibration_fingerprint);
  EXPECT_EQ(drives[1].stamps_fingerprint, b.drives()[0].stamps_fingerprint);
  EXPECT_EQ(drives[1].source_digest, b.digest());
  EXPECT_EQ(drives[1].first_frame, 6);
  ASSERT_EQ(merged.sensors().size(), 2u);
  EXPECT_EQ(merged.sensors()[0].drive, 0);
  EXPECT_EQ(merged.sensors()[1].drive, 1);
  const ViewRecord merged_view = merged.frames()[8].views.at(0), view = b.frames()[2].views.at(0);
  EXPECT_EQ(merged_view.camera, view.camera);
  EXPECT_EQ(merged_view.stamp, view.stamp);
  EXPECT_LT((*merged_view.log2_gain - *view.log2_gain).cwiseAbs().maxCoeff(), 0.01);
  int keyframes = 0;
  merged.for_each_keyframe([&](const KeyframeRecord& keyframe) {
    EXPECT_EQ(keyframe.frame, 8);
    EXPECT_EQ(keyframe.sensor, 1);
    ++keyframes;
  });
  EXPECT_EQ(keyframes, 1);
  std::size_t seconds = 0;
  const std::vector<SubmapRecord> submaps = merged.submap_records();
  merged.for_each_stored_tile([&](const TileId& id, const TilePoints& tile) {
    const int drive = submaps[id.submap].drive;
    for (std::size_t i = 0; i < tile.size(); ++i) {
      EXPECT_EQ(tile.frame[i] >= 6, drive == 1);
      EXPECT_EQ(tile.session.empty() ? 0 : int(tile.session[i]), drive);
      EXPECT_EQ(tile.sensor.empty() ? 0 : int(tile.sensor[i]), drive);
      seconds += drive == 1;
    }
  });
  EXPECT_GT(seconds, 100u);
  EXPECT_EQ(merged.check(), merged.tile_sizes().size());
}

TEST_F(Merge, MapsOfOtherTilesAreRefused) {
  map(first_, "a.fovea");
  MapJob job;
  job.output = folder_ / "b.fovea";
  job.settings.mapper().tile_size = 8;
  map_drive(second_, job, {});
  EXPECT_THROW(merge("a.fovea", "b.fovea", "c.fovea"), InputError);
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"a.fovea", "b.fovea"}));
}

}  // namespace fovea::merge_maps_test
