#include "fovea/pipeline/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "fovea/base/errors.h"

namespace fovea::config_test {

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

TEST(Config, DefaultPresetStatesTheLibrarysDefaults) {
  EXPECT_EQ(to_toml(load_preset("default")), to_toml(MapperOptions{}));
}

TEST(Config, ResolvedConfigurationReadsBack) {
  MapperOptions options = load_preset("paper");
  options.camera_slices[3] = {{-0.1, 0.1, -0.3, 0.2}};
  options.refinement.registration.method = RegistrationMethod::kPointToPlane;
  options.ray_filter.window = 7;
  const std::string text = to_toml(options);
  MapperOptions back;
  apply_config_text(text, "resolved", back);
  EXPECT_EQ(to_toml(back), text);
  EXPECT_EQ(back.ray_filter.window, 7);
  ASSERT_EQ(back.camera_slices.count(3), 1u);
  EXPECT_NEAR(back.camera_slices[3][0].elevation_min, -0.3, 1e-12);
}

TEST(Config, DegreesBecomeRadians) {
  MapperOptions options;
  apply_config_text("[foveal]\nmax_incidence = 70\nslices = [[-25, 25, -20.5, -10]]", "x", options);
  EXPECT_NEAR(options.foveal.max_incidence, 70 * std::numbers::pi / 180, 1e-12);
  ASSERT_EQ(options.foveal.slices.size(), 1u);
  EXPECT_NEAR(options.foveal.slices[0].elevation_min, -20.5 * std::numbers::pi / 180, 1e-12);
}

TEST(Config, ErrorsNameFileLineAndKey) {
  const auto error = [](const char* text) {
    return error_of([&] {
      MapperOptions options;
      apply_config_text(text, "my.toml", options);
    });
  };
  EXPECT_THAT(error("[ray_filter]\nwindw = 5"),
              testing::AllOf(HasSubstr("unknown key"), HasSubstr("my.toml:2"),
                             HasSubstr("ray_filter.windw")));
  EXPECT_THAT(error("[ray_filter]\n\nwindow = 5.5"),
              testing::AllOf(HasSubstr("wrong type"), HasSubstr("my.toml:3"), HasSubstr("whole")));
  EXPECT_THAT(
      error("[ray_filter]\nwindow = 4"),
      testing::AllOf(HasSubstr("my.toml:2"), HasSubstr("ray_filter.window"), HasSubstr("odd")));
  EXPECT_THAT(error("[registration]\nmethod = \"icpp\""),
              testing::AllOf(HasSubstr("icpp"), HasSubstr("'plane'"), HasSubstr("my.toml:2")));
  EXPECT_THAT(error("[upsample]\nrate = 2\nmax_edge = \"far\""), HasSubstr("my.toml:3"));
  EXPECT_THAT(error("[upsample\nrate = 2"), HasSubstr("my.toml:1"));
  EXPECT_THAT(error("[foveal]\nslices = [[1, 2, 3]]"), HasSubstr("foveal.slices"));
  EXPECT_THAT(error("upsample = 3"), HasSubstr("unknown key"));
}

TEST(Config, AFailedFileChangesNothing) {
  MapperOptions options;
  const std::string before = to_toml(options);
  EXPECT_THROW(apply_config_text("[upsample]\nrate = 3\nmax_edge = -1.0", "x", options),
               ConfigError);
  EXPECT_EQ(to_toml(options), before);
}

TEST(Config, SettingsOfTheCommandLine) {
  MapperOptions options;
  apply_setting("upsample.rate=3", options);
  apply_setting("registration.method=plane", options);  // a bare word is a string
  apply_setting("foveal.slices=[[-5,5,-10,10]]", options);
  EXPECT_EQ(options.upsample.rate, 3);
  EXPECT_EQ(options.refinement.registration.method, RegistrationMethod::kPointToPlane);
  EXPECT_EQ(options.foveal.slices.size(), 1u);
  EXPECT_THROW(apply_setting("upsample.rate", options), ConfigError);
  EXPECT_THROW(apply_setting("=3", options), ConfigError);
  EXPECT_THROW(apply_setting("upsample.rates=3", options), ConfigError);
  EXPECT_THROW(apply_setting("upsample.rate=ten", options), ConfigError);
}

TEST(Config, MissingFileIsAnInputError) {
  MapperOptions options;
  EXPECT_THROW(apply_config_file("/nonexistent/fovea.toml", options), InputError);
  EXPECT_THROW(apply_config_file("/", options), InputError);
}

TEST(Variants, EachSetsItsRowOfThePapersTable) {
  EXPECT_EQ(variant_names().size(), 15u);
  for (int i = 0; i < 12; ++i) {
    MapperOptions options;
    apply_variant("E" + std::to_string(i), options);
    EXPECT_EQ(options.upsample.rate, i % 4);
    EXPECT_EQ(options.refinement.upsample_rate, i % 4);
    EXPECT_TRUE(options.refinement.visible_only);
    EXPECT_EQ(options.refinement.voxel, 0);
    EXPECT_TRUE(options.foveal_enabled);
    EXPECT_EQ(options.ray_filter.mode, RayFilterMode::kPaper);
    const auto expected = i < 4   ? RegistrationMethod::kGicp
                          : i < 8 ? RegistrationMethod::kPointToPoint
                                  : RegistrationMethod::kPointToPlane;
    EXPECT_EQ(options.refinement.registration.method, expected) << i;
    EXPECT_NO_THROW(options.validate());
  }
  MapperOptions baseline;
  apply_variant("baseline-icp", baseline);
  EXPECT_EQ(baseline.refinement.registration.method, RegistrationMethod::kPointToPoint);
  EXPECT_FALSE(baseline.foveal_enabled);
  EXPECT_FALSE(baseline.refinement.visible_only);
  EXPECT_EQ(baseline.ray_filter.mode, RayFilterMode::kOff);
  EXPECT_EQ(baseline.upsample.rate, 0);
  EXPECT_THROW(apply_variant("E12", baseline), ConfigError);
}

}  // namespace fovea::config_test
