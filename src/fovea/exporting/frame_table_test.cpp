#include "fovea/exporting/frame_table.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::frame_table_test {

FrameRecord frame_of(int index, FrameStatus status) {
  FrameRecord frame;
  frame.index = index;
  frame.status = status;
  return frame;
}

std::string table_of(const std::vector<FrameRecord>& frames) {
  const TemporaryFolder folder;
  write_frame_table(frames, folder / "frames.csv", false);
  std::ostringstream text;
  text << std::ifstream(folder / "frames.csv").rdbuf();
  return text.str();
}

TEST(FrameTable, HasStampsPosesAndGains) {
  FrameRecord first = frame_of(3, FrameStatus::kMapped);
  first.stamp = 1'316'782'463'123'456'789;
  first.T_local_lidar.translation() = Eigen::Vector3d(1.5, -0.1, 2);
  first.views = {{2, {}, Eigen::Vector3d(-1, 0, 1)}, {5, {}, {}}};
  const FrameRecord second = frame_of(4, FrameStatus::kSkipped);
  EXPECT_EQ(table_of({first, second}),
            "index,time_ns,status,T_00,T_01,T_02,T_03,T_10,T_11,T_12,T_13,T_20,T_21,T_22,T_23,"
            "gain_2_r,gain_2_g,gain_2_b,gain_5_r,gain_5_g,gain_5_b\n"
            "3,1316782463123456789,mapped,1,0,0,1.5,0,1,0,-0.1,0,0,1,2,0.5,1,2,,,\n"
            "4,,skipped,1,0,0,0,0,1,0,0,0,0,1,0,,,,,,\n");
}

TEST(FrameTable, OfNoFramesIsAnError) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_frame_table({}, folder / "frames.csv", false), InputError);
}

}  // namespace fovea::frame_table_test
