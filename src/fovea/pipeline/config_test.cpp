#include "fovea/pipeline/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "fovea/errors.h"
#include "fovea/pipeline/settings_rows.h"

namespace fovea::config_test {

using testing::AllOf;
using testing::HasSubstr;

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Config, EveryPresetLoads) {
  EXPECT_THAT(preset_names(), testing::IsSupersetOf({"default", "paper", "realtime"}));
  for (const std::string& name : preset_names()) EXPECT_NO_THROW(load_preset(name)) << name;
  EXPECT_THROW(load_preset("nonsense"), ConfigError);
}

TEST(Config, ThePresetsHaveTheDefaultsOfTheTables) {
  EXPECT_EQ(to_toml(load_preset("default")), to_toml(default_settings(MapperKind::kDefault)));
  MapSettings paper = load_preset("paper");
  EXPECT_EQ(paper.foveal().slices.size(), 2u);  // of the paper's figure
  paper.paper().foveal.slices.clear();
  EXPECT_EQ(to_toml(paper), to_toml(default_settings(MapperKind::kPaper)));
}

TEST(Config, OptionsBeginWithTheDefaultsOfTheTables) {
  EXPECT_EQ(to_toml(MapperOptions()), to_toml(default_settings(MapperKind::kDefault)));
  EXPECT_EQ(to_toml(PaperOptions()), to_toml(default_settings(MapperKind::kPaper)));
}

TEST(Config, ResolvedConfigurationReadsBack) {
  MapSettings settings = load_preset("paper");
  settings.paper().foveal.camera_slices[3] = {{-0.1, 0.1, -0.3, 0.2}};
  settings.paper().registration = RegistrationMethod::kPointToPlane;
  settings.paper().ray_filter.window = 7;
  const std::string text = to_toml(settings);
  MapSettings back;
  apply_config_text(text, "resolved", back);
  EXPECT_EQ(to_toml(back), text);
  EXPECT_EQ(back.paper().ray_filter.window, 7);
  ASSERT_EQ(back.paper().foveal.camera_slices.count(3), 1u);
  EXPECT_NEAR(back.paper().foveal.camera_slices[3][0].elevation_min, -0.3, 1e-12);
}

TEST(Config, TheHeadOfAFileSelectsTheMapper) {
  MapSettings settings;
  apply_config_text("mapper = 'paper'\n[upsample]\nrate = 3", "x", settings);
  EXPECT_EQ(mapper_of(settings), MapperKind::kPaper);
  EXPECT_EQ(settings.paper().upsample.rate, 3);
  apply_config_text("[ray_filter]\nwindow_px = 7", "x", settings);
  EXPECT_EQ(settings.paper().upsample.rate, 3);
  EXPECT_EQ(settings.paper().ray_filter.window, 7);
  apply_setting("mapper=default", settings);
  EXPECT_EQ(to_toml(settings), to_toml(MapperOptions()));
}

TEST(Config, DegreesBecomeRadians) {
  MapSettings settings;
  apply_config_text("[foveal]\nmax_incidence_deg = 70\nslices_deg = [[-25, 25, -20.5, -10]]", "x",
                    settings);
  EXPECT_NEAR(settings.foveal().max_incidence, 70 * std::numbers::pi / 180, 1e-12);
  ASSERT_EQ(settings.foveal().slices.size(), 1u);
  EXPECT_NEAR(settings.foveal().slices[0].elevation_min, -20.5 * std::numbers::pi / 180, 1e-12);
}

/// The error for a text over a preset.
std::string error_over(const char* preset, const char* text) {
  return error_of([&] {
    MapSettings settings = load_preset(preset);
    apply_config_text(text, "my.toml", settings);
  });
}

