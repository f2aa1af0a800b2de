// Two cameras, of which one fails: what the other sees is mapped and scored, and what is missing is
// told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "fovea/map/map_store.h"
#include "fovea/pipeline/map_drive.h"
#include "tests/kitti_writer.h"
#include "tests/program.h"

namespace fovea::missing_images_test {

using testing::HasSubstr;
using testing::Not;

constexpr int kFrames = 10, kStops = 6, kTruncated = 2, kBoth = 4;

class MissingImages : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    const ProgramRun run = run_fovea(
        fmt::format("simulate -o '{}' --frames {} --noise none --set camera.numbers=[2,3] --set "
                    "camera.width=310 --set camera.height=94 --set camera.focal=180 --set "
                    "camera.cx=152 --set camera.cy=43 --set lidar.columns=720",
                    (*scratch_ / "drive").string(), kFrames));
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  static void TearDownTestSuite() { delete scratch_; }

  /// A copy of the drive whose camera 3 stops, whose camera 2 has one truncated image, and which
  /// has a frame without any.
  void SetUp() override {
    std::filesystem::copy(*scratch_ / "drive", own_ / "drive",
                          std::filesystem::copy_options::recursive);
    drive_ = own_ / "drive/2026_01_01/2026_01_01_drive_0001_sync";
    for (int i = kStops; i < kFrames; ++i) std::filesystem::remove(image(3, i));
    std::filesystem::resize_file(image(2, kTruncated), 5000);
    std::filesystem::remove(image(2, kBoth));
    std::filesystem::remove(image(3, kBoth));
  }

  std::filesystem::path image(int camera, int frame) const {
    return drive_ / fmt::format("image_0{}/data", camera) / (kitti_stem(frame) + ".png");
  }
  std::string output() const { return (own_ / "out.fovea").string(); }
  ProgramRun map(const std::string& more) const {
    return run_fovea(fmt::format("map '{}' -o '{}' --force {}", drive_.string(), output(), more));
  }

  static TemporaryFolder* scratch_;
  TemporaryFolder own_;
  std::filesystem::path drive_;
};
TemporaryFolder* MissingImages::scratch_ = nullptr;

TEST_F(MissingImages, FramesAreMappedWithTheCamerasThatRemain) {
  const auto report = own_ / "report.json";
  const ProgramRun run = map("--cameras 2,3 --report '" + report.string() + "'");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("4 frames (the first: 6): camera 3 has no image"));
  EXPECT_THAT(run.err, HasSubstr("1 frame (the first: 2): camera 2 has no image"));
  EXPECT_THAT(run.err, HasSubstr("skipped: 1 frame (missing image)"));
  const auto figures = nlohmann::json::parse(read_text(report)).at("map");
  EXPECT_EQ(figures.at("frames"), kFrames - 1);
  EXPECT_EQ(figures.at("images_missing"), (nlohmann::json{{"2", 1}, {"3", kFrames - kStops}}));
  EXPECT_EQ(figures.at("frames_skipped"), (nlohmann::json{{"missing image", 1}}));

  const MapReader reader(output());
  for (const FrameRecord& record : reader.frames()) {
    const bool lacks = record.index == kTruncated || record.index >= kStops;
    EXPECT_EQ(record.has("images_missing"), lacks) << record.index;
    EXPECT_EQ(record.lacks_image(3), record.index >= kStops);
    EXPECT_EQ(record.lacks_image(2), record.index == kTruncated);
    EXPECT_EQ(record.status == FrameStatus::kSkipped, record.index == kBoth);
    if (lacks) {
      EXPECT_THAT(record.note, HasSubstr("gives nothing"));
    }
  }
  const PointCloud points = reader.all_points_local();
  std::set<std::pair<int, int>> sources;  // frame and camera
  for (std::size_t i = 0; i < points.size(); ++i) {
    sources.emplace(points.frame[i], points.camera[i]);
  }
  EXPECT_TRUE(sources.contains({kTruncated, 3}));
  EXPECT_TRUE(sources.contains({kFrames - 1, 2}));
  for (const auto& [frame, camera] : sources) {
    EXPECT_FALSE(frame == kTruncated && camera == 2);
    EXPECT_FALSE(frame >= kStops && camera == 3) << frame;
  }
}

