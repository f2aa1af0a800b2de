// Scans of one drive in the map of another, through a scene whose every surface is known.
#include "fovea/localization/localizer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "../../../tests/temporary_folder.h"
#include "fovea/core/angle.h"
#include "fovea/core/parallel.h"
#include "fovea/errors.h"
#include "fovea/localization/localize_drive.h"
#include "fovea/localization/test_visit.h"
#include "fovea/map/map_surfaces.h"

namespace fovea::localizer_test {

using test::Visit;
using testing::HasSubstr;
using enum LocalizationState;

class Localize : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    mapped(town_scene(), "map.fovea");
  }
  static std::filesystem::path mapped(BoxScene scene, const std::string& name) {
    return test::map_scene(std::move(scene), *folder_ / name);
  }
  static void TearDownTestSuite() { delete folder_; }

  LocalizedDrive localize(const FrameSource& drive, LocalizationGuess guess = {},
                          const std::string& only = "") const {
    LocalizationJob job;
    job.guess = std::move(guess);
    job.only = HoldOut::parse(only);
    return localize_drive(drive, map_surface_source(map_), job, [](int, int) {});
  }
  static LocalizationGuess navigation_of(const SyntheticDrive& drive) {
    LocalizationGuess guess;
    guess.trajectory = drive.info().navigation;
    return guess;
  }
  /// Bounds that hold wherever the map is: 3 cm and 0.1 degrees.
  static void expect_true(const Localization& found, const SyntheticDrive& drive) {
    ASSERT_EQ(found.state, kLocalized) << found.index;
    const RigidMotion error =
        drive.T_local_lidar[std::size_t(found.index)].inverse() * found.T_local_lidar;
    EXPECT_LT(error.translation().norm(), 0.03) << found.index;
    EXPECT_LT(rotation_angle(error.linear()), 0.1 * kDegree) << found.index;
    EXPECT_GT(found.health, 0.6) << found.index;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(found.covariance);
    EXPECT_GT(solver.eigenvalues().minCoeff(), 0) << found.index;
    EXPECT_LT(std::sqrt(found.covariance.bottomRightCorner<3, 3>().trace()), 0.05) << found.index;
  }

  static TemporaryFolder* folder_;
  const MapReader map_{*folder_ / "map.fovea"};
};
TemporaryFolder* Localize::folder_ = nullptr;

TEST_F(Localize, EveryScanOfAnotherDriveIsFoundByItsNavigation) {
  const Visit visit(town_scene(), 1.5, 0.9, 12);
  const LocalizedDrive localized = localize(visit, navigation_of(visit));
  ASSERT_EQ(localized.frames.size(), 12u);
  for (const Localization& frame : localized.frames) expect_true(frame, visit);
  EXPECT_EQ(localized.found(), 1);
  EXPECT_TRUE(localized.frames.front().found);
}

TEST_F(Localize, WithoutAnyGuessTheMapsFirstPlacesAreTriedFirst) {
  const Visit visit(town_scene(), 0.5, 0.9, 8);
  for (const Localization& frame : localize(visit).frames) expect_true(frame, visit);
}

TEST_F(Localize, AFirstGuessNeedsNotBeGood) {
  const Visit visit(town_scene(), 5, 0.9, 6);
  LocalizationGuess guess;
  guess.first = visit.T_local_lidar.front() * Eigen::Translation3d(-2.5, 0.7, 0.2) *
                Eigen::AngleAxisd(8 * kDegree, Eigen::Vector3d::UnitZ());
  for (const Localization& frame : localize(visit, guess).frames) expect_true(frame, visit);
}

TEST_F(Localize, IsFoundAgainAfterAGap) {
  const Visit visit(town_scene(), 0.5, 0.8, 14);
  const LocalizedDrive localized = localize(visit, {}, "0-3,11-13");
  ASSERT_EQ(localized.frames.size(), 7u);
  for (const Localization& frame : localized.frames) expect_true(frame, visit);
  EXPECT_EQ(localized.found(), 2);
  EXPECT_TRUE(localized.frames[4].found);
}

TEST_F(Localize, AJumpIsFoundAndSaysNothingOfTheMotionAfterIt) {
  // The scans' sweeps would be smeared over metres by the speed of such a jump.
  Visit visit(town_scene(), 0.5, 0.6, 10);
  visit.editable_info().sweep_compensated = false;
  visit.editable_info().sweep.period = 0.001;  // these have none
  for (std::size_t i = 4; i < 10; ++i) {
    visit.T_local_lidar[i] = RigidMotion(Eigen::Translation3d(6, 0, 0)) * visit.T_local_lidar[i];
  }
  const LocalizedDrive localized = localize(visit);
  for (const Localization& frame : localized.frames) {
    expect_true(frame, visit);
    EXPECT_EQ(frame.found, frame.index == 0 || frame.index == 4) << frame.index;
  }
}

