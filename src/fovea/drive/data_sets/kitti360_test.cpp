#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../../tests/miniature_data_sets.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/drive/data_sets/data_set.h"
#include "fovea/drive/frame_source.h"
#include "fovea/errors.h"

namespace fovea::kitti360_test {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

const std::string kSequence = "2013_05_28_drive_0003_sync";

/// Three scans with images of two cameras; the second frame has no pose.
class Kitti360 : public testing::Test {
 protected:
  Kitti360() {
    // The LiDAR's x axis is the camera's z axis.
    write("calibration/calib_cam_to_velo.txt", "0 0 1 0.5 -1 0 0 0 0 -1 0 -0.1\n");
    write("calibration/calib_cam_to_pose.txt",
          "image_00: 0 0 1 1.5 1 0 0 0 0 1 0 -1\nimage_01: 0 0 1 1.5 1 0 0 0.6 0 1 0 -1\n");
    write("calibration/perspective.txt",
          "calib_time: 01-Jan-2013\nS_rect_00: 24 16\nR_rect_00: 1 0 0 0 1 0 0 0 1\n"
          "P_rect_00: 20 0 11.5 0 0 21 7.5 0 0 0 1 0\nS_rect_01: 24 16\n"
          "R_rect_01: 1 0 0 0 1 0 0 0 1\nP_rect_01: 20 0 11.5 -12 0 21 7.5 0 0 0 1 0\n");
    write("data_poses/" + kSequence + "/poses.txt",
          "0 1 0 0 100 0 1 0 200 0 0 1 5\n2 1 0 0 102 0 1 0 200 0 0 1 5\n");
    std::string stamps;
    for (int i = 0; i < 3; ++i) {
      stamps += fmt::format("2013-05-28 08:46:0{}.100000000\n", 2 + i);
      write_points(
          folder_ / fmt::format("data_3d_raw/{}/velodyne_points/data/{:010d}.bin", kSequence, i),
          float(3 + i), 4);
      for (int k = 0; k < 2; ++k) {
        write_png(folder_ / fmt::format("data_2d_raw/{}/image_{:02d}/data_rect/{:010d}.png",
                                        kSequence, k, i),
                  24, 16, std::uint8_t(50 + 10 * k + i));
      }
    }
    write("data_3d_raw/" + kSequence + "/velodyne_points/timestamps.txt", stamps);
    for (int k = 0; k < 2; ++k) {
      write(fmt::format("data_2d_raw/{}/image_{:02d}/timestamps.txt", kSequence, k), stamps);
    }
    options_.root = folder_ / "";
    options_.scene = "3";
    options_.output = folder_ / "drive";
  }

  void write(const std::string& file, const std::string& text) { write_text(folder_ / file, text); }
  std::string error() {
    try {
      convert_kitti360(options_);
    } catch (const Error& error) {
      EXPECT_FALSE(std::filesystem::exists(options_.output));
      return error.what();
    }
    return "no error";
  }

  TemporaryFolder folder_;
  DataSetOptions options_;
};

TEST_F(Kitti360, ASequenceBecomesADrive) {
  const DataSetFigures figures = convert_kitti360(options_);
  EXPECT_EQ(figures.scans, 3u);
  EXPECT_EQ(figures.images, 6u);
  EXPECT_EQ(figures.poses, 2u);
  EXPECT_THAT(figures.notes, Contains(HasSubstr("fisheye")));
  DriveOptions options;
  options.cameras = {0, 1};
  const auto drive = open_drive(options_.output, options);
  const Frame frame = std::get<Frame>(drive->load(2));
  EXPECT_EQ(frame.scan.position[0], Eigen::Vector3f(5, 1, -1));
  EXPECT_EQ(frame.images[0].data[0], 52);
  EXPECT_EQ(frame.images[1].data[0], 62);
  // 4.5 m ahead of the LiDAR is 4 m ahead of camera 0; camera 1 stands 0.6 m to its right.
  const auto& cameras = drive->info().calibration.cameras;
  const Eigen::Vector3d p_lidar(4.5, 0, 0);
  EXPECT_LT((cameras[0].T_cam_lidar * p_lidar - Eigen::Vector3d(0, -0.1, 4)).norm(), 1e-9);
  EXPECT_LT((cameras[1].T_cam_lidar * p_lidar - Eigen::Vector3d(-0.6, -0.1, 4)).norm(), 1e-9);
}

TEST_F(Kitti360, NamesTheFaults) {
  write("data_3d_raw/" + kSequence + "_velodyne.zip", "an archive");
  options_.scene = "9";
  EXPECT_THAT(error(), AllOf(HasSubstr("--scene 9"), HasSubstr(kSequence)));
  options_.scene = kSequence;
  const std::string stamps = "data_3d_raw/" + kSequence + "/velodyne_points/data/0000000000.bin";
  write(stamps, "");
  EXPECT_THAT(error(), HasSubstr("0000000000.bin"));
  write("data_poses/" + kSequence + "/poses.txt", "0 1 2 3\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("poses.txt"), HasSubstr("13 numbers")));
  write("calibration/perspective.txt", "S_rect_00: 24 16\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("perspective.txt"), HasSubstr("_rect_00")));
  write("calibration/calib_cam_to_velo.txt", "1 2 3\n");
  EXPECT_THAT(error(), HasSubstr("calib_cam_to_velo.txt"));
  options_.root = folder_ / "elsewhere";
  EXPECT_THAT(error(), HasSubstr("data_3d_raw"));
}

}  // namespace fovea::kitti360_test
