// A map under changing light: automatic exposure over a factor of 16, vignetting, steps of the
// white balance, and two cameras of which one takes twice the light.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/program.h"

namespace fovea::one_exposure_test {

/// Small images.
const std::string kLight =
    " --set camera.width=621 --set camera.height=188 --set camera.focal=360 --set camera.cx=304.5"
    " --set camera.cy=86 --set lidar.columns=1500 --set camera.exposure=0.5"
    " --set camera.exposure_variation=1.386 --set camera.white_balance_step=0.1";

/// Simulates a drive, maps it and compares the map with the truth.
nlohmann::json exposure_of_map(const std::string& simulation, const std::string& cameras) {
  const TemporaryFolder folder;
  const auto quoted = [&](const char* name) { return "'" + (folder / name).string() + "'"; };
  std::string drive = quoted("drive");
  EXPECT_EQ(run_fovea("simulate --quiet -o " + drive + kLight + simulation).exit_code, 0);
  EXPECT_EQ(
      run_fovea("map " + drive + " -o " + quoted("map.fovea") + " --quiet --cameras " + cameras)
          .exit_code,
      0);
  EXPECT_EQ(run_fovea("evaluate " + quoted("map.fovea") + " " + drive + " --truth --cameras " +
                      cameras + " --json " + quoted("truth.json"))
                .exit_code,
            0);
  return nlohmann::json::parse(read_text(folder / "truth.json")).at("exposure");
}

TEST(OneExposure, OfAStreetThatTwoCamerasSeeUnderChangingLight) {
  const auto exposure =
      exposure_of_map(" --scene street --frames 40 --set camera.exposure_ratio=2", "2,3");
  EXPECT_LT(exposure.at("one_gain_median"), 6);
  EXPECT_LT(exposure.at("seam_p95_percent"), 3);
  EXPECT_LT(exposure.at("deviation_percent"), 4);
}

}  // namespace fovea::one_exposure_test
