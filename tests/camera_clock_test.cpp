// The clock of a camera that is off and drifts: what a live map finds, and what its correction does
// to the colors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/map/map_store.h"
#include "fovea/pipeline/live_clocks.h"
#include "fovea/pipeline/map_drive.h"
#include "fovea/simulation/simulate.h"
#include "tests/half_size_street.h"
#include "tests/temporary_folder.h"

namespace fovea::camera_clock_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Frames of the simulated drive: those whose edges LiveClocks uses in a window.
constexpr int kUsed = CalibrationCheck::kFrames;
constexpr int kPeriod = LiveClocks::kWindow + LiveClocks::kLag;  // frames
constexpr double kOffset = 0.030;                                // s
constexpr double kDrift = 0.005 / 60;                            // s per s

/// A street. All images are later than their stamps say.
std::unique_ptr<FrameSource> simulate_street(const std::filesystem::path& folder, double late) {
  SimulationOptions options = half_size_street(kUsed);
  options.camera.trigger_delay = late;
  DriveOptions without_imu;
  without_imu.use_imu = false;
  return open_drive(simulate(options, folder), without_imu);
}

/// Passes a minute to the clocks. The frames that they use are those of the drive.
void pass_window(LiveClocks& clocks, const FrameSource& drive,
                 const std::vector<RigidMotion>& poses, int begin) {
  int next = 0;
  for (int i = begin; i < begin + LiveClocks::kWindow; ++i) {
    Frame frame;
    std::optional<FrameMotion> motion;
    if (clocks.is_due(i) && next < kUsed) {
      motion = known_motion(drive, poses, next);
      frame = std::get<Frame>(drive.load(next++));
    }
    frame.index = i;
    frame.stamp = i * kNsPerSecond / 10;
    clocks.correct(frame);
    clocks.add(frame, FrameRecord(), motion);
  }
  EXPECT_EQ(next, kUsed);
}

/// How much later the images of a frame are taken to be, s.
double correction(LiveClocks& clocks, int index) {
  Frame frame;
  frame.index = index;
  clocks.correct(frame);
  return frame.image_offsets.empty() ? 0 : frame.image_offsets.front();
}

/// A drive as a live map sees it after the first minute.
class CorrectedDrive : public FrameSource {
 public:
  CorrectedDrive(const FrameSource& drive, LiveClocks* clocks) : drive_(drive), clocks_(clocks) {}
  const DriveInfo& info() const override { return drive_.info(); }
  LoadedFrame load(int index) const override {
    Frame frame = std::get<Frame>(drive_.load(index));
    frame.index = kPeriod + index;
    if (clocks_ != nullptr) clocks_->correct(frame);
    frame.index = index;
    return frame;
  }
  std::optional<TimeNs> stamp(int index) const override { return drive_.stamp(index); }

 private:
  const FrameSource& drive_;
  LiveClocks* const clocks_;
};

/// Mean difference of the images and the map before they change it, gray values.
double texture_error(const FrameSource& drive, const std::vector<RigidMotion>& poses) {
  const TemporaryFolder folder;
  MapJob job;
  job.output = folder / "map.fovea";
  job.pose_source = PoseSource::kGiven;
  job.given_poses = poses;
  map_drive(drive, job, {});
  double sum = 0;
  int count = 0;
  for (const FrameRecord& frame : MapReader(job.output).frames()) {
    const auto error = frame.figures.find("texture_error");
    if (error == frame.figures.end() || !std::isfinite(error->second)) continue;
    sum += error->second;
    ++count;
  }
  EXPECT_GT(count, kUsed / 2);
  return sum / count;
}

}  // namespace

TEST(CameraClock, AnOffsetIsFoundAndItsCorrectionImprovesTheColors) {
  const TemporaryFolder folder;
  const auto drive = simulate_street(folder / "drive", kOffset);
  const auto poses = read_poses(folder / "drive/truth/poses.txt");
  LiveClocks clocks(drive->info(), /*compensate=*/true);
  pass_window(clocks, *drive, poses, 0);
  EXPECT_NEAR(correction(clocks, kPeriod), kOffset, 3e-3);
  EXPECT_THAT(clocks.messages().warnings, ElementsAre(HasSubstr("the clock of camera 2 is")));

  const double before = texture_error(CorrectedDrive(*drive, nullptr), poses);
  const double after = texture_error(CorrectedDrive(*drive, &clocks), poses);
  EXPECT_LT(after, 0.95 * before);
}

TEST(CameraClock, ADriftIsFollowedAndReported) {
  constexpr int kMinutes = 3;
  const TemporaryFolder folder;
  std::vector<std::unique_ptr<FrameSource>> drives;
  std::optional<LiveClocks> clocks;
  double late = 0;
  for (int minute = 0; minute < kMinutes; ++minute) {
    const auto name = folder / std::to_string(minute);
    late = kOffset + kDrift * 0.1 * kPeriod * minute;
    drives.push_back(simulate_street(name, late));
    if (!clocks) clocks.emplace(drives.front()->info(), /*compensate=*/true);
    pass_window(*clocks, *drives.back(), read_poses(name / "truth/poses.txt"), minute * kPeriod);
  }
  EXPECT_NEAR(correction(*clocks, kMinutes * kPeriod), late, 3e-3);
  const std::vector<std::string> notes = clocks->messages().notes;
  ASSERT_EQ(notes.size(), 2u);  // of the offset, and of the drift
  double ppm = 0;
  ASSERT_EQ(std::sscanf(notes.back().c_str(), "the clock of camera 2 drifts by %lf ppm", &ppm), 1);
  EXPECT_NEAR(ppm, 1e6 * kDrift, 25) << notes.back();
}

}  // namespace fovea::camera_clock_test
