#include "fovea/pipeline/recolor.h"

#include <gtest/gtest.h>

#include "../../../tests/temporary_folder.h"
#include "fovea/core/parallel.h"
#include "fovea/errors.h"
#include "fovea/pipeline/map_drive.h"
#include "fovea/pipeline/mapper_test_support.h"

namespace fovea::recolor_test {

/// A street that is mapped once.
class Recolor : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    MapJob job;
    job.output = *folder_ / "map.fovea";
    job.hold_out = HoldOut::parse("8:3");
    job.pose_source = PoseSource::kNavigation;
    job.checkpoint_frames = 2;
    job.settings = options_of_map();
    map_drive(street(), job, {});
  }
  static void TearDownTestSuite() { delete folder_; }

  /// A point filled in when the camera is near has not had the far views; recolored it has.
  static MapperOptions options_of_map() {
    MapperOptions options;
    options.surface.max_per_pixel = 0;
    return options;
  }

  RecolorFigures recolor(const MapperOptions& options, const FrameSource& source = street()) {
    RecolorJob job;
    job.output = output_;
    job.settings = options;
    job.force = true;
    return recolor_map(map_, source, job);
  }

  static TemporaryFolder* folder_;
  const MapReader map_{*folder_ / "map.fovea"};
  const std::filesystem::path output_ = *folder_ / "again.fovea";
};
TemporaryFolder* Recolor::folder_ = nullptr;

TEST_F(Recolor, PointsStayAndColoursAreTrue) {
  const RecolorFigures figures = recolor(options_of_map());
  EXPECT_EQ(figures.points, map_.size());
  EXPECT_EQ(figures.frames, 7);
  EXPECT_EQ(figures.unread, 0);
  EXPECT_EQ(figures.uncolored, map_.size() - map_.colored_size());  // no point loses its color
  const MapReader again(output_);
  EXPECT_EQ(again.frames().size(), map_.frames().size());
  EXPECT_EQ(again.meta(), map_.meta());
  const PointCloud before = map_.all_points_local(), after = again.all_points_local();
  ASSERT_EQ(before.position, after.position);
  EXPECT_EQ(before.frame, after.frame);
  EXPECT_EQ(before.incidence.size(), after.incidence.size());
  double error_before = 0, error_after = 0;
  std::size_t coloured = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (after.camera[i] == kNoCamera) {
      EXPECT_EQ(after.views[i], 0);
      continue;
    }
    EXPECT_EQ(after.camera[i], 2);
    EXPECT_GT(after.views[i], 0);
    ++coloured;
    const Eigen::Vector3f truth = synthetic_color(after.position[i].cast<double>());
    error_before += (to_float(before.color[i]) - truth).cwiseAbs().mean();
    error_after += (to_float(after.color[i]) - truth).cwiseAbs().mean();
  }
  EXPECT_EQ(coloured, after.size() - figures.uncolored);
  EXPECT_LT(error_after / double(coloured), 2.0);
  EXPECT_LT(error_after, 1.06 * error_before);
}

TEST_F(Recolor, IsTheSameAtAnyNumberOfThreadsAndAgain) {
  std::string digest;
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    recolor({});
    if (digest.empty()) digest = MapReader(output_).digest();
    EXPECT_EQ(MapReader(output_).digest(), digest) << threads;
  }
  // A recolored map recolored.
  RecolorJob job;
  job.output = *folder_ / "third.fovea";
  recolor_map(MapReader(output_), street(), job);
  EXPECT_EQ(MapReader(job.output).digest(), digest);
}

TEST_F(Recolor, OtherSettingsGiveOtherColours) {
  MapperOptions near;
  near.foveal.far_range = 8;
  near.foveal.periphery_range = 0;
  const RecolorFigures figures = recolor(near);
  EXPECT_EQ(figures.points, map_.size());
  EXPECT_GT(figures.uncolored, figures.points / 20);  // seen from farther away alone
  EXPECT_NE(MapReader(output_).meta().at("config"), map_.meta().at("config"));
}

/// Some frames can no longer be read, one image is black.
class Worn : public SyntheticDrive {
 public:
  Worn() : SyntheticDrive(street_scene(), 8, 0.8) {}
  LoadedFrame load(int index) const override {
    if (index == 5) return SkippedFrame{index, SkipReason::kMissingScan, ""};
    LoadedFrame result = SyntheticDrive::load(index);
    if (index == 6) std::ranges::fill(std::get<Frame>(result).images[0].data, std::uint8_t{0});
    return result;
  }
};

TEST_F(Recolor, ADriveWithoutTheFramesIsRefusedAndNothingIsWritten) {
  class Gone : public Worn {
    LoadedFrame load(int index) const override {
      return SkippedFrame{index, SkipReason::kMissingScan, ""};
    }
  };
  RecolorJob job;
  job.output = *folder_ / "never.fovea";
  EXPECT_THROW(recolor_map(map_, Gone(), job), InputError);
  EXPECT_FALSE(std::filesystem::exists(job.output));
}

TEST_F(Recolor, TellsOfImagesThatAreNotToBeHad) {
  const RecolorFigures figures = recolor({}, Worn());
  EXPECT_EQ(figures.frames, 6);
  EXPECT_EQ(figures.unread, 1);
  EXPECT_EQ(figures.images_left_out, 1);
}

}  // namespace fovea::recolor_test
