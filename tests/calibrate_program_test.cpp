// A calibration's faults, planted in a simulated drive, found and corrected by the program.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stop_token>

#include "fovea/pipeline/map_drive.h"
#include "tests/program.h"

namespace fovea::calibrate_program_test {

using testing::HasSubstr;
using testing::Not;

constexpr double kRotationX = 0.3, kRotationY = -0.3, kDelayMs = 20;

/// A street past a camera of half KITTI's resolution that looks somewhere else and triggers late.
class Calibrate : public testing::Test {
 protected:
  static void SetUpTestSuite() { scratch_ = new TemporaryFolder; }
  static void TearDownTestSuite() { delete scratch_; }

  /// "faulty" or "right", simulated when it is first asked for.
  static std::filesystem::path drive(const std::string& name) {
    const std::filesystem::path folder = *scratch_ / name;
    if (!std::filesystem::exists(folder)) {
      const std::string faults = name == "right" ? ""
                                                 : fmt::format(
                                                       "--set camera.rotation_error_x={} --set "
                                                       "camera.rotation_error_y={} --set "
                                                       "camera.trigger_delay={}",
                                                       kRotationX, kRotationY, kDelayMs / 1e3);
      EXPECT_EQ(run_fovea("simulate -o '" + folder.string() +
                          "' --frames 12 --set vehicle.speed=14 --set camera.numbers=[2] --set "
                          "camera.width=621 --set camera.height=187 --set camera.focal=360.75 "
                          "--set camera.cx=304.8 --set camera.cy=86.4 " +
                          faults)
                    .exit_code,
                0);
    }
    return folder / "2026_01_01/2026_01_01_drive_0001_sync";
  }
  ProgramRun map(const std::string& drive, const std::string& name, const std::string& more) const {
    return run_fovea(fmt::format("map '{}' -o '{}' --force --hold-out 8:4 --report '{}' {}",
                                 Calibrate::drive(drive).string(), path(name), path("report.json"),
                                 more));
  }
  /// What the last run told of camera 2.
  nlohmann::json told() const {
    return nlohmann::json::parse(read_text(own_ / "report.json")).at("map").at("calibration").at(0);
  }
  nlohmann::json evaluate(const std::string& name, const std::string& more = "") const {
    const ProgramRun run =
        run_fovea(fmt::format("evaluate '{}' '{}' --json '{}' {}", path(name),
                              drive("faulty").string(), path("score.json"), more));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return nlohmann::json::parse(read_text(own_ / "score.json"));
  }
  std::string path(const std::string& name) const { return (own_ / name).string(); }
  std::string digest(const std::string& name) const {
    return run_fovea("info --digest '" + path(name) + "'").out;
  }

  static TemporaryFolder* scratch_;
  TemporaryFolder own_;
};
TemporaryFolder* Calibrate::scratch_ = nullptr;

void expect_planted(const nlohmann::json& camera) {
  EXPECT_EQ(camera.at("camera"), 2);
  // Half of KITTI's pixels over a few frames: roll is the least certain.
  EXPECT_NEAR(camera.at("rotation_deg").at(0), kRotationX, 0.1);
  EXPECT_NEAR(camera.at("rotation_deg").at(1), kRotationY, 0.1);
  EXPECT_NEAR(camera.at("rotation_deg").at(2), 0, 0.1);
  for (int k = 0; k < 3; ++k) {
    const double planted[] = {kRotationX, kRotationY, 0};
    const double sigma = camera.at("rotation_sigma_deg").at(k);
    EXPECT_NEAR(camera.at("rotation_deg").at(k), planted[k], 3 * sigma) << k;
  }
  EXPECT_NEAR(camera.at("time_offset_ms"), kDelayMs, 3);
  EXPECT_GT(camera.at("pixels"), 1.5);
  EXPECT_EQ(camera.at("off_by_a_pixel"), true);
}

TEST_F(Calibrate, WarnsOfAFaultAndNotWithoutOne) {
  const ProgramRun run = map("faulty", "a.fovea", "");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("warning: camera 2: edges lie "));
  EXPECT_THAT(run.err, HasSubstr("--calibrate corrects this"));
  expect_planted(told());
  EXPECT_EQ(told().at("applied"), false);

