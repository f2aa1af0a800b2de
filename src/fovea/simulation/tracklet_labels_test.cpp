#include "fovea/simulation/tracklet_labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/temporary_folder.h"
#include "fovea/drive/drive_truth.h"
#include "fovea/drive/kitti/tracklets.h"
#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/simulate.h"
#include "fovea/simulation/test_scenery.h"
#include "fovea/world/world_file.h"

namespace fovea::tracklet_labels_test {

using Eigen::Vector3d;
using ::testing::Contains;

std::vector<Tracklet> written_and_read(const std::vector<BoxTrack>& tracks) {
  const TemporaryFolder folder;
  std::ofstream(folder / "tracklet_labels.xml") << tracklets_text(tracks);
  return read_tracklets(folder / "tracklet_labels.xml");
}

RigidMotion pose(double x, double y, double z, double heading) {
  return Eigen::Translation3d(x, y, z) * RigidMotion(Eigen::AngleAxisd(heading, Vector3d::UnitZ()));
}

TEST(TrackletsText, IsReadBackAsItWas) {
  BoxTrack car{"Car", {4.25, 1.75, 1.5}, 7, {}};
  for (int k = 0; k < 3; ++k) {
    BoxLabel box;
    box.T_lidar_box = pose(10.123456789 + k, -2, -1.7, 0.5 - k);
    box.seen = k != 1;
    car.boxes.push_back(box);
  }
  const BoxTrack person{"Pedestrian", {0.6, 0.5, 1.8}, 0, {BoxLabel{}}};
  const auto read = written_and_read({car, person});
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].type, "Car");
  EXPECT_EQ(read[0].size, car.size);
  EXPECT_EQ(read[0].first_frame, 7);
  ASSERT_EQ(read[0].T_lidar_box.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_TRUE(read[0].T_lidar_box[k].isApprox(car.boxes[k].T_lidar_box, 1e-8));
  }
  EXPECT_EQ(read[1].type, "Pedestrian");
  EXPECT_TRUE(written_and_read({}).empty());
}

TEST(TrackletsText, HasKittisFields) {
  BoxLabel box;
  box.occlusion = BoxOcclusion::kPartly;
  box.truncation = BoxTruncation::kBehindImage;
  const std::string text = tracklets_text({{"Van", {5, 2, 2}, 3, {box}}});
  for (const char* part : {"<objectType>Van</objectType>", "<h>2</h>", "<w>2</w>", "<l>5</l>",
                           "<first_frame>3</first_frame>", "<occlusion>1</occlusion>",
                           "<truncation>99</truncation>", "<state>1</state>"}) {
    EXPECT_THAT(text, testing::HasSubstr(part));
  }
}

TEST(TruncationOf, TellsWhereABoxLiesInTheImage) {
  Camera camera;
  camera.width = camera.height = 101;
  camera.fx = camera.fy = 50;
  camera.cx = camera.cy = 50;
  const auto box_at = [](double x, double z) {
    std::array<Vector3d, 8> corners;
    for (std::size_t k = 0; k < 8; ++k) {
      corners[k] = Vector3d(x, 0, z) + Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    }
    return corners;
  };
  EXPECT_EQ(truncation_of(box_at(0, 10), camera), BoxTruncation::kInImage);
  EXPECT_EQ(truncation_of(box_at(9, 10), camera), BoxTruncation::kTruncated);  // at the border
  EXPECT_EQ(truncation_of(box_at(0.5, 0.5), camera),
            BoxTruncation::kTruncated);  // cut by its plane
  EXPECT_EQ(truncation_of(box_at(30, 10), camera), BoxTruncation::kOutOfImage);
  EXPECT_EQ(truncation_of(box_at(0, -10), camera), BoxTruncation::kBehindImage);
}

/// A wide plain with a crate that moves along x, beside the way or in front of a wall.
class LabelledCrate : public testing::Test {
 protected:
  LabelledCrate() {
    MeshBuilder ground;
    ground.surface = 1;
    ground.quad({-200, -200, 0}, {200, -200, 0}, {200, 200, 0}, {-200, 200, 0});
    scenery_.add({0, 0}, ground.take());
    MeshBuilder crate;
    crate.box({-1, -0.5, 0}, {2, 0.5, 1.5});  // its middle is not its origin
    scenery_.add(Model{"crate", crate.take(), 3, "Car"});
    options_ = simulation_options(Scene::kStreet, "none");
    options_.lidar.columns = 720;
    options_.vehicle.speed = 0;
    rig_ = make_rig(options_);
  }

