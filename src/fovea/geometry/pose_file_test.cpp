#include "fovea/geometry/pose_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::pose_file_test {

using testing::AllOf;
using testing::HasSubstr;

class PoseFile : public testing::Test {
 protected:
  std::string error_of(const std::string& text) const {
    std::ofstream(folder_ / "p.txt") << text;
    try {
      read_poses(folder_ / "p.txt");
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }
  TemporaryFolder folder_;
};

TEST_F(PoseFile, APoseFarFromAnyDriveIsRefused) {
  const std::string good = "1 0 0 9e6 0 1 0 -9e6 0 0 1 0\n";
  EXPECT_EQ(error_of(good), "");
  for (const char* bad : {"1 0 0 1e300 0 1 0 0 0 0 1 0", "1 0 0 0 0 1 0 -1e300 0 0 1 0",
                          "1 0 0 0 0 1 0 0 0 0 1 1.1e7"}) {
    EXPECT_THAT(error_of(good + bad),
                AllOf(HasSubstr("over 10000 km from the origin"), HasSubstr("p.txt:2")))
        << bad;
  }
  EXPECT_THAT(error_of("1e300 0 0 0 0 1 0 0 0 0 1 0"), HasSubstr("no rotation"));
}

TEST_F(PoseFile, APipeIsRefusedAtOnce) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(read_poses(folder_ / "pipe"), InputError);
}

TEST(PoseFileEncoding, AByteOrderMarkIsNoPartOfTheFirstPose) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.txt", std::ios::binary)
      << "\xEF\xBB\xBF"
         "1 0 0 5 0 1 0 6 0 0 1 7\r\n1 0 0 8 0 1 0 9 0 0 1 10\r\n";
  const auto poses = read_poses(folder / "a.txt");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].translation(), Eigen::Vector3d(5, 6, 7));
}

TEST(PoseFileEncoding, AnotherEncodingIsNamed) {
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
