#include "fovea/drive/writers/drive_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "../../../../tests/temporary_folder.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/writers/png_encode.h"
#include "fovea/errors.h"

namespace fovea::drive_writer_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

constexpr TimeNs kStart = 1'700'000'000 * kNsPerSecond, kStep = 100'000'000;

RecordedCamera front() {
  RecordedCamera camera;
  camera.name = "front";
  camera.index = 2;
  camera.optics = {24, 16, 20, 20, 11.5, 7.5, Lens()};
  camera.T_lidar_cam = exp_se3((Twist() << 0.1, 0.2, 0.3, 1, 2, 3).finished());
  return camera;
}

PointCloud points(float first_x) {
  PointCloud cloud;
  for (int i = 0; i < 5; ++i) {
    cloud.position.emplace_back(first_x + float(i), 1, -1);
    cloud.intensity.push_back(float(50 * i));
    cloud.time.push_back(0.02f * float(i) - 0.05f);
    cloud.ring.push_back(std::uint16_t(7 * i));
  }
  return cloud;
}

Image image(std::uint8_t value) {
  Image image(24, 16, 3);
  std::fill(image.data.begin(), image.data.end(), value);
  return image;
}

RigidMotion pose(int frame) {
  return exp_se3((Twist() << 0, 0, 0.1 * frame, double(frame), 0, 0).finished());
}

class DriveWriterTest : public testing::Test {
 protected:
  AdapterWriter writer(const std::vector<RecordedCamera>& cameras = {front()}) {
    return {folder_ / "drive", cameras};
  }
  TemporaryFolder folder_;
};

TEST_F(DriveWriterTest, TheDriveHasWhatWasAdded) {
  const std::filesystem::path file = folder_ / "photo";
  const std::vector<std::uint8_t> png = encode_png(image(70));
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), std::streamsize(png.size()));
  AdapterWriter writer = this->writer();
  writer.add({kStart, points(3)}, {{"front", kStart + 1, image(40)}}, pose(0));
  PointCloud with_nan = points(4);
  with_nan.position[2].x() = std::nanf("");
  writer.add({kStart + kStep, with_nan}, {{"front", kStart + kStep, image(50)}}, pose(1));
  writer.add({kStart + 2 * kStep, points(5)}, {{"front", kStart + 2 * kStep, file}}, pose(2));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "drive"));
  const DriveWriterFigures figures = writer.close();
  EXPECT_EQ(figures.scans, 3u);
  EXPECT_EQ(figures.images, 3u);
  EXPECT_EQ(figures.poses, 3u);
  EXPECT_EQ(figures.dropped.not_finite, 1u);
  EXPECT_THROW(writer.close(), std::logic_error);

  DriveOptions options;
  options.cameras = {2};
  const auto drive = open_drive(folder_ / "drive", options);
  ASSERT_EQ(drive->info().end - drive->info().begin, 3);
  const Frame first = std::get<Frame>(drive->load(0)), last = std::get<Frame>(drive->load(2));
  EXPECT_EQ(first.stamp, kStart);
  EXPECT_EQ(first.scan.position, points(3).position);
  EXPECT_EQ(first.scan.time, points(3).time);
  EXPECT_EQ(first.scan.ring, points(3).ring);
  EXPECT_FLOAT_EQ(first.scan.intensity[4], 200.0f / 255);
  EXPECT_EQ(first.images[0].data, image(40).data);
  EXPECT_EQ(last.images[0].data, image(70).data);
  EXPECT_THAT(std::get<Frame>(drive->load(1)).scan.ring, ElementsAre(0, 7, 21, 28));
  EXPECT_EQ(drive->info().calibration.cameras[0].cx, 11.5);
}

TEST_F(DriveWriterTest, SeveralLidarsHaveScansOfTheirOwn) {
  DriveWriterOptions options;
  options.first_lidar = "top";
  options.further_lidars["left"] = pose(1);
  AdapterWriter writer(folder_ / "drive", {}, options);
  for (int frame = 0; frame < 3; ++frame) {
    writer.add({kStart + frame * kStep, points(3)}, {});
    if (frame > 0) writer.add_scan("left", {kStart + frame * kStep + 1'000'000, points(5)});
  }
  EXPECT_THROW(writer.add_scan("right", {kStart, points(3)}), std::invalid_argument);
  EXPECT_THROW(writer.add_scan("top", {kStart + 9 * kStep, points(3)}), std::invalid_argument);
  EXPECT_THROW(writer.add_scan("left", {kStart, points(3)}), std::invalid_argument);
  EXPECT_EQ(writer.scans(), 3u);
  EXPECT_EQ(writer.close().scans, 5u);
  const auto drive = open_drive(folder_ / "drive", {});
  ASSERT_EQ(drive->info().lidars.size(), 2u);
  EXPECT_EQ(drive->info().lidars[1].profile.name, "left");
  EXPECT_TRUE(drive->info().lidars[1].T_lidar_sensor.isApprox(pose(1), 1e-9));
  const Frame frame = std::get<Frame>(drive->load(1));
  ASSERT_EQ(frame.scan.size(), 10u);
  EXPECT_LT((frame.scan.position[5].cast<double>() - pose(1) * points(5).position[0].cast<double>())
                .norm(),
            1e-5);
  EXPECT_EQ(std::get<Frame>(drive->load(0)).missing_scans.size(), 1u);

  AdapterWriter without_left(folder_ / "without", {}, options);
  without_left.add({kStart, points(3)}, {});
  without_left.close();
  EXPECT_EQ(std::get<Frame>(open_drive(folder_ / "without", {})->load(0)).scan.size(), 5u);

  options.first_lidar = "left";
  EXPECT_THROW(AdapterWriter(folder_ / "other", {}, options), std::invalid_argument);
}

