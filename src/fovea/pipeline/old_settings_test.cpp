#include "fovea/pipeline/old_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/core/angle.h"
#include "fovea/errors.h"
#include "fovea/pipeline/config.h"

namespace fovea::old_settings_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The configuration that a map of the last version stores, with the default preset.
constexpr const char* kOldDefault = R"(
[input]
max_damaged_share = 0.5
[motion]
compensate = true
interpolate_navigation = true
[refinement]
target = 'local-map'
visible_only = false
upsample_rate = 0
voxel = 0.25
max_correction_translation = 2.0
max_correction_rotation = 5.0
[ground]
method = 'height'
sensor_height = 0.0
tolerance = 0.25
ransac_iterations = 200
ransac_max_tilt = 10.0
[registration]
method = 'plane'
max_iterations = 100
max_points = 12000
max_distance = 1.0
converged_rotation = 0.0001
converged_translation = 0.001
neighbors = 10
plane_epsilon = 0.001
robust_width = 0.1
degenerate_eigenvalue = 0.01
[local_map]
max_keyframes = 10
keyframe_distance = 1.5
keyframe_rotation = 2.5
max_range = 120.0
voxel = 0.25
keyframe_overlap = 0.8
[foveal]
enabled = true
near_range = 3.0
far_range = 18.0
max_incidence = 90.0
slices = []
[surface]
spacing = 0.02
max_edge = 0.0
planar_edge = 0.0
planar_angle = 30.0
max_per_pixel = 4.0
[upsample]
rate = 2
max_edge = 0.3
[ray_filter]
mode = 'scan'
window = 5
outlier_rate = 2.0
occluding_test = true
occluded_test = true
[texture]
views = 'mean'
footprint = 0.02
sampling = 'bilinear'
[moving]
remove = true
range = 25.0
free_scans = 4
[fusion]
enabled = true
loop_closure = true
[calibration]
check = true
[map]
tile_size = 4.0
submap_duration = 2.0
)";

/// The same with the paper preset.
constexpr const char* kOldPaper = R"(
[input]
max_damaged_share = 0.5
[motion]
compensate = true
interpolate_navigation = true
[refinement]
target = 'previous-scan'
visible_only = true
upsample_rate = 2
voxel = 0.0
max_correction_translation = 2.0
max_correction_rotation = 5.0
[ground]
method = 'height'
sensor_height = 0.0
tolerance = 0.25
ransac_iterations = 200
ransac_max_tilt = 10.0
[registration]
method = 'icp'
max_iterations = 100
max_points = 0
max_distance = 1.0
converged_rotation = 0.0001
converged_translation = 0.001
neighbors = 10
plane_epsilon = 0.001
robust_width = 0.0
degenerate_eigenvalue = 0.01
[local_map]
max_keyframes = 10
keyframe_distance = 1.5
keyframe_rotation = 2.5
max_range = 120.0
voxel = 0.25
keyframe_overlap = 0.8
[foveal]
enabled = true
near_range = 3.0
far_range = 15.0
max_incidence = 90.0
slices = [[-25.0, 25.0, -20.0, -10.0], [-5.0, 5.0, -25.0, 25.0]]
[surface]
spacing = 0.0
max_edge = 0.0
planar_edge = 0.0
planar_angle = 30.0
max_per_pixel = 4.0
[upsample]
rate = 2
max_edge = 0.3
[ray_filter]
mode = 'paper'
window = 5
outlier_rate = 2.0
occluding_test = true
occluded_test = true
[texture]
views = 'first'
footprint = 0.02
sampling = 'bilinear'
[moving]
remove = false
range = 25.0
free_scans = 4
[fusion]
enabled = false
loop_closure = true
[calibration]
check = false
[map]
tile_size = 4.0
submap_duration = 2.0
)";

