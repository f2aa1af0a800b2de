#include "fovea/localization/pose_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace fovea::pose_table_test {

using testing::StartsWith;

std::vector<Localization> two_frames() {
  std::vector<Localization> frames(2);
  frames[0].index = 7;
  frames[0].stamp = 1'234'567'890'123;
  frames[0].state = LocalizationState::kLocalized;
  frames[0].health = 0.75;
  frames[0].T_local_lidar.translation() = Eigen::Vector3d(1.5, -2, 0.25);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) frames[0].covariance(i, j) = 10 * (i + 1) + j + 1;
  }
  frames[1].index = 8;
  frames[1].state = LocalizationState::kLost;
  return frames;
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(PoseLines, AreKittisWithNanWhereThereIsNoPose) {
  std::ostringstream out;
  write_pose_lines(two_frames(), 6, 9, out);
  EXPECT_EQ(out.str(),
            "nan nan nan nan nan nan nan nan nan nan nan nan\n"
            "1 0 0 1.5 0 1 0 -2 0 0 1 0.25\n"
            "nan nan nan nan nan nan nan nan nan nan nan nan\n");
}

TEST(PoseTable, HasTheCovariancesUpperTriangle) {
  std::ostringstream out;
  write_pose_table(two_frames(), out);
  const std::vector<std::string> rows = lines(out.str());
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_THAT(rows[0],
              StartsWith("frame,time_ns,state,health,x,y,z,qx,qy,qz,qw,cov_rx_rx,cov_rx_ry"));
  EXPECT_EQ(rows[1],
            "7,1234567890123,localized,0.7500,1.5,-2,0.25,0,0,0,1,"
            "11,12,13,14,15,16,22,23,24,25,26,33,34,35,36,44,45,46,55,56,66");
  EXPECT_EQ(rows[2], "8,,lost,0.0000" + std::string(28, ','));
  const auto columns = [](const std::string& row) {
    return std::count(row.begin(), row.end(), ',');
  };
  EXPECT_EQ(columns(rows[1]), columns(rows[0]));
  EXPECT_EQ(columns(rows[2]), columns(rows[0]));
}

}  // namespace fovea::pose_table_test
