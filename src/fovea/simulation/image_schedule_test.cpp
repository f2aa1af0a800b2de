#include "fovea/simulation/image_schedule.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "../../../tests/temporary_folder.h"
#include "fovea/drive/drive_truth.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/nearest_images.h"
#include "fovea/errors.h"
#include "fovea/simulation/drive_texts.h"
#include "fovea/simulation/simulate.h"

namespace fovea::image_schedule_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

SimulationOptions camera_of(double rate, double phase, int frames = 40) {
  SimulationOptions options;
  options.format = DriveFormat::kGeneric;
  options.frames = frames;
  options.camera.rate = rate;
  options.camera.phase = phase;
  return options;
}

/// Of the first camera.
std::vector<std::vector<Shot>> schedule_of(const SimulationOptions& options) {
  return image_schedule(options, options.camera.cameras.front());
}

/// Stamps of the images by their number; every frame has one shot of its own.
std::map<int, TimeNs> stamps_of(const std::vector<std::vector<Shot>>& schedule) {
  std::map<int, TimeNs> stamps;
  for (const std::vector<Shot>& shots : schedule) {
    int of_frame = 0;
    for (const Shot& shot : shots) {
      of_frame += shot.is_of_frame;
      if (shot.image) {
        EXPECT_TRUE(stamps.emplace(*shot.image, shot.stamp).second);
      }
    }
    EXPECT_EQ(of_frame, 1);
  }
  EXPECT_EQ(stamps.size(), image_count(schedule));
  return stamps;
}

TEST(ImageSchedule, AnImageASweepIsTakenInItsMiddle) {
  for (const double stamp_phase : {0.0, 0.5, 1.0}) {
    SimulationOptions options = camera_of(0, 0.01, 5);
    options.lidar.stamp_phase = stamp_phase;
    const auto schedule = schedule_of(options);
    ASSERT_EQ(schedule.size(), 5u);
    for (int frame = 0; frame < 5; ++frame) {
      ASSERT_EQ(schedule[std::size_t(frame)].size(), 1u);
      const Shot& shot = schedule[std::size_t(frame)].front();
      EXPECT_EQ(shot.image, frame);
      EXPECT_TRUE(shot.is_of_frame);
      const double after = (0.5 - stamp_phase) * options.lidar.period + 0.01;
      EXPECT_NEAR(seconds(shot.stamp - stamp_of(frame, options)), after, 2e-9);
    }
  }
}

TEST(ImageSchedule, AFreeRunningCameraTakesImagesAtItsRate) {
  for (const double rate : {4.0, 9.0, 20.0, 30.0}) {
    const SimulationOptions options = camera_of(rate, 0.013);
    const auto stamps = stamps_of(schedule_of(options));
    const double length = 40 * options.lidar.period;
    EXPECT_NEAR(double(stamps.size()), rate * length, 1);
    const TimeNs first = stamps.begin()->second;
    EXPECT_GE(seconds(first - stamp_of(0, options)), -0.5 * options.lidar.period);
    for (const auto& [number, stamp] : stamps) {
      EXPECT_NEAR(seconds(stamp - first), number / rate, 2e-9);
      // One of the images is 13 ms after the middle of the first sweep.
      const double from_phase = seconds(stamp - stamp_of(0, options)) - 0.013;
      EXPECT_NEAR(std::remainder(from_phase, 1 / rate), 0, 2e-9);
    }
  }
}

TEST(ImageSchedule, CamerasCanDiffer) {
  SimulationOptions options = camera_of(20, 0.01);
  options.camera.cameras[1].rate = 5;
  options.camera.cameras[1].phase = 0.02;
  for (const std::size_t k : {0u, 1u}) {
    const SimulatedCamera& camera = options.camera.cameras[k];
    const double rate = k == 0 ? 20 : 5, phase = k == 0 ? 0.01 : 0.03;
    EXPECT_EQ(image_rate(options.camera, camera), rate);
    for (const auto& [number, stamp] : stamps_of(image_schedule(options, camera))) {
      const double from_phase = seconds(stamp - stamp_of(0, options)) - phase;
      EXPECT_NEAR(std::remainder(from_phase, 1 / rate), 0, 2e-9);
    }
  }
}