std::string error_over(const char* preset, const char* text) {
  try {
    MapSettings settings = load_preset(preset);
    apply_config_text(text, "my.toml", settings);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(OldSettings, AnErrorNamesTheNewKey) {
  EXPECT_THAT(error_over("default", "[surface]\nspacing = 0.02"),
              AllOf(HasSubstr("my.toml:2"), HasSubstr("key 'surface.spacing'"),
                    HasSubstr("write surface.spacing_m"), HasSubstr("fovea settings convert")));
  EXPECT_THAT(error_over("default", "foveal.camera_3_slices = []"),
              HasSubstr("write foveal.camera_3_slices_deg"));
}

TEST(OldSettings, AnErrorNamesTheMapperOfTheKey) {
  EXPECT_THAT(error_over("default", "ray_filter.window = 5"),
              AllOf(HasSubstr("paper mapper"), HasSubstr("ray_filter.window_px")));
  EXPECT_THAT(error_over("paper", "moving.remove = true"),
              AllOf(HasSubstr("default mapper"), HasSubstr("dynamic.remove")));
}

TEST(OldSettings, AnErrorNamesTheValueOfAConstant) {
  EXPECT_THAT(error_over("default", "registration.max_iterations = 50"),
              AllOf(HasSubstr("constant now (100)"), HasSubstr("remove it")));
}

TEST(OldSettings, AConvertedFileHasTheSameSettings) {
  const std::string converted = convert_settings(
      "[registration]\nmax_points = 8000\nrobust_width = 0.2\n[surface]\nspacing = 0.03\n"
      "planar_angle = 20\n[map]\nsubmap_duration = 3.0\n[foveal]\n"
      "camera_2_slices = [[-5, 5, -1, 1]]",
      "old.toml");
  EXPECT_EQ(converted,
            "mapper = \"default\"\n\n[registration]\nmax_points = 8000\nkernel_width_m = 0.2\n\n"
            "[foveal]\ncamera_2_slices_deg = [[-5.0, 5.0, -1.0, 1.0]]\n\n"
            "[surface]\nspacing_m = 0.03\nplanar_angle_deg = 20.0\n\n"
            "[fusion]\nsubmap_duration_s = 3.0\n");
  const MapSettings settings = stored_settings(converted, "converted");
  EXPECT_EQ(settings.mapper().refinement.registration.max_points, 8000);
  EXPECT_NEAR(settings.mapper().surface.planar_angle, 20 * kDegree, 1e-12);
}

TEST(OldSettings, KeysWithoutCounterpartBecomeComments) {
  const std::string converted = convert_settings(
      "surface.spacing = 0.03\nregistration.max_iterations = 50\n"
      "ray_filter.window = 7",
      "old.toml");
  EXPECT_THAT(converted, HasSubstr("# registration.max_iterations = 50: a constant now (100)\n"));
  EXPECT_THAT(converted, HasSubstr("# ray_filter.window = 7: ray_filter.window_px of the paper "));
  EXPECT_THAT(converted, HasSubstr("\n[surface]\nspacing_m = 0.03\n"));
}

TEST(OldSettings, AValueOfSeveralLinesStaysInItsComment) {
  const std::string converted = convert_settings("ray_filter.mode = \"a\\nb = 1\"", "old.toml");
  EXPECT_EQ(convert_settings(converted, "again"), "mapper = \"default\"\n");
}

TEST(OldSettings, TheMapperFollowsFromTheValues) {
  const auto is_paper = [](const char* text) {
    return convert_settings(text, "old.toml").find("mapper = \"paper\"") != std::string::npos;
  };
  EXPECT_TRUE(is_paper("refinement.target = \"previous-scan\""));
  EXPECT_TRUE(is_paper("surface.spacing = 0.0"));
  EXPECT_TRUE(is_paper("foveal.enabled = false"));
  EXPECT_TRUE(is_paper("upsample.rate = 3"));
  EXPECT_FALSE(is_paper("upsample.rate = 3\nsurface.spacing = 0.02"));
  EXPECT_FALSE(is_paper("refinement.target = \"local-map\""));
  EXPECT_FALSE(is_paper(""));
}

TEST(OldSettings, TodaysSettingsConvertToThemselves) {
  for (const char* preset : {"default", "paper", "realtime"}) {
    const std::string text = to_toml(load_preset(preset));
    EXPECT_EQ(convert_settings(text, preset), text);
  }
}

TEST(OldSettings, AnUnknownKeyIsAnError) {
  try {
    convert_settings("[surface]\nspacng = 1", "old.toml");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("old.toml:2"), HasSubstr("surface.spacng")));
  }
}

TEST(OldSettings, TheConfigurationOfAnEarlierMapIsRead) {
  MapSettings expected = load_preset("default");
  apply_setting("foveal.periphery_range_m=0", expected);
  apply_setting("dynamic.range_m=25", expected);
  apply_setting("texture.footprint_m=0.02", expected);
  EXPECT_EQ(to_toml(stored_settings(kOldDefault, "map")), to_toml(expected));
  EXPECT_EQ(to_toml(stored_settings(kOldPaper, "map")), to_toml(load_preset("paper")));
}

}  // namespace fovea::old_settings_test
