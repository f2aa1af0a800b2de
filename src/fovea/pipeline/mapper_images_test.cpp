// Blank, missing and wrongly exposed images.
#include <gtest/gtest.h>

#include "fovea/pipeline/mapper_test_support.h"
#include "fovea/pipeline/paper_mapper.h"

namespace fovea::mapper_images_test {

/// Mean color error of the map of a drive whose images are taken up to 50 ms before or after their
/// scans, at 12 m/s.
/// @param own_times  whether the mapper has the time of each image
double color_error_of_free_running_camera(bool own_times) {
  constexpr int kFrames = 6;
  SyntheticDrive drive(street_scene(), kFrames, 1.2);
  DriveInfo& info = drive.editable_info();
  info.image_stamps_are_capture_times = true;
  info.image_offsets = {{{1, -0.05}, {2, 0.05}, {4, -0.05}}};
  std::vector<Frame> frames;
  for (int i = 0; i < kFrames; ++i) {
    frames.push_back(std::get<Frame>(drive.load(i)));
    if (!own_times) frames.back().image_offsets.clear();
  }
  Mapper mapper(info, {}, PoseSource::kNavigation);
  for (const Frame& frame : frames) mapper.process(frame);
  double error = 0;
  const auto points = points_of(mapper.map());
  for (const MapPoint& point : points) {
    error += (to_float(point.color) - synthetic_color(point.p_local)).norm();
  }
  return error / double(points.size());
}

TEST(Mapper, EachImageIsProjectedAtItsOwnTime) {
  EXPECT_LT(color_error_of_free_running_camera(true), 4.0);
  EXPECT_GT(color_error_of_free_running_camera(false), 8.0);
}

// A lens that is covered for three frames: no point turns black, and the drive goes on.
TEST(Mapper, BlankImagesColorNothing) {
  Mapper mapper(street().info(), {}, PoseSource::kNavigation);
  std::size_t before = 0;
  for (int i = 0; i < 6; ++i) {
    Frame frame = std::get<Frame>(street().load(i));
    const bool covered = i >= 2 && i < 5;
    if (covered) std::fill(frame.images[0].data.begin(), frame.images[0].data.end(), 3);
    const FrameResult result = mapper.process(frame);
    EXPECT_EQ(result.blank_images, covered ? 1 : 0);
    EXPECT_EQ(result.status, FrameStatus::kMapped);
    if (covered) {
      EXPECT_LE(mapper.map().size(), before);  // coarse points may give way
      EXPECT_GT(double(mapper.map().size()), 0.99 * double(before));
    } else {
      EXPECT_GT(mapper.map().size(), before);
    }
    before = mapper.map().size();
  }
  double color_error = 0;
  const auto points = points_of(mapper.map());
  for (const MapPoint& point : points) {
    color_error += (to_float(point.color) - synthetic_color(point.p_local)).norm();
  }
  EXPECT_LT(color_error / double(points.size()), 4.0);
}

/// Two cameras, one without an image in each frame.
template <class AnyMapper, class Options>
void expect_the_other_camera_to_color(const Options& options) {
  SyntheticDrive drive(street_scene(), 3, 0.8);
  Camera right = drive.info().calibration.cameras[0];
  right.index = 3;
  drive.editable_info().calibration.cameras.push_back(right);
  AnyMapper mapper(drive.info(), options, PoseSource::kNavigation);
  for (int i = 0; i < 3; ++i) {
    Frame frame = std::get<Frame>(drive.load(i));
    frame.images[i == 1 ? 0 : 1] = {};
    const FrameResult result = mapper.process(frame);
    EXPECT_GT(result.added, 0u);
    EXPECT_EQ(result.blank_images, 0);
  }
  double color_error = 0;
  std::size_t colored = 0;
  for (const MapPoint& point : points_of(mapper.map())) {
    if (point.camera == kNoCamera) continue;
    EXPECT_EQ(point.camera, point.frame == 1 ? 3 : 2);
    color_error += (to_float(point.color) - synthetic_color(point.p_local)).norm();
    ++colored;
  }
  EXPECT_LT(color_error / double(colored), 4.0);
}

TEST(Mapper, ACameraWithoutImageLeavesTheOther) {
  PaperOptions baseline;
  apply_variant("baseline-gicp", baseline);
  expect_the_other_camera_to_color<Mapper>(MapperOptions());
  expect_the_other_camera_to_color<PaperMapper>(PaperOptions());
  expect_the_other_camera_to_color<PaperMapper>(baseline);
}

// Two fifths of the light in three frames: the map keeps one exposure.
TEST(Mapper, AMapHasOneExposure) {
  Mapper mapper(street().info(), {}, PoseSource::kNavigation);
  for (int i = 0; i < 8; ++i) {
    Frame frame = std::get<Frame>(street().load(i));
    const bool is_dark = i >= 3 && i < 6;
    if (is_dark) {
      for (std::uint8_t& value : frame.images[0].data) value = std::uint8_t(value * 2 / 5);
    }
    const LogGain gain = mapper.process(frame).colors.value().views.at(0).light().gain;
    EXPECT_LT((gain - (is_dark ? std::log2(0.4f) : 0.0f)).abs().maxCoeff(), 0.02) << i;
  }
  double color_error = 0;
  const auto points = points_of(mapper.map());
  for (const MapPoint& point : points) {
    color_error += (to_float(point.color) - synthetic_color(point.p_local)).norm();
  }
  EXPECT_LT(color_error / double(points.size()), 2.5);
  for (const MapPoint& point : points) {
    ASSERT_EQ(rule_number(point.reason) == reason_of(PointRule::kMeasured), !point.interpolated);
  }
}

TEST(Mapper, TwoCamerasTakeTurns) {
  SyntheticDrive drive(street_scene(), 2, 0.8);
  Camera right = drive.info().calibration.cameras[0];
  right.index = 3;
  right.T_cam_lidar.translation().x() -= 0.54;
  drive.editable_info().calibration.cameras.push_back(right);
  Mapper mapper(drive.info(), {}, PoseSource::kNavigation);
  map_frames(mapper, drive, 0, 1);
  std::size_t from_left = 0, from_right = 0;
  double color_error = 0;
  for (const MapPoint& point : points_of(mapper.map())) {
    (point.camera == 2 ? from_left : from_right) += 1;
    color_error += (to_float(point.color) - synthetic_color(point.p_local)).norm();
  }
  EXPECT_GT(from_right, 0u);
  EXPECT_LT(from_right, from_left);  // what occludes the first's points was left out
  EXPECT_LT(color_error / double(mapper.map().size()), 3.0);
}

/// The part of the images of frames 0 to 5 that the vehicle covers: red, in the middle below.
bool is_covered(int x, int y) { return x > 200 && x < 420 && y > 120; }

template <class AnyMapper>
std::size_t red_points_of_masked_drive(bool has_mask) {
  DriveInfo info = street().info();
  if (has_mask) {
    Image picture(621, 188, 1);
    for (int y = 0; y < 188; ++y) {
      for (int x = 0; x < 621; ++x) *picture.pixel(x, y) = is_covered(x, y) ? 0 : 255;
    }
    info.masks.emplace(2, ImageMask(picture));
  }
  AnyMapper mapper(info, {}, PoseSource::kNavigation);
  for (int i = 0; i < 6; ++i) {
    Frame frame = std::get<Frame>(street().load(i));
    Image& image = frame.images[0];
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (!is_covered(x, y)) continue;
        std::uint8_t* pixel = image.pixel(x, y);
        pixel[0] = 255, pixel[1] = pixel[2] = 10;
      }
    }
    mapper.process(frame);
  }
  std::size_t red = 0;
  for (const auto& [key, stored] : mapper.map().submaps()[0].tiles) {
    const PointCloud tile = stored.points->cloud();
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const Eigen::Vector3f color = to_float(tile.color[i]);
      red += tile.views[i] > 0 && color.x() > 150 && color.y() < 60;
      EXPECT_EQ(tile.views[i] == 0, tile.camera[i] == kNoCamera);
    }
  }
  return red;
}

TEST(Mapper, MaskedPixelsColorNoPoint) {
  const std::size_t without = red_points_of_masked_drive<Mapper>(false);
  EXPECT_GT(without, 10'000u);
  EXPECT_LE(red_points_of_masked_drive<Mapper>(true), without / 1000);
}

TEST(PaperMapper, MaskedPixelsColorNoPoint) {
  const std::size_t without = red_points_of_masked_drive<PaperMapper>(false);
  EXPECT_GT(without, 100u);
  EXPECT_LE(red_points_of_masked_drive<PaperMapper>(true), without / 100);
}

}  // namespace fovea::mapper_images_test