TEST(Config, ErrorsNameFileLineAndKey) {
  EXPECT_THAT(
      error_over("default", "[surface]\nspacng_m = 5"),
      AllOf(HasSubstr("unknown key"), HasSubstr("my.toml:2"), HasSubstr("surface.spacng_m")));
  EXPECT_THAT(error_over("paper", "[ray_filter]\n\nwindow_px = 5.5"),
              AllOf(HasSubstr("wrong type"), HasSubstr("my.toml:3"), HasSubstr("whole")));
  EXPECT_THAT(error_over("paper", "[ray_filter]\nwindow_px = 4"),
              AllOf(HasSubstr("my.toml:2"), HasSubstr("ray_filter.window_px"),
                    HasSubstr("an odd number, 1 to 101")));
  EXPECT_THAT(error_over("paper", "[registration]\nmethod = 'icpp'"),
              AllOf(HasSubstr("icpp"), HasSubstr("'plane'"), HasSubstr("my.toml:2")));
  EXPECT_THAT(error_over("default", "[surface]\nspacing_m = 2\nmax_edge_m = 'far'"),
              HasSubstr("my.toml:3"));
  EXPECT_THAT(error_over("default", "[surface\nspacing_m = 2"), HasSubstr("my.toml:1"));
  EXPECT_THAT(error_over("default", "[foveal]\nslices_deg = [[1, 2, 3]]"),
              HasSubstr("foveal.slices_deg"));
  EXPECT_THAT(error_over("default", "[foveal]\nslices_deg = [[2, 1, 3, 4]]"),
              HasSubstr("foveal.slices_deg"));
  EXPECT_THAT(error_over("default", "[foveal]\ncamera_3_slices_deg = [[-1, 1, 3, 95]]"),
              AllOf(HasSubstr("my.toml:2"), HasSubstr("foveal.camera_3_slices_deg")));
  EXPECT_THAT(error_over("paper", "[foveal]\nfar_range_m = 2"),
              AllOf(HasSubstr("foveal.far_range_m"), HasSubstr("near range")));
  EXPECT_THAT(error_over("default", "surface = 3"), HasSubstr("unknown key"));
  EXPECT_THAT(error_over("default", "mapper = 'fast'"), HasSubstr("'paper'"));
}

/// Expects an error that names the key for each value.
void expect_refused(const char* preset, const std::string& key,
                    std::initializer_list<const char*> values) {
  for (const char* value : values) {
    EXPECT_THAT(error_over(preset, (key + " = " + value).c_str()),
                AllOf(HasSubstr("a value is not allowed"), HasSubstr(key)))
        << value;
  }
}

TEST(Config, ValuesOutOfRangeAreErrors) {
  expect_refused("default", "input.max_damaged_share", {"-0.1", "1.1", "nan"});
  expect_refused("default", "map.tile_size_m", {"0.4", "66", "nan"});
  expect_refused("default", "registration.max_points", {"-1", "10000001"});
  expect_refused("default", "registration.kernel_width_m", {"-0.1", "101", "nan"});
  expect_refused("default", "registration.voxel_m", {"-0.1", "11", "nan"});
  expect_refused("default", "local_map.max_keyframes", {"0", "1001"});
  expect_refused("default", "local_map.keyframe_distance_m", {"-1", "1001", "nan"});
  expect_refused("default", "local_map.keyframe_rotation_deg", {"0", "181", "nan"});
  expect_refused("default", "foveal.far_range_m", {"2", "1001", "inf", "nan"});
  expect_refused("default", "foveal.max_incidence_deg", {"0", "91", "nan"});
  expect_refused("default", "surface.spacing_m", {"-0.02", "0", "0.001", "1.5", "inf", "nan"});
  expect_refused("default", "surface.max_edge_m", {"-0.3", "101", "inf", "nan"});
  expect_refused("default", "surface.planar_edge_m", {"-0.3", "101", "inf", "nan"});
  expect_refused("default", "surface.planar_angle_deg", {"-1", "91", "nan"});
  expect_refused("default", "surface.max_per_pixel", {"-1", "0.05", "2000", "nan"});
  expect_refused("default", "texture.footprint_m", {"-0.1", "1.1", "nan"});
  expect_refused("default", "dynamic.range_m", {"0", "201", "nan"});
  expect_refused("default", "dynamic.free_scans", {"0", "33"});
  expect_refused("default", "fusion.submap_duration_s", {"0", "3601", "nan"});
  expect_refused("paper", "ground.sensor_height_m", {"-1", "11", "nan"});
  expect_refused("paper", "upsample.rate", {"-1", "6"});
  expect_refused("paper", "upsample.max_edge_m", {"0", "-0.3", "inf", "nan"});
  expect_refused("paper", "foveal.near_range_m", {"-1", "nan"});
  expect_refused("paper", "ray_filter.window_px", {"0", "4", "103"});
  expect_refused("paper", "ray_filter.outlier_rate", {"0", "nan"});
}

