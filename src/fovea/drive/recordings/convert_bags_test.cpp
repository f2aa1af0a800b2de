#include "fovea/drive/recordings/convert_bags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../../../../tests/mcap_writer.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/recordings/ros_messages.h"
#include "fovea/drive/recordings/test_messages.h"
#include "fovea/errors.h"

namespace fovea::convert_bags_test {

using namespace test_messages;

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

enum Topic { kPoints = 1, kRaw, kCompressed, kInfo, kStatic };

class ConvertBags : public testing::Test {
 protected:
  ConvertBags() {
    announce(kPoints, "/points", ros::kPointCloud);
    announce(kRaw, "/front/image_raw", ros::kImage);
    announce(kCompressed, "/front/image_raw/compressed", ros::kCompressedImage);
    announce(kInfo, "/front/camera_info", ros::kCameraInfo);
    announce(kStatic, "/tf_static", ros::kTransforms);
    add(kInfo, camera_info());
    add(kStatic, transforms());
  }

  void announce(Topic id, const std::string& name, std::string_view type) {
    records_ += mcap::channel(id, name, "cdr", std::string(type));
  }
  void add(Topic topic, const std::string& message) { records_ += mcap::message(topic, message); }
  void add_frames() {
    for (std::uint32_t i = 0; i < 3; ++i) {
      add(kPoints, cloud(i * kStep, 5));
      add(kRaw, grey_image(i * kStep + kMiddle));
    }
  }

  ConvertFigures convert() {
    std::ofstream(folder_ / "a.mcap", std::ios::binary) << mcap::file_of(records_);
    return convert_bags({folder_ / "a.mcap"}, folder_ / "drive", false, options_, [](int, int) {});
  }
  std::string error() {
    try {
      convert();
    } catch (const InputError& error) {
      EXPECT_THAT(folder_.names(), ElementsAre("a.mcap"));
      return error.what();
    }
    return "";
  }

  std::unique_ptr<FrameSource> open_converted() const {
    DriveOptions options;
    options.cameras = {0};
    return open_drive(folder_ / "drive", options);
  }

  TemporaryFolder folder_;
  std::string records_;
  ConvertOptions options_;
};

TEST_F(ConvertBags, ManyPointsThatCannotBeUsedAreAnErrorUnlessAllowed) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    add(kPoints, cloud(i * kStep, 40, "lidar", 0.5f, 6));
    add(kRaw, grey_image(i * kStep + kMiddle));
  }
  EXPECT_THAT(error(), testing::AllOf(HasSubstr("18 of 120 points (15 %)"),
                                      HasSubstr("18 not finite"), HasSubstr("--allow-dropped")));
  options_.allow_dropped = true;
  EXPECT_THAT(convert().notes, Contains("points left out: 18 not finite"));
  EXPECT_EQ(std::get<Frame>(open_converted()->load(1)).scan.size(), 34u);
}

TEST_F(ConvertBags, ADriveThatIsReadAsItWasRecorded) {
  add_frames();
  const ConvertFigures figures = convert();
  EXPECT_EQ(figures.scans, 3u);
  EXPECT_EQ(figures.images, 3u);
  EXPECT_THAT(figures.notes, Contains(HasSubstr("points have times")));
  const auto source = open_converted();
  const Frame frame = std::get<Frame>(source->load(2));
  EXPECT_EQ(frame.stamp, kSecond * kNsPerSecond + 2 * TimeNs{kStep});
  EXPECT_EQ(frame.scan.position[3], Eigen::Vector3f(4, 2, 3));
  EXPECT_FLOAT_EQ(frame.scan.time[4], 0.1f);
  EXPECT_EQ(frame.images[0].data[7], 'g');
  EXPECT_EQ(source->info().calibration.cameras[0].cx, 7.5);
}

TEST_F(ConvertBags, OneBadScanDoesNotDecideForAll) {
  add(kPoints, cloud(1, 0));  // while the driver starts
  add(kPoints, std::string("\0\1\0\0rubbish", 11));
  add_frames();
  add(kPoints, cloud(0, 5));                       // again
  add(kPoints, cloud(kStep / 2, 5, "elsewhere"));  // another LiDAR's
  const ConvertFigures figures = convert();
  EXPECT_EQ(figures.scans, 3u);
  EXPECT_THAT(figures.notes, Contains(HasSubstr("points have times")));
  EXPECT_THAT(figures.notes, Contains(HasSubstr("4 messages of /points cannot be used")));
}