  /// Tracks of so many frames of a crate whose place depends on time.
  std::vector<BoxTrack> tracks(int frames, const std::function<Vector3d(double)>& place) {
    scenery_.moving = [place](double time, double) {
      Placement crate;
      crate.T_world_model.translation() = place(time);
      crate.surface = Scenery::kMoving | 5;
      return std::vector<Placement>{crate};
    };
    const VehicleMotion motion(scenery_.path(), 0, options_.vehicle, 1);
    RayCaster caster(scenery_);
    caster.move_to({0, 0}, 500);
    TrackletLabels labels(scenery_, motion, rig_);
    for (int frame = 0; frame < frames; ++frame) {
      const double stamp = frame * options_.lidar.period;
      const SimulatedScan scan =
          simulate_scan(caster, motion, rig_.T_vehicle_lidar, options_.lidar, 1, frame, stamp);
      labels.add(frame, stamp, scan, caster);
    }
    return labels.tracks();
  }

  TestScenery scenery_;
  SimulationOptions options_;
  Rig rig_;
};

TEST_F(LabelledCrate, BoxIsWhereTheSweepPassedIt) {
  // To the left: the beam meets it a quarter of a sweep before the stamp, 26 ms * 20 m/s earlier.
  const auto found = tracks(2, [](double time) { return Vector3d(-0.5 + 20 * time, 10, 0); });
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].type, "Car");
  EXPECT_EQ(found[0].size, Vector3d(3, 1, 1.5));
  ASSERT_EQ(found[0].boxes.size(), 2u);
  const RigidMotion T_world_lidar =
      VehicleMotion(scenery_.path(), 0, options_.vehicle, 1).T_world_vehicle(0) *
      rig_.T_vehicle_lidar;
  const Vector3d bottom = T_world_lidar * found[0].boxes[0].T_lidar_box.translation();
  EXPECT_NEAR(bottom.x(), -20 * options_.lidar.period / 4, 0.05);
  EXPECT_NEAR(bottom.y(), 10, 1e-9);
  EXPECT_NEAR(bottom.z(), 0, 1e-9);
  EXPECT_TRUE(found[0].boxes[0].seen);
}

TEST_F(LabelledCrate, LabelsLastFromTheFirstReturnToTheLast) {
  // Beyond the LiDAR's reach but in frames 3 and 5 (and, as far, out of its track, in 8).
  const double period = options_.lidar.period;
  const auto found = tracks(10, [period](double time) {
    const int frame = static_cast<int>(std::lround(time / period));
    const bool near = frame == 3 || frame == 5;
    return Vector3d(frame == 8 ? 60 : (near ? 112 : 125), 0, 0);
  });
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].first_frame, 3);
  ASSERT_EQ(found[0].boxes.size(), 3u);
  EXPECT_TRUE(found[0].boxes[0].seen);
  EXPECT_FALSE(found[0].boxes[1].seen);
  EXPECT_TRUE(found[0].boxes[2].seen);
  EXPECT_EQ(found[1].first_frame, 8);  // it jumped: another crate
  EXPECT_EQ(found[1].boxes.size(), 1u);
}

TEST_F(LabelledCrate, OcclusionIsWhatTheFirstCameraSees) {
  const auto ahead = [](double) { return Vector3d(14, 0, 0); };
  EXPECT_EQ(tracks(1, ahead)[0].boxes[0].occlusion, BoxOcclusion::kVisible);
  EXPECT_EQ(tracks(1, ahead)[0].boxes[0].truncation, BoxTruncation::kInImage);
  MeshBuilder half;  // hides its left half
  half.surface = 2;
  half.box({6, 0, 0.1}, {6.1, 4, 1.5});
  scenery_.add({6, 0}, half.take());
  EXPECT_EQ(tracks(1, ahead)[0].boxes[0].occlusion, BoxOcclusion::kPartly);
  MeshBuilder plate;  // right before the camera, below the LiDAR's view
  plate.surface = 3;
  plate.box({0.6, -1, 0.1}, {0.61, 1, 1.66});
  scenery_.add({0, 0}, plate.take());
  const auto found = tracks(1, ahead);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].boxes[0].occlusion, BoxOcclusion::kFully);
}

