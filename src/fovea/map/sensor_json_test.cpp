#include "fovea/map/sensor_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "../../../tests/sample_map.h"

namespace fovea::sensor_json_test {

SensorProfile read_back(const SensorProfile& profile) {
  auto read = sensor_profile_from_json(to_json(profile));
  EXPECT_TRUE(read) << to_json(profile);
  if (read) read->name = profile.name;
  return read.value_or(SensorProfile());
}

TEST(SensorJson, AnyProfileComesBackBitForBit) {
  EXPECT_EQ(read_back({}), SensorProfile());
  SensorProfile profile = sample_sensor().profile;
  EXPECT_EQ(read_back(profile), profile);
  profile.height.reset();
  profile.ring_elevations = {std::nextafter(0.1, 1), 5e-324, -1e300};
  profile.sweep.direction = SweepDirection::kClockwise;
  EXPECT_EQ(read_back(profile), profile);
}

TEST(SensorJson, IsAsThePageOfTheFormatStates) {
  SensorProfile profile;
  profile.ring_elevations = {0.5, -0.25};
  profile.sweep = {0.1, SweepDirection::kCounterclockwise, 0.75, 1};
  profile.height = 2;
  EXPECT_EQ(to_json(profile),
            "{\"ring_elevations_rad\":[0.5,-0.25],\"ring_spacing_rad\":0,"
            "\"point_spacing_rad\":0,\"sweep_period_s\":0.1,\"sweep_start_azimuth_rad\":0.75,"
            "\"sweep_stamp_phase\":1,\"range_noise_m\":0.02,"
            "\"sweep_direction\":\"counterclockwise\",\"height_m\":2}");
}

TEST(SensorJson, KeysOfLaterProgramsAreSkipped) {
  std::string json = to_json(SensorProfile());
  json.insert(1, "\"field_of_view_rad\":[1,2],\"pattern\":\"rosette\",\"returns\":2,");
  EXPECT_EQ(sensor_profile_from_json(json), SensorProfile());
}

TEST(SensorJson, RefusesWhatIsNotAProfile) {
  const std::string json = to_json(sample_sensor().profile);
  for (const std::string& damaged : {std::string(), std::string("{}"), std::string("[]"),
                                     json.substr(1), json + "x", json.substr(0, json.size() - 1)}) {
    EXPECT_FALSE(sensor_profile_from_json(damaged)) << damaged;
  }
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"counterclockwise", "left"},
           {"\"sweep_period_s\":0.05", "\"sweep_period_s\":null"},
           {"\"sweep_period_s\":0.05", "\"sweep_period_s\":\"0.05\""},
           {"\"height_m\":1.73", "\"height\":1.73"},
           {"[0.1,", "[null,"}}) {
    std::string damaged = json;
    ASSERT_NE(damaged.find(from), std::string::npos) << from;
    damaged.replace(damaged.find(from), from.size(), to);
    EXPECT_FALSE(sensor_profile_from_json(damaged)) << damaged;
  }
}

TEST(SensorJson, RefusesToWriteWhatIsNotFinite) {
  SensorProfile profile;
  profile.range_noise = std::numeric_limits<double>::infinity();
  EXPECT_THROW(to_json(profile), std::invalid_argument);
  profile = {};
  profile.height = std::nan("");
  EXPECT_THROW(to_json(profile), std::invalid_argument);
}

}  // namespace fovea::sensor_json_test
