#include "fovea/map/tile_cache.h"

#include <gtest/gtest.h>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/map/map_test_support.h"

namespace fovea::tile_cache_test {

constexpr double kNear = 5;  // m

class TileCacheTest : public testing::TestWithParam<bool> {
 protected:
  void open(std::size_t memory = std::size_t{1} << 30) {
    file_ = std::make_unique<Checkpointer>(MapWriter::create(path_, true),
                                           CheckpointerOptions{GetParam(), memory});
    cache_ = std::make_unique<TileCache>(*file_, memory);
  }
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.fovea";
  Random random_{4};
  std::unique_ptr<Checkpointer> file_;
  std::unique_ptr<TileCache> cache_;
};

INSTANTIATE_TEST_SUITE_P(WithAndWithoutThread, TileCacheTest, testing::Bool());

// A map that grows, shrinks and changes color along a road and back, compared with one that stays
// in memory.
TEST_P(TileCacheTest, TheMapIsTheSameAsInMemory) {
  open();
  TileMap map(2.0), whole(2.0);
  const auto both = [&](const auto& change) { change(map), change(whole); };
  std::size_t evicted = 0;
  for (const int place : {0, 1, 2, 3, 4, 3, 2, 1, 0}) {
    const Eigen::Vector3d center(40.0 * place, 0, 0);
    cache_->load_within(map, center, kNear);
    both([&](TileMap& m) { m.add_submap(RigidMotion(Eigen::Translation3d(center))); });
    const PointCloud points = points_at(center.x(), random_);
    std::vector<TileId> near;
    whole.for_each_tile_near(center, kNear,
                             [&](const TileId& id, const TilePoints&) { near.push_back(id); });
    both([&](TileMap& m) {
      m.add(points);
      for (std::size_t i = 0; i < near.size(); ++i) {
        if (i % 3 == 0) m.colors(near[i])[0].spread ^= 5;
        if (i % 3 == 1) m.keep_points(near[i], {});
      }
    });
    cache_->evict_beyond(map, center, kNear);
    file_->checkpoint(map, rows_of(map));
    evicted += map.size() - map.size_in_memory();
    EXPECT_EQ(map.size(), whole.size());
  }
  file_->finish(map, {});
  EXPECT_GT(evicted, 0u);
  expect_stored(path_, whole);
}

TEST_P(TileCacheTest, KeepsTilesWithChangesThatAreNotInTheFile) {
  open();
  TileMap map(2.0);
  for (const double x : {0, 100, 200}) {
    map.add_submap(RigidMotion::Identity());
    map.add(points_at(x, random_));
  }
  const Eigen::Vector3d here(200, 0, 0);
  cache_->evict_beyond(map, here, kNear);
  EXPECT_EQ(map.size_in_memory(), 1500u);
  file_->checkpoint(map, rows_of(map));
  map.colors({0, map.submaps()[0].tiles.begin()->first})[0].views ^= 1;
  cache_->evict_beyond(map, here, kNear);
  EXPECT_EQ(map.submaps()[0].tiles.size(), 1u);
  EXPECT_EQ(map.submaps()[1].tiles.size(), 0u);
  EXPECT_GT(map.submaps()[2].tiles.size(), 0u);
}

TEST_P(TileCacheTest, RequestsTilesBeforeTheyAreNeeded) {
  open();
  TileMap map(2.0);
  for (const double x : {0, 100}) {
    map.add_submap(RigidMotion(Eigen::Translation3d(x, 0, 0)));
    map.add(points_at(x, random_));
  }
  file_->checkpoint(map, rows_of(map));
  cache_->evict_beyond(map, {100, 0, 0}, kNear);
  ASSERT_EQ(map.size_in_memory(), 500u);
  while (map.size_in_memory() < 1000u) cache_->load_within(map, {20, 0, 0}, kNear);
  file_->finish(map, {});
  expect_stored(path_, map);
}

TEST_P(TileCacheTest, IsFullWhenMemoryRunsOutUnlessAllIsInReach) {
  open(/*memory=*/65'000);
  TileMap map(2.0);
  for (int place = 0; place < 4; ++place) {
    map.add_submap(RigidMotion::Identity());
    map.add(points_at(100.0 * place, random_));
  }
  const Eigen::Vector3d here(300, 0, 0);
  EXPECT_TRUE(cache_->is_full(map));
  file_->checkpoint(map, rows_of(map));
  cache_->evict_beyond(map, here, kNear);
  EXPECT_EQ(map.size_in_memory(), 500u);
  EXPECT_FALSE(cache_->is_full(map));
  map.add(points_at(300, random_));
  map.add(points_at(300, random_));
  EXPECT_TRUE(cache_->is_full(map));
  cache_->evict_beyond(map, here, kNear);
  EXPECT_FALSE(cache_->is_full(map));
}

}  // namespace fovea::tile_cache_test
