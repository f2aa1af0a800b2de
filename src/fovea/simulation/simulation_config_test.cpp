#include "fovea/simulation/simulation_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "fovea/errors.h"

namespace fovea::simulation_config_test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

template <class F>
std::string config_error(F&& f) {
  try {
    f();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no ConfigError";
}

TEST(SimulationOptions, ScenesHaveNamesAndValidOptions) {
  EXPECT_THAT(scene_names(),
              ElementsAre("street", "traffic", "crossing", "canyon", "plaza", "stress", "town"));
  for (const std::string& name : scene_names()) {
    EXPECT_EQ(to_string(parse_scene(name)), name);
    for (const std::string& noise : noise_names()) {
      const SimulationOptions options = simulation_options(parse_scene(name), noise);
      EXPECT_EQ(options.scene, parse_scene(name));
      EXPECT_NO_THROW(options.validate()) << name << ' ' << noise;
    }
  }
  EXPECT_THAT(config_error([] { parse_scene("moon"); }),
              AllOf(HasSubstr("moon"), HasSubstr("--scene"), HasSubstr("street, traffic")));
  EXPECT_THAT(config_error([] { simulation_options(Scene::kStreet, "some"); }),
              AllOf(HasSubstr("some"), HasSubstr("--noise"), HasSubstr("none, default, harsh")));
}

TEST(SimulationOptions, NoiseLevelsGrowAndLeaveTheVehicleAlone) {
  const auto none = simulation_options(Scene::kCanyon, "none"),
             usual = simulation_options(Scene::kCanyon, "default"),
             harsh = simulation_options(Scene::kCanyon, "harsh");
  const auto levels = [](const SimulationOptions& o) {
    const NavigationOptions& n = o.navigation;
    return std::vector<double>{o.lidar.range_noise, o.lidar.range_resolution,
                               o.lidar.dropouts,    o.camera.exposure_variation,
                               o.camera.vignetting, o.camera.noise,
                               n.position_noise,    n.position_walk,
                               n.position_bias,     n.angle_noise,
                               n.angle_walk,        n.velocity_noise,
                               n.rate_noise,        n.jump_rate};
  };
  for (std::size_t i = 0; i < levels(none).size(); ++i) {
    EXPECT_EQ(levels(none)[i], 0) << i;
    EXPECT_GT(levels(usual)[i], 0) << i;
    EXPECT_GT(levels(harsh)[i], 1.9 * levels(usual)[i]) << i;
    EXPECT_LT(levels(harsh)[i], 4 * levels(usual)[i]) << i;
  }
  EXPECT_FALSE(none.navigation.outages);
  EXPECT_TRUE(usual.navigation.outages);
  EXPECT_FALSE(simulation_options(Scene::kStreet, "default").navigation.outages);
  EXPECT_TRUE(simulation_options(Scene::kStreet, "harsh").navigation.outages);
  EXPECT_EQ(none.vehicle.speed, harsh.vehicle.speed);
  EXPECT_EQ(none.vehicle.sway, harsh.vehicle.sway);
}

TEST(SimulationOptions, RejectsByKey) {
  const auto error = [](auto&& change) {
    SimulationOptions options;
    change(options);
    return config_error([&] { options.validate(); });
  };
  EXPECT_THAT(error([](auto& o) { o.frames = 0; }),
              AllOf(HasSubstr("--frames"), HasSubstr("1 to 100000")));
  EXPECT_THAT(error([](auto& o) { o.frames = 100'001; }), HasSubstr("--frames"));
  EXPECT_THAT(error([](auto& o) { o.seed = -1; }), HasSubstr("--seed"));
  EXPECT_THAT(error([](auto& o) { o.vehicle.speed = NAN; }), HasSubstr("vehicle.speed"));
  EXPECT_THAT(error([](auto& o) { o.vehicle.speed_variation = 1; }),
              HasSubstr("vehicle.speed_variation"));
  EXPECT_THAT(error([](auto& o) { o.vehicle.sway = 1; }),
              AllOf(HasSubstr("vehicle.sway"), HasSubstr("57.2958 degrees")));
  EXPECT_THAT(error([](auto& o) { o.lidar.min_range = 50, o.lidar.max_range = 40; }),
              HasSubstr("lidar.max_range"));
  EXPECT_THAT(error([](auto& o) { o.camera.cameras.clear(); }), HasSubstr("camera.numbers"));
  EXPECT_THAT(error([](auto& o) { o.camera.cameras = {{2, 0}, {2, 1}}; }), HasSubstr("twice"));
  EXPECT_THAT(error([](auto& o) { o.camera.cameras = {{10, 0}}; }), HasSubstr("camera.numbers"));
  EXPECT_THAT(error([](auto& o) { o.camera.width = 1 << 20; }), HasSubstr("camera.width"));
  EXPECT_THAT(error([](auto& o) { o.camera.rotation_error.y() = 0.1; }),
              HasSubstr("camera.rotation_error_y"));
  EXPECT_THAT(error([](auto& o) { o.imu.rate = 100; }), HasSubstr("imu.rate"));
  EXPECT_THAT(error([](auto& o) { o.wheels.rate = 10; }), HasSubstr("wheels.rate"));
  EXPECT_THAT(error([](auto& o) { o.imu.flipped_axis = 4; }), HasSubstr("imu.flipped_axis"));
  EXPECT_THAT(error([](auto& o) { o.camera.trigger_delay = 0.25; }),
              HasSubstr("camera.trigger_delay"));
  EXPECT_THAT(error([](auto& o) { o.navigation.max_delay = 0.005; }),
              HasSubstr("navigation.max_delay"));
  EXPECT_THAT(error([](auto& o) { o.navigation.max_delay = 0.13; }), HasSubstr("out of order"));
  EXPECT_THAT(error([](auto& o) { o.navigation.origin.latitude = 90; }),
              HasSubstr("navigation.latitude"));
}

TEST(SimulationOptions, RejectsRingsByTheirKey) {
  const auto error = [](std::vector<double> elevations, LidarModel model = LidarModel::kHdl64) {
    SimulationOptions options;
    options.format = DriveFormat::kGeneric;
    set_model(options.lidar, model);
    options.lidar.elevations = std::move(elevations);
    return config_error([&] { options.validate(); });
  };
  EXPECT_EQ(error({0.2, 0.1, 0}), "no ConfigError");
  EXPECT_THAT(error({0.1, 0.1}), AllOf(HasSubstr("lidar.elevations"), HasSubstr("twice")));
  EXPECT_THAT(error({0.1, 0.2}), HasSubstr("highest first"));
  EXPECT_THAT(error({2}), AllOf(HasSubstr("lidar.elevations"), HasSubstr("-90 to 90")));
  EXPECT_THAT(error({NAN}), HasSubstr("lidar.elevations"));
  EXPECT_THAT(error(std::vector<double>(257)), HasSubstr("at most 256"));
  EXPECT_THAT(error({0.1}, LidarModel::kLivoxAvia), HasSubstr("no rings"));
}

TEST(SimulationOptions, ARosetteNeedsPointTimes) {
  SimulationOptions options;
  set_model(options.lidar, LidarModel::kLivoxHap);
  EXPECT_THAT(config_error([&] { options.validate(); }),
              AllOf(HasSubstr("lidar.model"), HasSubstr("--format generic")));
  options.format = DriveFormat::kGeneric;
  EXPECT_NO_THROW(options.validate());
}

TEST(SimulationOptions, KittisFormatHasOneSweepAndAnyMount) {
  const auto error = [](auto&& change) {
    SimulationOptions options;
    change(options.lidar);
    const std::string kitti = config_error([&] { options.validate(); });
    options.format = DriveFormat::kGeneric;
    EXPECT_NO_THROW(options.validate());
    return kitti;
  };
  EXPECT_THAT(error([](auto& lidar) { lidar.direction = SweepDirection::kCounterclockwise; }),
              AllOf(HasSubstr("lidar.direction"), HasSubstr("--format generic")));
  EXPECT_THAT(error([](auto& lidar) { lidar.start_azimuth = 0; }),
              AllOf(HasSubstr("lidar.start_azimuth"), HasSubstr("--format generic")));
  EXPECT_THAT(error([](auto& lidar) { lidar.stamp_phase = 1; }),
              AllOf(HasSubstr("lidar.stamp_phase"), HasSubstr("--format generic")));
  // The calibration has the mount.
  EXPECT_EQ(error([](auto& lidar) { lidar.roll = 180 * kDegree; }), "no ConfigError");
}

TEST(SimulationOptions, ARosetteDoesNotRotate) {
  SimulationOptions options;
  options.format = DriveFormat::kGeneric;
  set_model(options.lidar, LidarModel::kLivoxAvia);
  options.lidar.stamp_phase = 0;
  EXPECT_NO_THROW(options.validate());
  options.lidar.direction = SweepDirection::kCounterclockwise;
  EXPECT_THAT(config_error([&] { options.validate(); }),
              AllOf(HasSubstr("lidar.direction"), HasSubstr("does not rotate")));
}

TEST(SimulationConfig, AModelSetsTheLidarAndOtherKeysChangeIt) {
  SimulationOptions options = simulation_options(Scene::kStreet, "default");
  apply_setting("lidar.model=vlp16", options);
  EXPECT_EQ(ring_elevations(options.lidar).size(), 16u);
  EXPECT_EQ(options.lidar.period, 0.1);
  EXPECT_EQ(sweep_columns(options.lidar), 1808);
  EXPECT_EQ(options.lidar.max_range, 100);
  EXPECT_NEAR(options.lidar.range_noise, 0.03, 1e-15);
  // Other keys of the document change the model, wherever they stand.
  apply_config_text("[lidar]\nperiod = 0.05\nelevations = [10, 0.5, -20]\nmodel = \"xt32\"\n",
                    "x.toml", options);
  EXPECT_EQ(options.lidar.period, 0.05);
  EXPECT_NEAR(options.lidar.range_noise, 0.005, 1e-15);
  EXPECT_THAT(ring_elevations(options.lidar),
              ElementsAre(10 * kDegree, 0.5 * kDegree, -20 * kDegree));
  SimulationOptions back;
  apply_config_text(to_toml(options), "x.toml", back);
  EXPECT_EQ(to_toml(back), to_toml(options));
  EXPECT_EQ(back.lidar.elevations, options.lidar.elevations);
  EXPECT_EQ(back.lidar.range_noise, options.lidar.range_noise);

  apply_setting("lidar.model=hdl64", options);
  EXPECT_EQ(sweep_columns(options.lidar), 2083);
  EXPECT_EQ(options.lidar.period, LidarOptions().period);
  EXPECT_THAT(config_error([&] { apply_setting("lidar.model=radar", options); }),
              AllOf(HasSubstr("lidar.model"), HasSubstr("os1-64")));
}

TEST(SimulationConfig, AModelKeepsTheLevelOfNoise) {
  SimulationOptions none = simulation_options(Scene::kStreet, "none"),
                    harsh = simulation_options(Scene::kStreet, "harsh");
  for (SimulationOptions* options : {&none, &harsh}) apply_setting("lidar.model=vlp16", *options);
  EXPECT_EQ(none.lidar.range_noise, 0);
  EXPECT_EQ(none.lidar.range_resolution, 0);
  EXPECT_NEAR(harsh.lidar.range_noise, 0.04 / 0.015 * 0.03, 1e-15);
}

TEST(SimulationConfig, ReadsBackTheSame) {
  for (const std::string& noise : noise_names()) {
    SimulationOptions options = simulation_options(Scene::kCanyon, noise);
    options.camera.cameras = {{3, 0.5, false}, {0, 0.1, true}, {9, -0.3, true}};
    options.curvature = -0.0123;
    options.camera.rotation_error = {0.3 * kDegree, -0.2 * kDegree, 0.1 * kDegree};
    options.camera.trigger_delay = 0.02;
    options.lidar.roll = 180 * kDegree;
    options.lidar.direction = SweepDirection::kCounterclockwise;
    options.lidar.start_azimuth = 12.5 * kDegree;
    options.lidar.stamp_phase = 0.75;
    options.format = DriveFormat::kGeneric;
    SimulationOptions back;
    back.format = DriveFormat::kGeneric;
    apply_config_text(to_toml(options), "x.toml", back);
    EXPECT_EQ(to_toml(back), to_toml(options));
    // To the last bit: the same options make the same bytes.
    EXPECT_EQ(back.light.sun_azimuth, options.light.sun_azimuth);
    EXPECT_EQ(back.vehicle.sway, options.vehicle.sway);
    EXPECT_EQ(back.bends, options.bends);
    EXPECT_EQ(back.curvature, options.curvature);
    EXPECT_EQ(back.camera.rotation_error, options.camera.rotation_error);
    EXPECT_EQ(back.camera.trigger_delay, options.camera.trigger_delay);
    EXPECT_EQ(back.lidar.roll, options.lidar.roll);
    EXPECT_EQ(back.lidar.start_azimuth, options.lidar.start_azimuth);
    EXPECT_EQ(back.navigation.angle_noise, options.navigation.angle_noise);
    EXPECT_EQ(back.navigation.angle_walk, options.navigation.angle_walk);
    EXPECT_EQ(back.navigation.rate_noise, options.navigation.rate_noise);
    ASSERT_EQ(back.camera.cameras.size(), 3u);
    EXPECT_EQ(back.camera.cameras[2].number, 9);
    EXPECT_EQ(back.camera.cameras[2].right, -0.3);
    EXPECT_TRUE(back.camera.cameras[2].grey);
  }
}

TEST(SimulationConfig, Cameras) {
  SimulationOptions options;
  apply_setting("camera.numbers=[0, 1, 2, 3, 5]", options);  // KITTI's places are known
  ASSERT_EQ(options.camera.cameras.size(), 5u);
  EXPECT_EQ(options.camera.cameras[1].right, 0.54);
  EXPECT_TRUE(options.camera.cameras[1].grey);
  EXPECT_EQ(options.camera.cameras[3].right, 0.473);
  apply_setting("camera.right_5=0.2", options);
  apply_setting("camera.grey_5=true", options);
  EXPECT_EQ(options.camera.cameras[4].right, 0.2);
  EXPECT_TRUE(options.camera.cameras[4].grey);
  EXPECT_THAT(config_error([&] { apply_setting("camera.right_6=0.2", options); }),
              AllOf(HasSubstr("not simulated"), HasSubstr("--set camera.right_6=0.2:1"),
                    HasSubstr("camera.numbers")));
  EXPECT_THAT(config_error([&] { apply_setting("camera.numbers=[2, 2]", options); }),
              HasSubstr("twice"));
  EXPECT_THAT(config_error([&] { apply_setting("camera.numbers=[12]", options); }),
              HasSubstr("0 to 9"));
  EXPECT_EQ(options.camera.cameras.size(), 5u);  // what failed changed nothing
}

TEST(SimulationConfig, AnglesAreInDegreesAndErrorsNameFileLineAndKey) {
  SimulationOptions options;
  apply_config_text("[light]\nsun_azimuth = 90\n[navigation]\noutages = true", "x.toml", options);
  EXPECT_EQ(options.light.sun_azimuth, 90 * kDegree);
  EXPECT_TRUE(options.navigation.outages);
  const auto error = [&](std::string_view text) {
    return config_error([&] { apply_config_text(text, "x.toml", options); });
  };
  EXPECT_THAT(error("[light]\nsun = 1\nsun_elevation = 95"),
              AllOf(HasSubstr("x.toml:3"), HasSubstr("light.sun_elevation"), HasSubstr("0 to 90")));
  EXPECT_THAT(error("[light]\nmoon = 1"),
              AllOf(HasSubstr("unknown key"), HasSubstr("docs/simulator.md")));
  EXPECT_EQ(options.light.sun, LightOptions{}.sun);
  EXPECT_THAT(config_error([&] { apply_setting("speed", options); }),
              HasSubstr("vehicle.speed=12"));
  EXPECT_THROW(apply_config_file("/nonexistent.toml", options), InputError);
}

TEST(SimulationConfig, ARigIsAWholeSetOfCamerasAndEachCanBeChanged) {
  SimulationOptions options;
  options.format = DriveFormat::kGeneric;
  apply_setting("camera.rig=surround", options);
  ASSERT_EQ(options.camera.cameras.size(), 5u);
  EXPECT_EQ(options.camera.cameras[1].lens, SimulatedLens::kFisheye);
  EXPECT_NEAR(options.camera.cameras[4].yaw, -72 * kDegree, 1e-12);
  apply_setting("camera.lens_1=plumb_bob", options);
  apply_config_text("[camera]\nnumbers = [1, 3]\nyaw_3 = 10", "text", options);
  ASSERT_EQ(options.camera.cameras.size(), 2u);
  EXPECT_EQ(options.camera.cameras[0].lens, SimulatedLens::kPlumbBob);
  EXPECT_NEAR(options.camera.cameras[0].yaw, 72 * kDegree, 1e-12);
  EXPECT_NEAR(options.camera.cameras[1].yaw, 10 * kDegree, 1e-12);
  SimulationOptions back;
  back.format = DriveFormat::kGeneric;
  apply_config_text(to_toml(options), "text", back);
  EXPECT_EQ(to_toml(back), to_toml(options));
  EXPECT_THAT(config_error([&] { apply_setting("camera.yaw_0=3", options); }),
              HasSubstr("not simulated"));
  EXPECT_THAT(config_error([&] { apply_setting("camera.rig=ring", options); }),
              HasSubstr("'kitti', 'surround'"));
}

TEST(SimulationConfig, TheDocumentationListsEveryKeyWithItsDefault) {
  std::ostringstream document;
  document << std::ifstream(FOVEA_SOURCE_DIR "/docs/simulator.md").rdbuf();
  EXPECT_THAT(document.str(), HasSubstr("```toml\n" + to_toml(SimulationOptions{}) + "```"));
  std::string town = to_toml(simulation_options(Scene::kTown, "default"));
  town.erase(0, town.find("[town]"));
  town.erase(town.find("\n[lidar]"));
  EXPECT_THAT(document.str(), HasSubstr("```toml\n" + town + "```"));
}

TEST(SimulationConfig, OnlyTheTownHasKeysOfTheTown) {
  SimulationOptions options = simulation_options(Scene::kTown, "default");
  apply_setting("town.route=0,2 4,2", options);
  EXPECT_EQ(options.town.route, "0,2 4,2");
  SimulationOptions back = simulation_options(Scene::kTown, "default");
  apply_config_text(to_toml(options), "text", back);
  EXPECT_EQ(to_toml(back), to_toml(options));
  EXPECT_THAT(config_error([&] { apply_setting("town.blocks_x=3", options); }),
              AllOf(HasSubstr("outside the town"), HasSubstr("town.route")));
  SimulationOptions street;
  EXPECT_THAT(to_toml(street), Not(HasSubstr("town")));
  EXPECT_THAT(config_error([&] { apply_setting("town.begin=3", street); }),
              AllOf(HasSubstr("scene street"), HasSubstr("town.begin"), HasSubstr("--scene town")));
}

}  // namespace fovea::simulation_config_test
