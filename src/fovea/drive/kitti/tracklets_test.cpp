#include "fovea/drive/kitti/tracklets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "../../../../tests/temporary_folder.h"
#include "../../../../tests/tracklet_writer.h"
#include "fovea/errors.h"

namespace fovea::tracklets_test {

class TrackletsTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const {
    const std::filesystem::path file = folder_ / "tracklet_labels.xml";
    std::ofstream(file) << text;
    return file;
  }
  static std::string car() {
    return test::tracklet_item("Car", 4, 2, 1.5, 7,
                               {{10, 1, -1.7, 0}, {11, 1, -1.7, std::numbers::pi / 2}});
  }
  TemporaryFolder folder_;
};

TEST_F(TrackletsTest, ReadsBoxesAtTheirFrames) {
  const auto tracklets = read_tracklets(
      write(test::tracklet_file({car(), test::tracklet_item("Pedestrian", 1, 1, 1.8, 0, {})})));
  ASSERT_EQ(tracklets.size(), 2u);
  const Tracklet& car = tracklets[0];
  EXPECT_EQ(car.type, "Car");
  EXPECT_EQ(car.size, Eigen::Vector3d(4, 2, 1.5));
  EXPECT_EQ(car.at(6), nullptr);
  EXPECT_EQ(car.at(9), nullptr);
  EXPECT_EQ(car.at(7)->translation(), Eigen::Vector3d(10, 1, -1.7));
  EXPECT_TRUE(car.contains(7, {11.9, 1.9, -0.3}, 0));
  EXPECT_FALSE(car.contains(7, {12.1, 1, -1}, 0));
  EXPECT_TRUE(car.contains(7, {12.1, 1, -1}, 0.2));
  EXPECT_FALSE(car.contains(7, {10, 1, -0.1}, 0));
  EXPECT_FALSE(car.contains(7, {10, 1, -1.8}, 0));
  EXPECT_TRUE(car.contains(8, {11, 2.9, -1}, 0));  // turned by a right angle
  EXPECT_FALSE(car.contains(8, {12.9, 1, -1}, 0));
  EXPECT_EQ(tracklets[1].at(0), nullptr);
}

TEST_F(TrackletsTest, DamagedFilesAreNamed) {
  const std::string good = test::tracklet_file({car()});
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  for (const std::string& text :
       {std::string("nothing"), good.substr(0, good.size() / 2), replaced("<h>1.5</h>", "<h>x</h>"),
        replaced("<l>4</l>", ""), replaced("<tx>10</tx>", "<tx>nan</tx>"),
        replaced("<w>2</w>", "<w>0</w>"), replaced("<first_frame>7", "<first_frame>-1"),
        replaced("<count>1</count>", "<count>2</count>"), std::string()}) {
    EXPECT_THAT([&] { read_tracklets(write(text)); },
                testing::ThrowsMessage<InputError>(testing::HasSubstr("tracklet_labels.xml")))
        << text;
  }
}

TEST_F(TrackletsTest, AreFoundInTheDriveOrBesideIt) {
  const std::filesystem::path drive = folder_ / "2011_09_26_drive_0001_sync";
  const std::filesystem::path beside = folder_ / "2011_09_26_drive_0001_tracklets";
  std::filesystem::create_directories(drive);
  std::filesystem::create_directories(beside);
  EXPECT_FALSE(find_tracklets(drive));
  std::ofstream(beside / "tracklet_labels.xml") << "x";
  EXPECT_EQ(find_tracklets(drive / ""), beside / "tracklet_labels.xml");
  std::ofstream(drive / "tracklet_labels.xml") << "x";
  EXPECT_EQ(find_tracklets(drive), drive / "tracklet_labels.xml");
}

}  // namespace fovea::tracklets_test
