#include "fovea/map.h"

#include <gtest/gtest.h>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::api_map_test {

class MapTest : public testing::Test {
 protected:
  MapTest() { write_sample_map(folder_ / "a.fovea"); }

  TemporaryFolder folder_;
};

TEST_F(MapTest, GivesAllPointsInLocal) {
  const Map map(folder_ / "a.fovea");
  const PointCloud points = map.points();
  ASSERT_EQ(points.size(), map.size());
  std::size_t i = 0;
  for_each_sample_point([&](const Eigen::Vector3d& p_local, const PointCloud&, std::size_t) {
    EXPECT_LT((points.position[i++].cast<double>() - p_local).norm(), 1e-3);
  });
  EXPECT_EQ(i, points.size());
}

TEST_F(MapTest, GivesThePointsOfABox) {
  const Map map(folder_ / "a.fovea");
  const PointCloud all = map.points();
  const Eigen::Vector3f middle = all.position[all.size() / 2];
  const PointQuery::Box box{middle.cast<double>().array() - 2, middle.cast<double>().array() + 1};
  std::vector<Eigen::Vector3f> expected;
  for (const Eigen::Vector3f& p : all.position) {
    const Eigen::Vector3d d = p.cast<double>();
    if ((d.array() >= box.low.array()).all() && (d.array() <= box.high.array()).all()) {
      expected.push_back(p);
    }
  }
  ASSERT_GT(expected.size(), 0u);
  ASSERT_LT(expected.size(), all.size());
  EXPECT_EQ(map.points({.box = box}).position, expected);
}

TEST_F(MapTest, GivesThePointsThatMeetConditions) {
  const Map map(folder_ / "a.fovea");
  const PointCloud colored = map.points({.where = "camera >= 0"});
  ASSERT_GT(colored.size(), 0u);
  ASSERT_LT(colored.size(), map.size());
  for (const std::int8_t camera : colored.camera) EXPECT_GE(camera, 0);
  EXPECT_THROW(map.points({.where = "size > 3"}), ConfigError);
}

TEST_F(MapTest, RefusesABoxWithoutVolume) {
  const Map map(folder_ / "a.fovea");
  const PointQuery::Box box{Eigen::Vector3d::Zero(), Eigen::Vector3d(1, 0, 1)};
  EXPECT_THROW(map.points({.box = box}), ConfigError);
}

TEST_F(MapTest, UncoloredPointsAreGray) {
  const Map map(folder_ / "a.fovea");
  const PointCloud points = map.points();
  const std::vector<Rgb> colors = map.colors(points);
  ASSERT_EQ(colors.size(), points.size());
  std::size_t gray = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.camera[i] != kNoCamera) continue;
    ++gray;
    EXPECT_EQ(colors[i], (Rgb{128, 128, 128}));
  }
  EXPECT_GT(gray, 0u);
}

TEST_F(MapTest, GivesFramesAndMeta) {
  const Map map(folder_ / "a.fovea");
  const std::vector<MappedFrame> frames = map.frames();
  ASSERT_EQ(frames.size(), sample_frames().size());
  EXPECT_EQ(frames[0].index, 7);
  EXPECT_EQ(frames[0].figures.at("points_scan"), 19329);
  EXPECT_STREQ(to_string(frames[2].status), "skipped");
  const FrameRecord record = sample_frames()[0];
  EXPECT_EQ(frames[0].milliseconds, record.milliseconds);
  EXPECT_EQ(frames[0].motion, record.motion);
  EXPECT_TRUE(frames[0].T_local_lidar_navigation->isApprox(*record.T_local_lidar_navigation));
  ASSERT_EQ(frames[0].views.size(), 2u);
  EXPECT_EQ(frames[0].views[1].camera, 3);
  EXPECT_EQ(frames[0].views[1].stamp, record.views[1].stamp);
  EXPECT_EQ(map.meta().at("map.tile_size_m"), "4");
  EXPECT_EQ(map.digest(), MapReader(folder_ / "a.fovea").digest());
}

TEST_F(MapTest, RefusesAFileThatIsMissing) { EXPECT_THROW(Map(folder_ / "b.fovea"), InputError); }

}  // namespace fovea::api_map_test