TEST_F(DriveWriterTest, WithoutCloseNothingStays) {
  {
    AdapterWriter writer = this->writer();
    writer.add({kStart, points(3)}, {});
  }
  EXPECT_THAT(folder_.names(), IsEmpty());
}

TEST_F(DriveWriterTest, RefusesWhatIsNoFrame) {
  AdapterWriter writer = this->writer();
  writer.add({kStart, points(3)}, {{"front", kStart, image(1)}});
  const auto refuses = [&](const DriveScan& scan, const std::vector<DriveImage>& images,
                           const std::optional<RigidMotion>& T_world_lidar = std::nullopt) {
    EXPECT_THROW(writer.add(scan, images, T_world_lidar), std::invalid_argument);
  };
  const DriveScan next{kStart + kStep, points(3)};
  refuses({kStart, points(3)}, {});
  refuses(next, {{"rear", kStart + kStep, image(1)}});
  refuses(next, {{"front", kStart, image(1)}});
  refuses(next, {{"front", kStart + 2, image(1)}, {"front", kStart + 2, image(1)}});
  refuses(next, {{"front", kStart + kStep, Image(16, 24, 3)}});
  RigidMotion stretched = RigidMotion::Identity();
  stretched.linear() *= 2;
  refuses(next, {}, stretched);
  DriveScan uneven = next;
  uneven.points.time.pop_back();
  refuses(uneven, {});
  EXPECT_THROW(writer.add({kStart + kStep, PointCloud()}, {}), InputError);
  std::ofstream(folder_ / "text") << "text";
  EXPECT_THROW(writer.add(next, {{"front", kStart + kStep, folder_ / "text"}}), InputError);
  // Nothing of a refused frame stays.
  writer.add(next, {{"front", kStart + kStep, image(1)}}, pose(1));
  const DriveWriterFigures figures = writer.close();
  EXPECT_EQ(figures.scans, 2u);
  EXPECT_EQ(figures.images, 2u);
  EXPECT_EQ(figures.poses, 1u);
}

TEST_F(DriveWriterTest, RefusesCamerasThatAreNone) {
  RecordedCamera other = front();
  EXPECT_THROW(writer({front(), other}), std::invalid_argument);
  other.name = "rear";
  EXPECT_THROW(writer({front(), other}), std::invalid_argument);
  other.index = 10;
  EXPECT_THROW(writer({front(), other}), std::invalid_argument);
  other.index = 3, other.name = "../rear";
  EXPECT_THROW(writer({front(), other}), std::invalid_argument);
  AdapterWriter empty = writer();
  EXPECT_THROW(empty.close(), std::logic_error);
}

TEST_F(DriveWriterTest, ManyPointsThatCannotBeUsedAreAnError) {
  AdapterWriter writer = this->writer();
  writer.add({kStart, points(3)}, {});
  PointCloud late = points(3);
  late.time = {0, 20'000, 40'000, 60'000, 80'000};  // microseconds
  EXPECT_THAT([&] { writer.add({kStart + kStep, late}, {}); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("over 1 s off the stamp"),
                                              HasSubstr("4 of 10 points so far cannot be used"),
                                              HasSubstr("or set allow_dropped"))));
  writer.add({kStart + kStep, points(3)}, {});  // the frame was not added
  EXPECT_EQ(writer.close().dropped.total(), 0u);
}

TEST_F(DriveWriterTest, AnImageFileHasTheSizeOfItsCamera) {
  const std::filesystem::path file = folder_ / "small.png";
  const std::vector<std::uint8_t> png = encode_png(Image(8, 6, 3));
  const auto write = [&](std::size_t size) {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(png.data()), std::streamsize(size));
  };
  AdapterWriter writer = this->writer();
  const auto add = [&] { writer.add({kStart, points(3)}, {{"front", kStart, file}}); };
  write(png.size());
  EXPECT_THAT(add, ThrowsMessage<std::invalid_argument>(HasSubstr("has 8 x 6 pixels, not")));
  write(png.size() / 2);
  EXPECT_THROW(add(), InputError);
}

}  // namespace fovea::drive_writer_test