TEST(ImageSchedule, ImagesBelongToTheFramesThatTheReaderGivesThem) {
  for (const double rate : {3.0, 9.0, 9.8, 10.0, 20.0, 31.0}) {
    for (const double phase : {0.0, 0.03, 0.052, -0.4}) {
      for (const double stamp_phase : {0.0, 0.5}) {
        SimulationOptions options = camera_of(rate, phase, 60);
        options.lidar.stamp_phase = stamp_phase;
        const auto schedule = schedule_of(options);
        NumberedTimes scans, images;
        for (int frame = 0; frame < 60; ++frame) scans[frame] = stamp_of(frame, options);
        for (const auto& [number, stamp] : stamps_of(schedule)) images[number] = stamp;
        const double middle = (0.5 - stamp_phase) * options.lidar.period;
        const ImageMatches matches = match_nearest(scans, images, middle, 0.06);
        ASSERT_FALSE(matches.image_of_scan.empty());
        for (int frame = 0; frame < 60; ++frame) {
          const auto found = matches.image_of_scan.find(frame);
          for (const Shot& shot : schedule[std::size_t(frame)]) {
            if (!shot.is_of_frame) continue;
            EXPECT_EQ(shot.image.has_value(), found != matches.image_of_scan.end());
            if (shot.image) {
              EXPECT_EQ(*shot.image, found->second) << rate << ' ' << phase;
            }
          }
        }
      }
    }
  }
}

TEST(ImageSchedule, KittisCamerasAreTriggeredByTheLidar) {
  const auto error = [](double rate, double phase) -> std::string {
    SimulationOptions options = camera_of(rate, phase);
    options.format = DriveFormat::kKitti;
    try {
      options.validate();
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "no ConfigError";
  };
  EXPECT_EQ(error(0, 0), "no ConfigError");
  EXPECT_THAT(error(20, 0),
              testing::AllOf(HasSubstr("camera.rate"), HasSubstr("--format generic")));
  EXPECT_THAT(error(0, 0.01), HasSubstr("camera.phase"));
  EXPECT_THAT(error(0, 0.06), HasSubstr("-0.05 to 0.05"));
  EXPECT_THAT(error(NAN, 0), HasSubstr("camera.rate"));
  EXPECT_THAT(error(0.5, 0), HasSubstr("1 to 200 Hz"));
  SimulationOptions options;
  options.camera.cameras[1].phase = 0.01;
  EXPECT_THROW(options.validate(), ConfigError);
  options.format = DriveFormat::kGeneric;
  EXPECT_NO_THROW(options.validate());
  options.camera.phase = 0.045;  // too far together
  EXPECT_THROW(options.validate(), ConfigError);
}

/// A drive of small images on which every error is off.
SimulationOptions small_drive() {
  SimulationOptions options = simulation_options(Scene::kStreet, "none");
  options.format = DriveFormat::kGeneric;
  options.frames = 3;
  options.lidar.columns = 60;
  options.camera.cameras.resize(1);
  options.camera.width = 60;
  options.camera.height = 31;
  options.camera.focal = 40;
  options.camera.cx = 29.5;
  options.camera.cy = 14.5;
  return options;
}

TEST(FreeRunningCamera, HasTheTruePoseOfEveryImage) {
  const TemporaryFolder folder;
  SimulationOptions options = small_drive();
  options.camera.rate = 20;
  options.camera.phase = 0.004;
  options.camera.trigger_delay = 0.01;
  const fs::path drive = simulate(options, folder / "d");
  const DriveTruth truth(drive);
  std::ifstream table(drive / "truth/image_02/images.csv");
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "index,time_ns,frame,exposure,r11,r12,r13,x,r21,r22,r23,y,r31,r32,r33,z");
  int images = 0, of_frames = 0;
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  while (std::getline(table, line)) {
    std::vector<std::string> cells;
    std::stringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 16u);
    EXPECT_EQ(cells[0], std::to_string(images));
    const Eigen::Vector3d place(std::stod(cells[7]), std::stod(cells[11]), std::stod(cells[15]));
    // 9 m/s, changed by at most a quarter.
    if (images > 0) {
      EXPECT_NEAR((place - last).norm(), 0.05 * 9, 0.3 * 0.05 * 9);
    }
    last = place;
    EXPECT_TRUE(fs::exists(drive / "images/camera_2" / fmt::format("{:06d}.png", images)));
    if (!cells[2].empty()) {
      const RigidMotion& T = truth.camera(2).T_local_cam.at(std::stoul(cells[2]));
      EXPECT_LT((T.translation() - place).norm(), 1e-9);
      ++of_frames;
    }
    ++images;
  }
  EXPECT_EQ(of_frames, 3);
  // From -46 ms to 254 ms, of three sweeps from -51.7 to 258.5 ms.
  EXPECT_EQ(images, 7);
}