  const ProgramRun right = map("right", "b.fovea", "");
  ASSERT_EQ(right.exit_code, 0) << right.err;
  EXPECT_THAT(right.out, Not(HasSubstr("warning")));
  const auto camera = told();
  EXPECT_EQ(camera.at("off_by_a_pixel"), false);
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(std::abs(double(camera.at("rotation_deg").at(k))), k < 2 ? 0.05 : 0.1);
    EXPECT_GT(camera.at("rotation_sigma_deg").at(k), 0);
  }
  EXPECT_LT(std::abs(double(camera.at("time_offset_ms"))), 3);

  ASSERT_EQ(map("faulty", "c.fovea", "--set calibration.check=false").exit_code, 0);
  EXPECT_TRUE(
      nlohmann::json::parse(read_text(own_ / "report.json")).at("map").at("calibration").empty());
}

TEST_F(Calibrate, CorrectsWhatItFinds) {
  ASSERT_EQ(map("faulty", "given.fovea", "").exit_code, 0);
  const ProgramRun run = map("faulty", "corrected.fovea", "--calibrate --threads 1");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("camera 2: corrected, edges lay "));
  expect_planted(told());
  EXPECT_EQ(told().at("applied"), true);

  // Scored under its own calibration unless told otherwise.
  const auto corrected = evaluate("corrected.fovea");
  const auto given = evaluate("given.fovea");
  EXPECT_EQ(corrected.at("calibration"), path("corrected.fovea"));
  EXPECT_EQ(given.at("calibration"), "drive");
  EXPECT_LT(corrected.at("te_mean"), 0.95 * double(given.at("te_mean")));
  const auto misplaced = evaluate("given.fovea", "--calibration '" + path("corrected.fovea") + "'");
  EXPECT_LT(corrected.at("te_mean"), 0.9 * double(misplaced.at("te_mean")));
  EXPECT_EQ(evaluate("corrected.fovea", "--calibration drive").at("calibration"), "drive");
  const ProgramRun wrong = run_fovea(fmt::format("evaluate '{0}' '{1}' --calibration '{0}'",
                                                 path("given.fovea"), drive("faulty").string()));
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("made with --calibrate"));

  const std::string one = digest("corrected.fovea");
  ASSERT_EQ(map("faulty", "corrected.fovea", "--calibrate --threads 2").exit_code, 0);
  EXPECT_EQ(digest("corrected.fovea"), one);
  EXPECT_NE(digest("given.fovea"), one);
}

// The correction is found again when a run goes on, and must be that of the run's beginning.
TEST_F(Calibrate, ResumesUnderTheSameCorrection) {
  ASSERT_EQ(map("faulty", "whole.fovea", "--calibrate").exit_code, 0);
  {
    std::stop_source stop;
    MapJob job;
    job.output = own_ / "cut.fovea";
    job.hold_out = HoldOut::parse("8:4");
    job.calibrate = true;
    job.stop = stop.get_token();
    DriveOptions options;
    options.cameras = {2};
    const auto source = open_drive(drive("faulty"), options);
    const MapSummary summary = map_drive(*source, job, [&](const RunProgress& progress) {
      if (progress.done == 7) stop.request_stop();
    });
    ASSERT_TRUE(summary.interrupted);
  }
  const auto resume = [&](const std::string& more) {
    return run_fovea(fmt::format("map '{}' -o '{}' --hold-out 8:4 --resume {}",
                                 drive("faulty").string(), path("cut.fovea"), more));
  };
  const ProgramRun without = resume("");
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_THAT(without.err, HasSubstr("calibration"));
  const ProgramRun with = resume("--calibrate");
  EXPECT_EQ(with.exit_code, 0) << with.err;
  EXPECT_EQ(digest("cut.fovea"), digest("whole.fovea"));
}

}  // namespace fovea::calibrate_program_test
