// The real drive, end to end, with bounds on what comes out.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/kitti_sample.h"
#include "tests/program.h"

namespace fovea::sample_drive_test {

class SampleDrive : public testing::Test {
 protected:
  /// Maps the sample with `options` and scores it; returns the report's and the scores' JSON
  /// joined.
  nlohmann::json map_and_score(const std::filesystem::path& drive, const std::string& options,
                               const std::string& protocol) const {
    const auto map = own_ / "map.fovea", report = own_ / "map.json", scores = own_ / "scores.json";
    const ProgramRun mapped =
        run_fovea(fmt::format("map '{}' -o '{}' --report '{}' --force {}", drive.string(),
                              map.string(), report.string(), options));
    EXPECT_EQ(mapped.exit_code, 0) << mapped.err;
    const ProgramRun scored =
        run_fovea(fmt::format("evaluate '{}' '{}' --protocol {} --json '{}'", map.string(),
                              drive.string(), protocol, scores.string()));
    EXPECT_EQ(scored.exit_code, 0) << scored.err;
    nlohmann::json both = nlohmann::json::parse(read_text(report));
    both["evaluate"] = nlohmann::json::parse(read_text(scores));
    return both;
  }
  TemporaryFolder own_;
};

TEST_F(SampleDrive, DefaultPresetOnHeldOutFrames) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  const auto json = map_and_score(drive, "--hold-out 8:4", "held-out");
  EXPECT_EQ(json["map"]["frames"], 45);
  EXPECT_EQ(json["map"]["frames_held_out"], 6);
  EXPECT_EQ(json["map"]["registrations_failed"], 0);
  EXPECT_LT(json["map"]["peak_rss_mb"], 1024);
  // KITTI's calibration is good to a pixel, and scanner and cameras are triggered together.
  const auto& calibration = json["map"]["calibration"].at(0);
  EXPECT_EQ(calibration["off_by_a_pixel"], false);
  for (int k = 0; k < 3; ++k) EXPECT_LT(std::abs(double(calibration["rotation_deg"].at(k))), 0.15);
  EXPECT_LT(std::abs(double(calibration["time_offset_ms"])), 5);
  const auto& scores = json["evaluate"];
  EXPECT_LE(scores["te_cross_mean"], 16.2);
  EXPECT_GE(scores["te_cross_within_20"], 0.78);
  EXPECT_LE(scores["te_predicted_mean"], 16.4);
  EXPECT_GE(scores["sharpness"], 0.85);
  EXPECT_LE(scores["me_mean"], 0.016);
  EXPECT_GE(scores["coverage_5cm"], 0.972);
  EXPECT_GE(scores["coverage_20cm"], 0.98);
  EXPECT_LE(scores["free_space_violations"], 0.021);
  // Every key that the contract names is there.
  for (const char* key :
       {"protocol", "cameras", "points", "me_mean", "me_std", "te_mean", "te_std", "te_median",
        "te_within_20", "te_predicted_mean", "te_predicted_within_20", "te_gain_mean",
        "te_gain_within_20", "free_space_violations", "sharpness", "mtme", "coverage_5cm",
        "coverage_20cm", "density_per_m2"}) {
    EXPECT_TRUE(scores.contains(key)) << key;
  }
}

// The paper's best row, the paper's way (in-sample).
TEST_F(SampleDrive, VariantE6InSample) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  const auto scores = map_and_score(drive, "--variant E6", "in-sample")["evaluate"];
  EXPECT_LE(scores["me_mean"], 0.010);
  EXPECT_LE(scores["te_mean"], 8.3);
  EXPECT_LE(scores["mtme"], 0.20);
}

TEST_F(SampleDrive, BaselineShowsThePapersUncolouredPoints) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  const auto scores =
      map_and_score(drive, "--variant baseline-gicp --frames 0:12", "in-sample-nav")["evaluate"];
  EXPECT_GT(scores["me_mean"], 0.001);  // navigation places the scans elsewhere
  EXPECT_LT(scores["paper_like"]["me_mean"], scores["me_mean"]);
}

TEST_F(SampleDrive, PosesFollowTheStreet) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  const auto map = own_ / "map.fovea", poses = own_ / "poses.txt";
  ASSERT_EQ(
      run_fovea("map '" + drive.string() + "' -o " + map.string() + " --frames 5:15").exit_code, 0);
  ASSERT_EQ(run_fovea("export " + map.string() + " " + poses.string() + " --format kitti-poses")
                .exit_code,
            0);
  std::istringstream lines(read_text(poses));
  std::vector<double> last;
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    std::istringstream words(line);
    const std::vector<double> pose{std::istream_iterator<double>(words), {}};
    ASSERT_EQ(pose.size(), 12u);
    if (!last.empty()) {
      const double step = std::hypot(pose[3] - last[3], pose[7] - last[7], pose[11] - last[11]);
      EXPECT_GT(step, 1.0);  // 10.5 m/s
      EXPECT_LT(step, 1.25);
    }
    last = pose;
  }
  EXPECT_EQ(count, 10);
}

TEST_F(SampleDrive, UpsamplingCountsOfTheRealScan) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  const double expected[] = {19329, 31788, 68777, 178660};
  for (int rate = 0; rate <= 3; ++rate) {
    const ProgramRun run = run_fovea(fmt::format(
        "upsample '{}' '{}' '{}' --rate {}",
        (drive / "velodyne_points/data/0000000030.bin").string(), drive.parent_path().string(),
        (own_ / fmt::format("{}.ply", rate)).string(), rate));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto after = std::stod(run.out.substr(run.out.find("view, ") + 6));
    EXPECT_NEAR(after / expected[rate], 1, 0.03) << rate;
  }
}

TEST_F(SampleDrive, BothColourCamerasAndTheGreyOnesNames) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  const auto map = own_ / "map.fovea";
  ASSERT_EQ(
      run_fovea("map '" + drive.string() + "' -o " + map.string() + " --frames 0:4 --cameras 2,3")
          .exit_code,
      0);
  const auto info = nlohmann::json::parse(run_fovea("info --json " + map.string()).out);
  EXPECT_EQ(info["meta"]["cameras"], "2,3");
  const ProgramRun grey = run_fovea("map '" + drive.string() + "' -o x.fovea --cameras 0");
  EXPECT_EQ(grey.exit_code, 1);  // the sample has no grey images: said, not crashed
  EXPECT_THAT(grey.err, testing::HasSubstr("camera"));
}

}  // namespace fovea::sample_drive_test