/// A drive whose scans have all their rings and few columns, with the boxes that were written.
class LabelledDrive : public testing::TestWithParam<Scene> {
 protected:
  LabelledDrive() {
    SimulationOptions options = simulation_options(GetParam(), "default");
    options.frames = 12;
    options.lidar.columns = 500;
    options.camera.width = 64;
    options.camera.height = 24;
    options.camera.focal = 40;
    options.camera.cx = 31.5;
    options.camera.cy = 11.5;
    options.camera.cameras.resize(1);
    drive_ = simulate(options, folder_ / "d");
  }
  TemporaryFolder folder_;
  std::filesystem::path drive_;
};
INSTANTIATE_TEST_SUITE_P(TrackletLabels, LabelledDrive,
                         testing::Values(Scene::kTraffic, Scene::kStress, Scene::kCrossing),
                         [](const auto& test) { return std::string(to_string(test.param)); });

TEST_P(LabelledDrive, BoxesHoldTheirThingsReturnsAndNoOthers) {
  const auto file = find_tracklets(drive_);
  ASSERT_TRUE(file);
  const auto tracklets = read_tracklets(*file);
  const DriveTruth truth(drive_);
  const World world = read_world(truth.folder());
  const auto labelled = [&](const TrueReturn& r) {
    if (r.moving) return true;
    const std::string& kind = world.surfaces.at(r.surface);
    return kind == "parked car" || kind == "bystander";
  };
  const auto held = [&](int frame, const TrueReturn& r, double margin) {
    return std::any_of(tracklets.begin(), tracklets.end(), [&](const Tracklet& tracklet) {
      return tracklet.contains(frame, r.hit_lidar.cast<double>(), margin);
    });
  };
  int own = 0, own_held = 0, others = 0, others_held = 0, boxes = 0;
  for (int frame = 0; frame < truth.frames(); ++frame) {
    for (const TrueReturn& r : truth.returns(frame)) {
      if (r.hit_lidar.norm() > 60) continue;
      if (labelled(r)) {
        ++own;
        own_held += held(frame, r, 0.1);  // the margin that the evaluation allows
      } else {
        ++others;
        others_held += held(frame, r, -0.05);  // well inside: what stands on the ground touches it
      }
    }
    for (const Tracklet& t : tracklets) boxes += t.at(frame) != nullptr;
  }
  EXPECT_GT(own, 1000);
  EXPECT_GT(boxes, 100);
  EXPECT_GT(own_held, 0.995 * own) << own;
  EXPECT_LT(others_held, 0.0005 * others) << others;
}

TEST_P(LabelledDrive, MoversMoveAndTheOthersStand) {
  const auto tracklets = read_tracklets(*find_tracklets(drive_));
  const DriveTruth truth(drive_);
  std::set<std::string> moved, stood;
  for (const Tracklet& tracklet : tracklets) {
    ASSERT_FALSE(tracklet.T_lidar_box.empty());
    const auto place = [&](std::size_t k) {
      const auto frame = static_cast<std::size_t>(tracklet.first_frame) + k;
      return Vector3d(truth.T_local_lidar()[frame] * tracklet.T_lidar_box[k].translation());
    };
    const std::size_t last = tracklet.T_lidar_box.size() - 1;
    if (last < 8) continue;
    const double way = (place(last) - place(0)).norm();
    EXPECT_TRUE(way < 1e-3 || way > 0.5) << tracklet.type << " " << way;
    (way > 0.5 ? moved : stood).insert(tracklet.type);
  }
  EXPECT_THAT(stood, Contains("Car"));
  if (GetParam() == Scene::kTraffic) {
    EXPECT_THAT(moved, testing::IsSupersetOf({"Car", "Pedestrian"}));
  } else {
    EXPECT_TRUE(moved.empty());
  }
  if (GetParam() == Scene::kStress) {
    EXPECT_THAT(stood, Contains("Pedestrian"));
  }
}

}  // namespace fovea::tracklet_labels_test
