#include "fovea/simulation/simulate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "../../../tests/file_content.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/drive_truth.h"
#include "fovea/drive/frame_source.h"
#include "fovea/errors.h"
#include "fovea/world/world_file.h"

namespace fovea::simulate_test {

namespace fs = std::filesystem;
using ::testing::IsEmpty;

/// As little of a drive as shows everything.
SimulationOptions tiny(Scene scene = Scene::kTraffic, std::string_view noise = "default") {
  SimulationOptions options = simulation_options(scene, noise);
  options.frames = 2;
  options.lidar.columns = 60;
  options.camera.width = 64;
  options.camera.height = 24;
  options.camera.focal = 40;
  options.camera.cx = 31.5;
  options.camera.cy = 11.5;
  return options;
}

/// Names of files that differ or that only one drive has.
std::vector<std::string> differences(const std::map<std::string, std::string>& a,
                                     const std::map<std::string, std::string>& b) {
  std::vector<std::string> names;
  for (const auto& [name, content] : a) {
    if (!b.contains(name) || b.at(name) != content) names.push_back(name);
  }
  for (const auto& [name, content] : b) {
    if (!a.contains(name)) names.push_back(name);
  }
  return names;
}

TEST(Simulate, SameOptionsGiveTheSameBytesAtAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const SimulationOptions options = tiny();
  {
    const ThreadLimit one(1);
    simulate(options, folder / "one");
  }
  {
    const ThreadLimit two(2);
    simulate(options, folder / "two");
  }
  const auto one = contents(folder / "one");
  EXPECT_GT(one.size(), 30u);
  EXPECT_THAT(differences(one, contents(folder / "two")), IsEmpty());

  SimulationOptions other = options;
  other.seed = 2;
  simulate(other, folder / "other");
  const auto differ = differences(one, contents(folder / "other"));
  EXPECT_THAT(differ, ::testing::Contains(::testing::HasSubstr("world.ply")));
  EXPECT_THAT(differ, ::testing::Contains(::testing::HasSubstr("velodyne_points/data/0000000001")));
  EXPECT_THAT(differ, ::testing::Contains(::testing::HasSubstr("image_02/data/0000000000")));
  EXPECT_THAT(differ, ::testing::Contains(::testing::HasSubstr("oxts/data/0000000001")));
}

TEST(Simulate, ProductReadsTheDriveAndItsTruth) {
  const TemporaryFolder folder;
  SimulationOptions options = tiny();
  options.frames = 4;
  int calls = 0;
  const fs::path drive = simulate(options, folder / "d", [&](int done, int total) {
    EXPECT_EQ(done, ++calls);
    EXPECT_EQ(total, 4);
    return true;
  });
  EXPECT_EQ(calls, 4);
  EXPECT_EQ(drive, folder / "d" / "2026_01_01" / "2026_01_01_drive_0001_sync");
  DriveOptions open;
  open.cameras = {2, 3};
  const auto source = open_drive(folder / "d", open);
  EXPECT_EQ(source->info().begin, 0);
  EXPECT_EQ(source->info().end, 4);
  EXPECT_THAT(source->info().notes, IsEmpty());
  ASSERT_TRUE(source->info().navigation);

  const DriveTruth truth(drive);
  EXPECT_EQ(truth.scene(), "traffic");
  EXPECT_EQ(truth.frames(), 4);
  EXPECT_NEAR(truth.sweep_period(), options.lidar.period, 1e-12);
  EXPECT_LT(truth.T_local_lidar()[0].translation().norm(), 1e-9);
  for (int k = 0; k < 4; ++k) {
    const auto result = source->load(k);
    ASSERT_TRUE(std::holds_alternative<Frame>(result));
    const auto& frame = std::get<Frame>(result);
    EXPECT_GT(frame.scan.size(), 1000u);
    EXPECT_EQ(frame.dropped_points.total(), 0u);
    const auto returns = truth.returns(k);
    ASSERT_EQ(returns.size(), frame.scan.size());
    // Camera, image and truth belong together.
    for (std::size_t c = 0; c < 2; ++c) {
      const Camera& camera = source->info().calibration.cameras[c];
      EXPECT_EQ(frame.images[c].width, 64);
      EXPECT_EQ(frame.images[c].height, 24);
      const TrueCamera& true_camera = truth.camera(camera.index);
      ASSERT_EQ(true_camera.T_local_cam.size(), 4u);
      const RigidMotion T_local_cam =
          truth.T_local_lidar()[std::size_t(k)] * camera.T_cam_lidar.inverse();
      EXPECT_LT((T_local_cam.matrix() - true_camera.T_local_cam[std::size_t(k)].matrix()).norm(),
                1e-9);
      EXPECT_EQ(truth.perfect_image(camera.index, k).channels, 3);
      EXPECT_EQ(truth.depth(camera.index, k).width, 64);
    }
  }
}

// Everything that is true of a drive agrees: scans, depth maps, poses, the world.
TEST(Simulate, AnotherPassDrivesTheSameStreetOtherwise) {
  const TemporaryFolder folder;
  SimulationOptions options = tiny(Scene::kTraffic, "none");
  const fs::path first = simulate(options, folder / "first");
  options.pass = 1;
  const fs::path second = simulate(options, folder / "second");
  const auto a = contents(first), b = contents(second);
  // The world is the same, in the same local frame ...
  EXPECT_EQ(a.at("truth/world.ply"), b.at("truth/world.ply"));
  // ... and the vehicle is near where it was, but not just there.
  const RigidMotion T_local_first = DriveTruth(first).T_local_lidar().front();
  const RigidMotion T_local_second = DriveTruth(second).T_local_lidar().front();
  EXPECT_LT(T_local_first.translation().norm(), 1e-6);
  EXPECT_GT(T_local_second.translation().norm(), 0.01);
  EXPECT_LT(T_local_second.translation().norm(), 1.5);
}

TEST(Simulate, TriggerDelayMovesTheImagesAndNothingElse) {
  const TemporaryFolder folder;
  SimulationOptions options = tiny();
  options.lidar.period = 0.04;
  options.navigation.max_delay = 0.02;
  options.camera.cameras.resize(1);
  const fs::path prompt = simulate(options, folder / "prompt");
  options.camera.trigger_delay = 0.04;  // a whole frame: image 0 is what image 1 was
  const fs::path late = simulate(options, folder / "late");
  const DriveTruth prompt_truth(prompt), late_truth(late);
  const RigidMotion& expected = prompt_truth.camera(2).T_local_cam[1];
  EXPECT_LT((late_truth.camera(2).T_local_cam[0].matrix() - expected.matrix()).norm(), 1e-9);
  EXPECT_GT((prompt_truth.camera(2).T_local_cam[0].matrix() - expected.matrix()).norm(), 0.1);
  EXPECT_EQ(late_truth.perfect_image(2, 0).data, prompt_truth.perfect_image(2, 1).data);
  for (const auto& name : differences(contents(prompt), contents(late))) {
    EXPECT_THAT(name, ::testing::AnyOf(::testing::HasSubstr("image_02"),
                                       ::testing::HasSubstr("truth.json")));
  }
}

TEST(Simulate, DepthMapsAgreeWithTheScan) {
  const TemporaryFolder folder;
  SimulationOptions options = tiny(Scene::kStreet, "none");
  options.lidar.columns = 720;
  options.camera.width = 320;
  options.camera.height = 100;
  options.camera.focal = 180;
  options.camera.cx = 160.2;
  options.camera.cy = 44.9;
  options.vehicle.speed = 0;  // a sweep and an image are of one moment
  options.frames = 1;
  const fs::path drive = simulate(options, folder / "d");
  DriveOptions open;
  open.cameras = {2};
  const auto source = open_drive(drive, open);
  const Camera camera = source->info().calibration.cameras[0];
  const DriveTruth truth(drive);
  const DepthImage depth = truth.depth(2, 0);
  const auto returns = truth.returns(0);
  int compared = 0, agree = 0;
  for (const TrueReturn& r : returns) {
    const Eigen::Vector3d p = camera.T_cam_lidar * r.hit_lidar.cast<double>();
    const auto pixel = camera.project(p);
    if (!pixel || !camera.in_view(*pixel)) continue;
    const auto u = int(std::lround(pixel->x())), v = int(std::lround(pixel->y()));
    const double d = depth.at(u, v);
    ++compared;
    agree += std::abs(d - p.z()) < 0.02 * p.z() + 0.05;
  }
  EXPECT_GT(compared, 3000);
  EXPECT_GT(agree, 0.9 * compared);  // the rest lies at the rims of things
}

TEST(Simulate, StoppedIsAsIfNothingHadBeen) {
  const TemporaryFolder folder;
  for (const int last : {1, 2}) {
    EXPECT_EQ(simulate(tiny(), folder / "d", [&](int done, int) { return done < last; }), "");
    EXPECT_THAT(folder.names(), IsEmpty());
  }
}

TEST(Simulate, RefusesOptionsOutOfRangeBeforeAnythingIsWritten) {
  const TemporaryFolder folder;
  SimulationOptions options = tiny();
  options.lidar.columns = 1;
  EXPECT_THROW(simulate(options, folder / "d"), ConfigError);
  EXPECT_THAT(folder.names(), IsEmpty());
  fs::create_directory(folder / "there");
  EXPECT_THROW(simulate(tiny(), folder / "there"), OutputError);
}

class SimulatedScene : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Simulate, SimulatedScene,
                         testing::Range(std::size_t{0}, scene_names().size()),
                         [](const auto& test) { return scene_names()[test.param]; });

// Every level of noise, too, in turn.
TEST_P(SimulatedScene, GivesADrive) {
  const TemporaryFolder folder;
  const std::string scene = scene_names()[GetParam()], noise = noise_names()[GetParam() % 3];
  SimulationOptions options = tiny(parse_scene(scene), noise);
  options.camera.cameras.resize(1);
  const fs::path drive = simulate(options, folder / "d");
  const auto source = open_drive(drive, {});
  EXPECT_EQ(source->info().end, 2);
  EXPECT_TRUE(std::holds_alternative<Frame>(source->load(1)));
  const DriveTruth truth(drive);
  EXPECT_EQ(truth.scene(), scene);
  EXPECT_GT(truth.returns(1).size(), 700u);
  const World world = read_world(truth.folder());
  EXPECT_GT(world.mesh_local.size(), 5000u);
  // Every static thing that was hit is in the world.
  for (const TrueReturn& r : truth.returns(1)) {
    EXPECT_TRUE(r.moving || world.surfaces.contains(r.surface));
  }
}

}  // namespace fovea::simulate_test