TEST_F(Localize, OutsideTheMapThereIsNoPose) {
  // Leaves the map and comes back, with navigation.
  Visit visit(town_scene(), 2, 0.9, 12);
  std::vector<StampedPose> navigation = visit.info().navigation->poses();
  for (std::size_t i = 4; i < 8; ++i) {
    const RigidMotion away(Eigen::Translation3d(0, 300, 0));
    visit.T_local_lidar[i] = away * visit.T_local_lidar[i];
    navigation[i].T_local_body = away * navigation[i].T_local_body;
  }
  visit.editable_info().navigation = Trajectory(navigation);
  const LocalizedDrive localized = localize(visit, navigation_of(visit));
  for (const Localization& frame : localized.frames) {
    if (frame.index >= 4 && frame.index < 8) {
      EXPECT_EQ(frame.state, kOutside) << frame.index;
    } else {
      expect_true(frame, visit);
    }
  }
}

TEST_F(Localize, AnotherPlaceIsNotTakenForThisOne) {
  BoxScene elsewhere;
  elsewhere.boxes = {{{-80, -30, -3}, {80, 30, -1.73}}};
  for (double x = -40; x < 60; x += 7) {
    elsewhere.boxes.push_back({{x, 9 + 2 * std::sin(x), -1.73}, {x + 3, 14, 4}});
    elsewhere.boxes.push_back({{x + 2, -13, -1.73}, {x + 4.5, -8 + 2 * std::cos(x), 5}});
  }
  const Visit visit(elsewhere, 2, 0.9, 6);
  for (const auto& guess : {LocalizationGuess(), navigation_of(visit)}) {
    for (const Localization& frame : localize(visit, guess).frames) {
      EXPECT_NE(frame.state, kLocalized) << frame.index;
      EXPECT_LT(frame.health, 0.5) << frame.index;
    }
  }
}

/// A map in place of a city that still has the cars of other days along the street.
class CityWithCars : public SurfaceSource {
 public:
  explicit CityWithCars(std::unique_ptr<SurfaceSource> map) : map_(std::move(map)) {}

  std::vector<Eigen::Vector3f> points_near(const Eigen::Vector3d& center_local,
                                           double radius) override {
    std::vector<Eigen::Vector3f> points = map_->points_near(center_local, radius);
    for (const double side : {-3.5, -2.5, 2.5, 3.5}) {
      for (double x = -20; x < 40; x += MapSurfaces::kVoxel) {
        for (double z = -1.5; z < -0.2; z += MapSurfaces::kVoxel) {
          const Eigen::Vector3d p = Eigen::Vector3d(x, side, z) - center_local;
          if (p.norm() < radius) points.push_back(p.cast<float>());
        }
      }
    }
    return points;
  }
  std::vector<FrameRecord> new_frames_near(const Eigen::Vector3d& place_local) override {
    return map_->new_frames_near(place_local);
  }
  std::vector<FrameRecord> new_frames() override { return map_->new_frames(); }
  bool is_of_many_drives() const override { return true; }

 private:
  std::unique_ptr<SurfaceSource> map_;
};

TEST_F(Localize, CarsOfOtherDaysInACityDoNotHideThePlace) {
  const Visit visit(town_scene(), 1.5, 0.9, 12);
  LocalizationJob job;
  job.guess = navigation_of(visit);
  const LocalizedDrive localized = localize_drive(
      visit, std::make_unique<CityWithCars>(map_surface_source(map_)), job, [](int, int) {});
  for (const Localization& frame : localized.frames) {
    ASSERT_EQ(frame.state, kLocalized) << frame.index;
    const RigidMotion error =
        visit.T_local_lidar[std::size_t(frame.index)].inverse() * frame.T_local_lidar;
    EXPECT_LT(error.translation().norm(), 0.05) << frame.index;
  }
}

