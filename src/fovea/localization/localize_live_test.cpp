#include "fovea/localization/localize_live.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "../../../tests/temporary_folder.h"
#include "fovea/core/angle.h"
#include "fovea/drive/live/test_live_drive.h"
#include "fovea/errors.h"
#include "fovea/localization/localize_drive.h"
#include "fovea/localization/test_visit.h"

namespace fovea::localize_live_test {

using test::LiveData;
using test::Visit;
using testing::HasSubstr;
using enum LocalizationState;

namespace {

/// Of the map's frame, whose axes point east, north and up.
constexpr GeodeticPoint kMapOrigin{49, 8.4, 110};

/// Scans of a vehicle, with positions that are off by a meter, 20 times a second.
LiveData data_of(const Visit& visit) {
  LiveData data;
  data.drive.lidar.sweep_compensated = true;
  const LocalTangentPlane plane(kMapOrigin);
  const DriveInfo& info = visit.info();
  for (int i = 0; i < info.end; ++i) {
    const Frame frame = std::get<Frame>(visit.load(i));
    data.scans.push_back({"", test::kLiveStart + frame.stamp, frame.scan});
  }
  const TimeNs end = Visit::stamp_of(info.end - 1) + kNsPerSecond / 10;
  for (TimeNs time = kNsPerSecond / -40; time < end; time += kNsPerSecond / 20) {
    const RigidMotion T_local_lidar = info.navigation->at(time).value();
    RecordedPosition& position = data.positions.emplace_back();
    position.time = test::kLiveStart + time;
    position.antenna = plane.to_geodetic(T_local_lidar.translation());
    const Eigen::Vector3d ahead = T_local_lidar.linear().col(0);
    position.roll_pitch_yaw = Eigen::Vector3d(0, 0, std::atan2(ahead.y(), ahead.x()));
  }
  return data;
}

/// The oldest scan is never dropped, and no scan lacks positions that come a little later.
LiveOptions all_data() {
  LiveOptions options;
  options.drive.use_images = false;
  options.expects_navigation = true;
  options.waits = true;
  options.max_wait = options.longest_beginning = 60;
  return options;
}

void expect_equal(const std::vector<Localization>& live, const std::vector<Localization>& file) {
  ASSERT_EQ(live.size(), file.size());
  for (std::size_t i = 0; i < live.size(); ++i) {
    EXPECT_EQ(live[i].index, file[i].index);
    EXPECT_EQ(live[i].stamp, file[i].stamp);
    EXPECT_EQ(live[i].state, file[i].state) << i;
    EXPECT_EQ(live[i].T_local_lidar.matrix(), file[i].T_local_lidar.matrix()) << i;
    EXPECT_EQ(live[i].covariance, file[i].covariance) << i;
    EXPECT_EQ(live[i].health, file[i].health) << i;
    EXPECT_EQ(live[i].found, file[i].found) << i;
  }
}

}  // namespace

class LocalizeLive : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    test::map_scene(town_scene(), *folder_ / "map.fovea");
  }
  static void TearDownTestSuite() { delete folder_; }

  std::unique_ptr<SurfaceSource> map() const { return map_surface_source(map_); }

  static std::string drive_toml() {
    LiveData sensors;
    sensors.drive.lidar.sweep_compensated = true;
    return fovea::drive_toml(sensors.drive);
  }

  /// Localizes data as they come.
  LocalizedLive localize(const LiveData& data, const LiveLocalizationJob& job,
                         const LiveOptions& options = all_data()) const {
    LiveSource source(data.write(*folder_ / "sensors"), options);
    const std::jthread sensors([&] {
      for (const auto& [stamp, call] : data.calls()) call(source);
      source.close();
    });
    return localize_live(source, map(), job);
  }

  static TemporaryFolder* folder_;
  const MapReader map_{*folder_ / "map.fovea"};
};
TemporaryFolder* LocalizeLive::folder_ = nullptr;

TEST_F(LocalizeLive, ThePosesAreThoseOfTheDrive) {
  const Visit visit(town_scene(), 1.5, 0.7, 16);
  const LiveData data = data_of(visit);
  data.write(*folder_ / "drive");
  DriveOptions options;
  options.use_images = false;
  const auto drive = open_drive(*folder_ / "drive", options);
  for (const LiveGuess guess : {LiveGuess::kNavigation, LiveGuess::kFirst}) {
    LocalizationJob of_file;
    if (guess == LiveGuess::kNavigation) {
      of_file.guess.trajectory = navigation_in_local(drive->info(), kMapOrigin);
      ASSERT_TRUE(of_file.guess.trajectory);
    }
    LiveLocalizationJob job;
    job.guess = guess;
    job.map_origin = kMapOrigin;
    std::vector<int> localized;
    job.on_localized = [&](const Localization& frame) { localized.push_back(frame.index); };
    const LocalizedLive live = localize(data, job);
    EXPECT_EQ(live.guess, guess);
    EXPECT_EQ(live.count(kLocalized), 16);
    EXPECT_EQ(localized.size(), 16u);
    expect_equal(live.frames, localize_drive(*drive, map(), of_file, [](int, int) {}).frames);
  }
}