TEST_F(MissingImages, OneCameraAloneSkipsItsMissingFrames) {
  const ProgramRun run = map("--cameras 3");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("skipped: 5 frames (missing image)"));
  EXPECT_THAT(run.err, Not(HasSubstr("has no image")));
}

TEST_F(MissingImages, WhatIsHeldOutIsScoredInTheCamerasThatRemain) {
  ASSERT_EQ(map("--cameras 2,3 --hold-out 1-2,7-8").exit_code, 0);
  const auto scores = own_ / "scores.json";
  const ProgramRun run =
      run_fovea(fmt::format("evaluate '{}' '{}' --json '{}' --html '{}'", output(), drive_.string(),
                            scores.string(), (own_ / "page.html").string()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 images of these frames are missing or damaged"));
  const auto score = nlohmann::json::parse(read_text(scores));
  EXPECT_EQ(score.at("frames_scored"), 4);
  EXPECT_EQ(score.at("frames").size(), 5u);  // views
  EXPECT_EQ(score.at("images_missing"), (nlohmann::json{{{"frame", 2}, {"camera", 2}},
                                                        {{"frame", 7}, {"camera", 3}},
                                                        {{"frame", 8}, {"camera", 3}}}));
  const ProgramRun rules =
      run_fovea(fmt::format("evaluate '{}' '{}' --color-rules", output(), drive_.string()));
  EXPECT_EQ(rules.exit_code, 0) << rules.err;
}

TEST_F(MissingImages, AResumedRunGivesTheSameMap) {
  DriveOptions options;
  options.cameras = {2, 3};
  const auto source = open_drive(drive_, options);
  const auto digest_after_stops = [&](const std::set<int>& stops) {
    MapJob job;
    job.output = own_ / "resumed.fovea";
    job.force = true;
    job.overlap = false;  // stops right there, with no frame under way
    for (bool complete = false; !complete; job.resume = true) {
      std::stop_source stop;
      job.stop = stop.get_token();
      complete = !map_drive(*source, job, [&](const RunProgress& progress) {
                    if (stops.contains(progress.done)) stop.request_stop();
                  }).interrupted;
    }
    return MapReader(job.output).digest();
  };
  const std::string whole = digest_after_stops({});
  EXPECT_EQ(digest_after_stops({kTruncated + 1}), whole);
  EXPECT_EQ(digest_after_stops({kBoth + 1}), whole);
  EXPECT_EQ(digest_after_stops({kTruncated + 1, kStops + 1}), whole);
}

// Images have time stamps of their own, which nothing needs; a scan without stamp is skipped.
TEST_F(MissingImages, ShortStampFiles) {
  const auto shorten = [&](const std::filesystem::path& file) {
    std::string text = read_text(file), kept;
    std::istringstream lines(text);
    for (int i = 0; i < kFrames - 2 && std::getline(lines, text); ++i) kept += text + "\n";
    write_text(file, kept);
  };
  ASSERT_EQ(map("--cameras 2,3").exit_code, 0);
  const std::string whole = run_fovea("info --digest '" + output() + "'").out;
  shorten(drive_ / "image_02/timestamps.txt");
  ASSERT_EQ(map("--cameras 2,3").exit_code, 0);
  EXPECT_EQ(run_fovea("info --digest '" + output() + "'").out, whole);
  shorten(drive_ / "velodyne_points/timestamps.txt");
  const ProgramRun run = map("--cameras 2,3");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("skipped: 2 frames (missing time stamp)"));
}

}  // namespace fovea::missing_images_test
