#include "fovea/exporting/pose_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::pose_writer_test {

TEST(PoseWriter, ALineForEveryFrameWithTheSameDoubles) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  write_kitti_poses(MapReader(folder / "a.fovea").frames(), folder / "poses.txt", false);
  std::ifstream file(folder / "poses.txt");
  std::string line;
  for (const FrameRecord& frame : sample_frames()) {
    ASSERT_TRUE(std::getline(file, line));
    std::istringstream words(line);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        std::string word;
        words >> word;
        EXPECT_EQ(std::stod(word), frame.T_local_lidar.matrix()(row, column)) << frame.index;
      }
    }
    std::string more;
    EXPECT_FALSE(words >> more);
  }
  EXPECT_FALSE(std::getline(file, line));
}

TEST(PoseWriter, IdentityReadsAsInTheKittiFiles) {
  const TemporaryFolder folder;
  write_kitti_poses({FrameRecord{}}, folder / "poses.txt", false);
  std::ostringstream text;
  text << std::ifstream(folder / "poses.txt").rdbuf();
  EXPECT_EQ(text.str(), "1 0 0 0 0 1 0 0 0 0 1 0\n");
}

TEST(PoseWriter, AnIndexWithoutAFrameHasALineToo) {
  const TemporaryFolder folder;
  std::vector<FrameRecord> frames(2);
  frames[0].index = 3;
  frames[1].index = 7;
  frames[1].T_local_lidar.translation().x() = 8;
  write_kitti_poses(frames, folder / "poses.txt", false);
  std::ifstream file(folder / "poses.txt");
  for (const double x : {0.0, 2.0, 4.0, 6.0, 8.0}) {
    for (const double expected : {1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0}) {
      double number = 0;
      ASSERT_TRUE(file >> number);
      EXPECT_NEAR(number, expected, 1e-12);
    }
  }
  EXPECT_TRUE((file >> std::ws).eof());
}

TEST(PoseWriter, RefusesEmptyMapsAndExistingFiles) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_kitti_poses({}, folder / "poses.txt", false), InputError);
  EXPECT_TRUE(folder.names().empty());
  std::ofstream(folder / "poses.txt") << "old";
  EXPECT_THROW(write_kitti_poses(sample_frames(), folder / "poses.txt", false), OutputError);
  write_kitti_poses(sample_frames(), folder / "poses.txt", true);
  EXPECT_GT(std::filesystem::file_size(folder / "poses.txt"), 3u);
}

}  // namespace fovea::pose_writer_test
