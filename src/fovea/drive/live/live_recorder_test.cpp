#include "fovea/drive/live/live_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../../tests/file_size_limit.h"
#include "fovea/drive/live/test_live_run.h"
#include "fovea/errors.h"

namespace fovea::live_recorder_test {

using namespace test;
using testing::HasSubstr;

class LiveRecording : public testing::Test {
 protected:
  LiveOptions recording() const {
    LiveOptions options = all_data();
    options.record = root_;
    return options;
  }
  /// Plays the data with a recording.
  PlayedDrive record(const LiveData& data, const std::string& toml) const {
    LiveSource source(toml, recording());
    const std::jthread sensors([&] {
      for (const auto& [time, call] : data.calls()) call(source);
      source.close();
    });
    PlayedDrive run = read_all(source);
    source.finish_recording();
    return run;
  }

  TemporaryFolder folder_;
  std::filesystem::path root_ = folder_ / "recording";
};

TEST_F(LiveRecording, IsTheDriveOfItsFrames) {
  const LiveData data = live_car(30);
  const PlayedDrive live = record(data, data.write(folder_ / "drive"));
  expect_same(live, *open_drive(root_, all_data().drive));
}

TEST_F(LiveRecording, HasPositionsAndSeveralLidars) {
  LiveData data = live_car_by_positions(20, /*has_attitudes=*/false);
  data.drive.lidar.name = "top";
  RecordedLidar& side = data.drive.further_lidars.emplace_back();
  side.name = "side";
  for (LiveScan& scan : data.scans) scan.lidar = "top";
  for (int i = 0; i < 20; ++i) data.scans.push_back(live_scan(i, /*has_times=*/true, "side"));
  const PlayedDrive live = record(data, data.write(folder_ / "drive"));
  expect_same(live, *open_drive(root_, all_data().drive));
}

TEST_F(LiveRecording, HasPlainImagesAndLeavesOutDamagedScans) {
  LiveData data = live_car(20);
  const std::string toml = data.write(folder_ / "drive");
  for (LiveImage& image : data.images) {
    if (image.camera == "side") {
      image.content = pattern(kLiveWidth, kLiveHeight, 1);
      image.exposure.reset();
    }
  }
  data.scans[12].points.intensity.resize(2);
  data.images[15].content = "no image";
  const PlayedDrive live = record(data, toml);
  const auto drive = open_drive(root_, all_data().drive);
  EXPECT_EQ(drive->info().frames.size(), 19u);
  EXPECT_EQ(std::get<Frame>(drive->load(13)).images[0].data,
            pattern(kLiveWidth, kLiveHeight, 1).data);
  EXPECT_EQ(std::get<Frame>(drive->load(15)).missing_images.size(), 1u);
}

// The median of all delays is another one than that of the first.
TEST_F(LiveRecording, StatesTheDelaysOfItsCameras) {
  LiveData data = live_car(30);
  const std::string toml = data.write(folder_ / "drive");
  for (LiveImage& image : data.images) {
    if (image.stamp > kLiveStart + 12 * kLiveStep) image.stamp += kNsPerSecond / 250;
  }
  const PlayedDrive live = record(data, toml);
  const DriveInfo recorded = open_drive(root_, all_data().drive)->info();
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(recorded.calibration.cameras[k].image_delay,
              live.info.calibration.cameras[k].image_delay);
    EXPECT_NEAR(recorded.image_offset(k, 20), 0.004, 1e-9);
  }
}

TEST_F(LiveRecording, IsNotThereUnlessItIsFinished) {
  const LiveData data = live_car(15);
  const std::string toml = data.write(folder_ / "drive");
  {
    LiveSource source(toml, recording());
    for (const auto& [time, call] : data.calls()) {
      if (time < data.scans[12].stamp) call(source);
    }
    source.close();
    read_all(source);
  }
  EXPECT_FALSE(std::filesystem::exists(root_));
  EXPECT_FALSE(std::filesystem::exists(root_.string() + ".partial"));
}

TEST_F(LiveRecording, KeepsTheFramesBeforeTheDiskIsFull) {
  LiveData data = live_car(20);
  const std::string toml = data.write(folder_ / "drive");
  PointCloud& large = data.scans[14].points;
  for (int i = 0; i < 8; ++i) large.append(PointCloud(large));
  const FileSizeLimit limit(large.size() * 8);
  EXPECT_THROW(record(data, toml), OutputError);
  EXPECT_EQ(open_drive(root_, all_data().drive)->info().frame_count(), 14u);
}

TEST_F(LiveRecording, RefusesWhatItCannotWrite) {
  const LiveData data = live_car(1);
  std::string toml = data.write(folder_ / "drive");
  LiveOptions options = recording();
  options.record = folder_ / "drive";
  EXPECT_THROW(LiveSource(toml, options), OutputError);
  const std::string lidar = "[lidar]\n";
  toml.replace(toml.find(lidar), lidar.size(), lidar + "folder = \"scans\"\n");
  EXPECT_THAT(error_of<ConfigError>([&] { LiveSource(toml, recording()); }),
              HasSubstr("lidar.folder"));
}

// Memory is bounded: stamps are in the folder, and no longer in the writer.
TEST_F(LiveRecording, StampsAreWrittenAsTheyCome) {
  GenericDriveWriter writer(root_);
  const LiveData data = live_car(3);
  const auto write = [&](int i) {
    writer.write_scan(i, 100 + i, data.scans[std::size_t(i)].points);
    writer.write_encoded_image("front", i, 200 + i, live_png(i), ".png");
  };
  const auto table = [&](const char* folder) {
    return read_text(writer.folder() / folder / "stamps.csv");
  };
  write(0);
  write(1);
  writer.flush_stamps();
  EXPECT_EQ(table("lidar"), "index,time_ns\n0,100\n1,101\n");
  EXPECT_EQ(table("images/front"), "index,time_ns,exposure_s\n0,200,\n1,201,\n");
  write(2);
  writer.set_exposure("front", 2, 0.01);
  writer.flush_stamps();
  EXPECT_EQ(table("lidar"), "index,time_ns\n0,100\n1,101\n2,102\n");
  EXPECT_EQ(table("images/front"), "index,time_ns,exposure_s\n0,200,\n1,201,\n2,202,0.01\n");
}

}  // namespace fovea::live_recorder_test