TEST_F(LocalizeLive, NavigationThatComesWithTheFramesFindsThePlaceAgain) {
  // Between frames 11 and 18 there are no scans. The vehicle is then 8 m ahead, which is more than
  // is searched without navigation.
  constexpr int kBegin = 12, kEnd = 18;
  Visit visit(town_scene(), 0.5, 0.2, 22);
  std::vector<StampedPose> navigation = visit.info().navigation->poses();
  for (std::size_t i = kBegin + 1; i < 22; ++i) {
    const RigidMotion ahead(Eigen::Translation3d(8, 0, 0));
    visit.T_local_lidar[i] = ahead * visit.T_local_lidar[i];
    navigation[i].T_local_body = ahead * navigation[i].T_local_body;
  }
  visit.editable_info().navigation = Trajectory(navigation);
  LiveData data = data_of(visit);
  data.scans.erase(data.scans.begin() + kBegin, data.scans.begin() + kEnd);
  LiveLocalizationJob job;
  job.map_origin = kMapOrigin;
  const LocalizedLive live = localize(data, job);
  EXPECT_EQ(live.guess, LiveGuess::kNavigation);
  ASSERT_EQ(live.frames.size(), 16u);
  for (const Localization& frame : live.frames) {
    ASSERT_EQ(frame.state, kLocalized) << frame.index;
    const int scan = frame.index < kBegin ? frame.index : frame.index + kEnd - kBegin;
    const RigidMotion error =
        visit.T_local_lidar[std::size_t(scan)].inverse() * frame.T_local_lidar;
    EXPECT_LT(error.translation().norm(), 0.05) << frame.index;
  }
}

TEST_F(LocalizeLive, APlaceOfTheFirstScanIsUsed) {
  const Visit visit(town_scene(), 9, 0.2, 3);
  LiveLocalizationJob job;
  job.guess = LiveGuess::kFirst;
  job.first = visit.T_local_lidar.front() * Eigen::Translation3d(1, 0.5, 0);
  EXPECT_EQ(localize(data_of(visit), job).frames.front().state, kLocalized);
  job.first.reset();  // the map's first place is tried first, and is too far away
  EXPECT_EQ(localize(data_of(visit), job).frames.front().state, kLost);
}

TEST_F(LocalizeLive, AStopClosesTheSourceAndKeepsWhatCame) {
  const Visit visit(town_scene(), 0.5, 0.2, 40);
  const std::stop_source stop;
  LiveLocalizationJob job;
  job.stop = stop.get_token();
  int last = -1;
  job.on_localized = [&](const Localization& frame) {
    last = frame.index;
    if (frame.index == 2) stop.request_stop();
  };
  LiveOptions options = all_data();
  options.first_scans = options.max_scans = 2;
  const LocalizedLive live = localize(data_of(visit), job, options);
  EXPECT_GE(live.frames.size(), 3u);
  EXPECT_LT(live.frames.size(), 40u);
  EXPECT_EQ(live.frames.back().index, last);
  EXPECT_EQ(live.count(kLocalized), int(live.frames.size()));
}

TEST_F(LocalizeLive, AStopBeforeTheFirstScanIsAnError) {
  LiveSource source(drive_toml(), all_data());
  const std::stop_source stop;
  LiveLocalizationJob job;
  job.stop = stop.get_token();
  stop.request_stop();
  EXPECT_THROW(localize_live(source, map(), job), InputError);
}

TEST_F(LocalizeLive, WithoutCoordinatesThereIsNoNavigation) {
  const LiveData data = data_of(Visit(town_scene(), 0.5, 0.2, 3));
  LiveLocalizationJob job;
  EXPECT_EQ(localize(data, job).guess, LiveGuess::kFirst);
  job.guess = LiveGuess::kNavigation;
  try {
    localize(data, job);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no navigation to guess by"));
  }
}

TEST_F(LocalizeLive, AfterTenMinutesWithoutAPoseNavigationCountsAsAtTheBeginning) {
  Visit visit(town_scene(), 0.5, 11, 2);
  LocalizationGuess guess;
  guess.trajectory = Trajectory({visit.info().navigation->poses().front()});
  Localizer localizer(map_, visit.info(), guess);
  EXPECT_EQ(localizer.localize(std::get<Frame>(visit.load(0))).state, kLocalized);
  const RigidMotion T_local_lidar = visit.info().navigation->poses().back().T_local_body;
  TimeNs time = 0;
  while (time < 700 * kNsPerSecond) {
    time += kNsPerSecond;
    localizer.add_navigation({{time, T_local_lidar}});
  }
  Frame frame = std::get<Frame>(visit.load(1));
  frame.stamp = time;
  const Localization found = localizer.localize(frame);
  ASSERT_EQ(found.state, kLocalized);
  const RigidMotion error = visit.T_local_lidar.back().inverse() * found.T_local_lidar;
  EXPECT_LT(error.translation().norm(), 0.05);
}

TEST_F(LocalizeLive, AGuessWithoutATrajectoryIsNotContinued) {
  const Visit visit(town_scene(), 0.5, 0.2, 1);
  Localizer localizer(map_, visit.info(), {});
  EXPECT_THROW(localizer.add_navigation(visit.info().navigation->poses()), std::invalid_argument);
}

}  // namespace fovea::localize_live_test
