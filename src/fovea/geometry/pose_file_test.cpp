#include "fovea/geometry/pose_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/temporary_folder.h"
#include "fovea/base/errors.h"

namespace fovea::pose_file_test {

TEST(PoseFile, AByteOrderMarkIsNoPartOfTheFirstPose) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.txt", std::ios::binary)
      << "\xEF\xBB\xBF"
         "1 0 0 5 0 1 0 6 0 0 1 7\r\n1 0 0 8 0 1 0 9 0 0 1 10\r\n";
  const auto poses = read_poses(folder / "a.txt");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].translation(), Eigen::Vector3d(5, 6, 7));
}

TEST(PoseFile, AnotherEncodingIsNamed) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.txt", std::ios::binary) << std::string(
      "\xFF\xFE"
      "1\0 \0",
      6);
  try {
    read_poses(folder / "a.txt");
    FAIL() << "UTF-16 was read";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), "the text is UTF-16");
  }
}

}  // namespace fovea::pose_file_test
