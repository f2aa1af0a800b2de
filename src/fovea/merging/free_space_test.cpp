// A later drive looks through the place of a parked car, or sees it.
#include "fovea/merging/free_space.h"

#include <gtest/gtest.h>

#include "../../../tests/temporary_folder.h"
#include "fovea/map/meta_keys.h"
#include "fovea/merging/keyframe_test_support.h"

namespace fovea::free_space_test {

/// A map of one submap whose range images, 2 m apart along x, see one range all round.
class FreeSpaceOf : public testing::Test {
 protected:
  /// @param ranges  m, of each range image
  FreeSpace space(const std::vector<double>& ranges) {
    const auto path = folder_ / "map.fovea";
    auto writer = MapWriter::create(path, /*force=*/true);
    writer->put_meta(meta_key::kTileSize, "4");
    writer->put_submap(0, RigidMotion::Identity());
    for (int k = 0; k < int(ranges.size()); ++k) {
      FrameRecord frame;
      frame.index = k;
      frame.submap = 0;
      frame.T_local_lidar.translation().x() = 2.0 * k;
      writer->put_frame(frame);
      writer->put_keyframe(keyframe_of_range(k, ranges[std::size_t(k)]));
    }
    writer->finish();
    const MapReader map(path);
    return FreeSpace(map, MapContent(map), {RigidMotion::Identity()}, 64);
  }

  /// Of one point at x, 15 m to the left.
  static bool is_gone(const FreeSpace& space, double x) {
    PointCloud cloud;
    cloud.origin = Eigen::Vector3d(x, 15, 0);
    cloud.position.emplace_back(0.1f, 0.1f, 0.1f);
    TilePoints points;
    points.origin = cloud.origin;
    for (auto& axis : points.position) axis.push_back(100);
    return space.contains(points, RigidMotion::Identity()).front();
  }

  TemporaryFolder folder_;
};

TEST_F(FreeSpaceOf, ThreeLooksThroughAPlaceMakeItFree) {
  EXPECT_TRUE(is_gone(space({50, 50, 50}), 3));
  EXPECT_FALSE(is_gone(space({50, 50}), 3));
  EXPECT_FALSE(is_gone(space({}), 3));
}

TEST_F(FreeSpaceOf, ASurfaceThatIsSeenStays) {
  const double range = std::hypot(3.1, 15.1);  // from the first range image
  EXPECT_FALSE(is_gone(space({range, 50, 50, 50}), 3));
  EXPECT_TRUE(is_gone(space({range, 50, 50, 50, 50, 50}), 3));  // once, and five times free
}

TEST_F(FreeSpaceOf, NothingIsKnownBehindASurfaceOrFarAway) {
  EXPECT_FALSE(is_gone(space({8, 8, 8, 8}), 3));
  EXPECT_FALSE(is_gone(space({80, 80, 80, 80}), 60));  // beyond 40 m
}

}  // namespace fovea::free_space_test