TEST_F(Localize, ScansThatSayLittleGiveNoPose) {
  class Blind : public Visit {
   public:
    using Visit::Visit;
    std::size_t points = 0;
    LoadedFrame load(int index) const override {
      LoadedFrame result = Visit::load(index);
      PointCloud& scan = std::get<Frame>(result).scan;
      std::vector<std::uint32_t> kept;
      for (std::uint32_t i = 0; i < points; ++i) kept.push_back(i * 97 % 20'000);
      std::sort(kept.begin(), kept.end());
      scan.keep(kept);
      return result;
    }
  };
  Blind visit(town_scene(), 2, 0.9, 3);
  for (const std::size_t points : {0, 1, 200}) {
    visit.points = points;
    for (const Localization& frame : localize(visit, navigation_of(visit)).frames) {
      EXPECT_NE(frame.state, kLocalized) << points;
    }
  }
}

TEST_F(Localize, WhatTheSceneLeavesOpenTheCovarianceSays) {
  // From frame 3 on nothing but two walls is seen, which tell not how far along them one is.
  class Blinkered : public Visit {
   public:
    using Visit::Visit;
    LoadedFrame load(int index) const override {
      LoadedFrame result = Visit::load(index);
      PointCloud& scan = std::get<Frame>(result).scan;
      std::vector<std::uint32_t> kept;
      for (std::uint32_t i = 0; i < scan.size(); ++i) {
        if (index < 3 || std::abs(scan.position[i].x()) < 2.5f) kept.push_back(i);
      }
      scan.keep(kept);
      return result;
    }
  };
  BoxScene street{
      {{{-50, -6, -3}, {80, 6, -1.73}}, {{-50, 6, -3}, {80, 9, 8}}, {{-50, -9, -3}, {80, -6, 8}}}};
  for (const double x : {1.0, 3.0, 22.0, 24.0})
    street.boxes.push_back({{x, 4.5, -1.73}, {x + 0.4, 6, 3}});
  const Blinkered visit(street, 8, 0.9, 6);
  const MapReader map(mapped(street, "street.fovea"));
  LocalizationJob job;
  job.guess = navigation_of(visit);
  const LocalizedDrive localized =
      localize_drive(visit, map_surface_source(map), job, [](int, int) {});
  const auto along = [&](int i) {
    return std::sqrt(localized.frames[std::size_t(i)].covariance(3, 3));
  };
  for (int i = 0; i < 3; ++i) expect_true(localized.frames[std::size_t(i)], visit);
  for (int i = 3; i < 6; ++i) {
    const Localization& frame = localized.frames[std::size_t(i)];
    ASSERT_EQ(frame.state, kLocalized) << i;
    EXPECT_GE(frame.degenerate_directions, 1) << i;
    EXPECT_GT(along(i), 0.15) << i;
    EXPECT_LT(std::sqrt(frame.covariance(4, 4)), 0.05) << i;
    EXPECT_GT(along(i), i > 3 ? along(i - 1) : along(2)) << i;
    const RigidMotion error = visit.T_local_lidar[std::size_t(i)].inverse() * frame.T_local_lidar;
    EXPECT_LT(std::abs(error.translation().x()), 3 * along(i)) << i;
    EXPECT_LT(std::abs(error.translation().y()), 0.03) << i;
  }
}

TEST_F(Localize, IsTheSameAtAnyNumberOfThreads) {
  const Visit visit(town_scene(), 1.5, 0.9, 4);
  std::vector<Localization> once;
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    const auto frames = localize(visit, navigation_of(visit)).frames;
    if (once.empty()) once = frames;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].T_local_lidar.matrix(), once[i].T_local_lidar.matrix());
      EXPECT_EQ(frames[i].covariance, once[i].covariance);
      EXPECT_EQ(frames[i].health, once[i].health);
    }
  }
}

TEST_F(Localize, AnEmptyMapIsRefused) {
  const auto file = *folder_ / "empty.fovea";
  {
    const auto writer = MapWriter::create(file, true);
    writer->put_meta("map.tile_size_m", "4");
    writer->commit();
  }
  const MapReader empty(file);
  const Visit visit(town_scene(), 0, 1, 1);
  try {
    const Localizer localizer(empty, visit.info(), {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the map is empty"));
  }
}

TEST_F(Localize, ScansComeInTheOrderOfTime) {
  const Visit visit(town_scene(), 2, 0.9, 2);
  Localizer localizer(map_, visit.info(), navigation_of(visit));
  const Frame frame = std::get<Frame>(visit.load(1));
  EXPECT_EQ(localizer.localize(frame).state, kLocalized);
  EXPECT_THROW(localizer.localize(frame), std::invalid_argument);
  EXPECT_THROW(localizer.localize(std::get<Frame>(visit.load(0))), std::invalid_argument);
}

TEST_F(Localize, FramesWithoutAScanAreToldOf) {
  class Gappy : public Visit {
   public:
    using Visit::Visit;
    LoadedFrame load(int index) const override {
      if (index != 1) return Visit::load(index);
      return SkippedFrame{index, SkipReason::kMissingScan, "no scan 1 in the drive"};
    }
  };
  const Gappy visit(town_scene(), 2, 0.9, 4);
  const LocalizedDrive localized = localize(visit, navigation_of(visit));
  ASSERT_EQ(localized.frames.size(), 4u);
  EXPECT_EQ(localized.frames[1].state, kSkipped);
  EXPECT_EQ(localized.count(kLocalized), 3);
  ASSERT_EQ(localized.notes.size(), 1u);
  EXPECT_THAT(localized.notes.front(), HasSubstr("no scan 1"));
}

}  // namespace fovea::localizer_test