TEST(Config, SettingsOfAProgramAreChecked) {
  MapperOptions options;
  EXPECT_NO_THROW(validate(options));
  options.surface.spacing = 0;
  EXPECT_THAT(error_of([&] { validate(options); }), HasSubstr("surface.spacing_m"));
}

TEST(Config, ErrorsForKeysOfTheOtherMapperNameIt) {
  EXPECT_THAT(
      error_over("default", "[upsample]\nrate = 2"),
      AllOf(HasSubstr("my.toml:2"), HasSubstr("paper mapper"), HasSubstr("--preset paper")));
  EXPECT_THAT(error_over("paper", "[surface]\nspacing_m = 0.02"),
              AllOf(HasSubstr("default mapper"), HasSubstr("--preset default")));
}

TEST(Config, AFailedFileChangesNothing) {
  MapSettings settings;
  const std::string before = to_toml(settings);
  EXPECT_THROW(apply_config_text("[surface]\nspacing_m = 0.1\nmax_edge_m = -1.0", "x", settings),
               ConfigError);
  EXPECT_EQ(to_toml(settings), before);
}

TEST(Config, SettingsOfTheCommandLine) {
  MapSettings settings = PaperOptions();
  apply_setting("upsample.rate=3", settings);
  apply_setting("registration.method=plane", settings);  // a bare word is a string
  apply_setting("foveal.slices_deg=[[-5,5,-10,10]]", settings);
  EXPECT_EQ(settings.paper().upsample.rate, 3);
  EXPECT_EQ(settings.paper().registration, RegistrationMethod::kPointToPlane);
  EXPECT_EQ(settings.foveal().slices.size(), 1u);
  EXPECT_THROW(apply_setting("upsample.rate", settings), ConfigError);
  EXPECT_THROW(apply_setting("=3", settings), ConfigError);
  EXPECT_THROW(apply_setting("upsample.rates=3", settings), ConfigError);
  EXPECT_THROW(apply_setting("upsample.rate=ten", settings), ConfigError);
}

TEST(Config, MissingFileIsAnInputError) {
  MapSettings settings;
  EXPECT_THROW(apply_config_file("/nonexistent/fovea.toml", settings), InputError);
  EXPECT_THROW(apply_config_file("/", settings), InputError);
}

TEST(Variants, EachSetsItsRowOfThePapersTable) {
  EXPECT_EQ(variant_names().size(), 15u);
  for (int i = 0; i < 12; ++i) {
    PaperOptions options;
    options.foveal.slices = {{-0.1, 0.1, -0.1, 0.1}};
    apply_variant("E" + std::to_string(i), options);
    EXPECT_EQ(options.upsample.rate, i % 4);
    EXPECT_TRUE(options.foveal_enabled);
    EXPECT_TRUE(options.foveal.slices.empty());
    const auto expected = i < 4   ? RegistrationMethod::kGicp
                          : i < 8 ? RegistrationMethod::kPointToPoint
                                  : RegistrationMethod::kPointToPlane;
    EXPECT_EQ(options.registration, expected) << i;
    EXPECT_NO_THROW(validate(options)) << i;
  }
  PaperOptions baseline;
  apply_variant("baseline-icp", baseline);
  EXPECT_EQ(baseline.registration, RegistrationMethod::kPointToPoint);
  EXPECT_FALSE(baseline.foveal_enabled);
  EXPECT_EQ(baseline.upsample.rate, 0);
  EXPECT_THROW(apply_variant("E12", baseline), ConfigError);
}

}  // namespace fovea::config_test