TEST_F(ConvertBags, ScansThatAreMissingAreCounted) {
  for (const std::uint32_t i : {0, 1, 2, 3, 4, 6, 7, 8}) {
    add(kPoints, cloud(i * kStep, 5));
    add(kRaw, grey_image(i * kStep + kMiddle));
  }
  add(kRaw, grey_image(5 * kStep + kMiddle));
  add(kRaw, grey_image(9 * kStep + kMiddle));
  add(kPoints, cloud(9 * kStep, 5));
  add(kPoints, cloud(9 * kStep + kMiddle, 5));  // jitter of the driver
  const ConvertFigures figures = convert();
  EXPECT_THAT(figures.warnings,
              ElementsAre("1 of 11 scans of /points are missing: their stamps have gaps"));
}

// Topics of types that are not read, and those that were not chosen.
TEST_F(ConvertBags, TopicsWithoutUseAreCounted) {
  records_ += mcap::channel(17, "/diagnostics", "cdr", "diagnostic_msgs/msg/DiagnosticArray");
  records_ += mcap::channel(18, "/odom", "cdr", std::string(ros::kOdometry));
  records_ += mcap::channel(19, "/silent", "cdr", "std_msgs/msg/String");
  add_frames();
  for (int i = 0; i < 7; ++i) records_ += mcap::message(17, "any");
  options_.poses = NavigationSource::kNone;
  const auto odometry = CdrWriter()
                            .header(kSecond, 0, "odom")
                            .text("base_link")
                            .motion({})
                            .doubles(36)
                            .doubles(6)
                            .doubles(36)
                            .message();
  records_ += mcap::message(18, odometry);
  add(kCompressed, compressed_image(kMiddle, "rgb8; jpeg compressed bgr8", "\xff\xd8\xff-jpeg"));
  const ConvertFigures figures = convert();
  EXPECT_THAT(figures.notes, Contains("not used: 7 messages of /diagnostics "
                                      "(diagnostic_msgs/msg/DiagnosticArray)"));
  EXPECT_THAT(figures.notes, Contains("not used: 1 message of /odom (nav_msgs/msg/Odometry)"));
  EXPECT_THAT(figures.notes, Contains(HasSubstr("not used: 1 message of /front/image_raw/comp")));
  EXPECT_THAT(figures.notes, Not(Contains(HasSubstr("/silent"))));
  EXPECT_THAT(figures.notes, Not(Contains(HasSubstr("not used: 3"))));
  EXPECT_THAT(figures.warnings, IsEmpty());
}

TEST_F(ConvertBags, CompressedImagesAreWrittenByteForByte) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    add(kPoints, cloud(i * kStep, 5));
    add(kCompressed,
        compressed_image(i * kStep, "rgb8; jpeg compressed bgr8", "\xff\xd8\xff-jpeg"));
  }
  EXPECT_EQ(convert().images, 3u);
  std::ifstream file(folder_ / "drive/images/front/000001.jpg", std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "\xff\xd8\xff-jpeg");
}

TEST_F(ConvertBags, TheScaleOfIntensitiesIsFoundOut) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    add(kPoints, cloud(i * kStep, 5, "lidar", 200));
    add(kRaw, grey_image(i * kStep + kMiddle));
  }
  convert();
  const auto source = open_converted();
  EXPECT_FLOAT_EQ(std::get<Frame>(source->load(0)).scan.intensity[0], 200.0f / 255);
}

TEST_F(ConvertBags, ImagesThatAreNotReadAreNoCamera) {
  const std::string png = "\x89PNG\r\n\x1a\n";
  const auto error_of = [&](std::string_view format, const std::string& bytes) {
    const std::string before = records_;
    add(kPoints, cloud(0, 5));
    add(kCompressed, compressed_image(0, format, bytes));
    const std::string message = error();
    records_ = before;
    return message;
  };
  EXPECT_THAT(error_of("16UC1; png compressed ", png), HasSubstr("'16UC1'"));
  EXPECT_THAT(error_of("bayer_rggb8; png compressed ", png), HasSubstr("Bayer"));
  EXPECT_THAT(error_of("bayer_rggb8; jpeg compressed bayer_rggb8", "\xff\xd8\xff"),
              HasSubstr("Bayer"));
  EXPECT_THAT(error_of("h264", "abc"), HasSubstr("'h264'"));
  EXPECT_EQ(error_of("bayer_rggb8; jpeg compressed bgr8", "\xff\xd8\xff"), "");
}

TEST_F(ConvertBags, SaysWhatDoesNotFitTogether) {
  add(kPoints, cloud(0, 5));
  add(kRaw, grey_image(0, 24));
  EXPECT_THAT(error(), HasSubstr("24 x 8"));
  records_.clear();
  EXPECT_THAT(error(), HasSubstr("no point clouds"));
}

TEST_F(ConvertBags, SensorsOfTwoClocksAreRefused) {
  add(kPoints, cloud(0, 5));
  const std::string late =
      CdrWriter().header(5, 0, "front").text("png").bytes("\x89PNG\r\n\x1a\n").message();
  add(kCompressed, late);
  EXPECT_THAT(error(), HasSubstr("one clock"));
}

}  // namespace fovea::convert_bags_test