TEST(FreeRunningCamera, FramesWithoutAnImageHaveTheTruthOfTheirSweepsMiddle) {
  const TemporaryFolder folder;
  SimulationOptions options = small_drive();
  const fs::path each = simulate(options, folder / "each");
  options.camera.rate = 1;  // at the middle of frame 0 alone
  const fs::path drive = simulate(options, folder / "d");
  const DriveTruth all(each), truth(drive);
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_TRUE(truth.camera(2).T_local_cam[std::size_t(frame)].isApprox(
        all.camera(2).T_local_cam[std::size_t(frame)], 1e-12));
    EXPECT_EQ(truth.perfect_image(2, frame).data, all.perfect_image(2, frame).data);
  }
  EXPECT_TRUE(fs::exists(drive / "images/camera_2/000000.png"));
  EXPECT_FALSE(fs::exists(drive / "images/camera_2/000001.png"));
}

TEST(FreeRunningCamera, ADriveWithoutAnyImageIsAnError) {
  const TemporaryFolder folder;
  SimulationOptions options = small_drive();
  options.camera.rate = 1;
  options.camera.phase = 0.5;
  EXPECT_THROW(simulate(options, folder / "d"), ConfigError);
  EXPECT_FALSE(fs::exists(folder / "d"));
}

Image taken_image(const SimulationOptions& options, const fs::path& folder) {
  return read_image(simulate(options, folder) / "images/camera_2/000001.png");
}

std::vector<std::uint8_t> row_of(const Image& image, int v) {
  const std::uint8_t* begin = image.pixel(0, v);
  return {begin, begin + image.width * image.channels};
}

TEST(RollingShutter, EachRowIsTakenAtItsOwnTime) {
  const TemporaryFolder folder;
  SimulationOptions options = small_drive();
  options.scene = Scene::kTraffic;  // what moves is elsewhere in each row, too
  const Image global = taken_image(options, folder / "global");
  options.camera.trigger_delay = -0.02;
  const Image early = taken_image(options, folder / "early");
  options.camera.trigger_delay = 0.02;
  const Image late = taken_image(options, folder / "late");
  options.camera.trigger_delay = 0;
  options.camera.rolling_shutter = 0.04;
  const Image rolling = taken_image(options, folder / "rolling");
  EXPECT_NE(row_of(early, 30), row_of(late, 30));
  EXPECT_EQ(row_of(rolling, 0), row_of(early, 0));
  EXPECT_EQ(row_of(rolling, 15), row_of(global, 15));
  EXPECT_EQ(row_of(rolling, 30), row_of(late, 30));
  // The truth is that of the middle of the readout.
  EXPECT_EQ(DriveTruth(folder / "rolling").perfect_image(2, 1).data, global.data);
}

}  // namespace fovea::image_schedule_test
