#include "fovea/map/map_surfaces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map/tile_place.h"

namespace fovea::map_surfaces_test {

using testing::IsEmpty;

/// A tile with points every 5 cm along its middle line in x, every sixth of them measured.
PointCloud line_tile(const TileKey& key) {
  std::vector<Eigen::Vector3f> positions;
  for (int i = -39; i < 40; ++i) positions.emplace_back(2 + 0.05f * float(i), 2.0f, 2.0f);
  PointCloud tile = one_point_each(positions);
  tile.origin = middle_of(key, 4) - Eigen::Vector3d::Constant(2);  // a tile's corner
  for (std::size_t i = 0; i < tile.size(); ++i) {
    tile.interpolated[i] = (int(i) - 39) % 6 == 0 ? 0 : 1;
  }
  return tile;
}

class Surfaces : public testing::Test {
 protected:
  void SetUp() override {
    const auto writer = MapWriter::create(folder_ / "map.fovea", false);
    writer->put_meta("map.tile_size_m", "4");
    writer->put_submap(0, RigidMotion::Identity());
    writer->put_submap(1, RigidMotion(Eigen::Translation3d(0, 100, 0)));
    for (int x = 0; x < 30; ++x) writer->put_tile({0, {x, 0, 0}}, line_tile({x, 0, 0}));
    writer->put_tile({1, {0, 0, 0}}, line_tile({0, 0, 0}));
    writer->commit();
  }
  TemporaryFolder folder_;
};

TEST_F(Surfaces, ArePointsThatWereMeasuredSeenFromAPlace) {
  const MapReader map(folder_ / "map.fovea");
  MapSurfaces surfaces(map);
  const Eigen::Vector3d center(60, 3, 4);
  const auto points = surfaces.points_near(center, 10);
  // One in 0.3 m, from 60 - sqrt(95) to 60 + that.
  EXPECT_NEAR(double(points.size()), 2 * std::sqrt(95.0) / 0.3, 6);
  for (const Eigen::Vector3f& p : points) {
    EXPECT_LE(p.norm(), 10.001f);
    EXPECT_NEAR(p.y(), -1, 1e-5);
    EXPECT_NEAR(p.z(), -2, 1e-5);
    const float in_tile = std::fmod(p.x() + 60, 4.0f) - 2;  // measured ones lie every 0.3 m
    EXPECT_NEAR(in_tile / 0.3f, std::round(in_tile / 0.3f), 1e-3);
  }
  // The same once more, now from the scratch file.
  EXPECT_EQ(surfaces.points_near(center, 10).size(), points.size());
}

TEST_F(Surfaces, LieWhereTheirSubmapLies) {
  const MapReader map(folder_ / "map.fovea");
  MapSurfaces surfaces(map);
  EXPECT_FALSE(surfaces.points_near({2, 102, 2}, 5).empty());
  EXPECT_FALSE(surfaces.points_near({2, 102, 2}, 5, 1).empty());
  EXPECT_THAT(surfaces.points_near({2, 102, 2}, 5, 0), IsEmpty());
  EXPECT_THAT(surfaces.points_near({2, 50, 2}, 5), IsEmpty());
}

TEST_F(Surfaces, OnlyTilesNearbyAreRead) {
  const MapReader map(folder_ / "map.fovea");
  MapSurfaces surfaces(map);
  {
    const auto writer = MapWriter::open(folder_ / "map.fovea");
    writer->remove_tile({0, {29, 0, 0}});
    writer->commit();
  }
  EXPECT_FALSE(surfaces.points_near({2, 2, 2}, 5).empty());
  EXPECT_THROW(surfaces.points_near({118, 2, 2}, 5), InputError);
}

}  // namespace fovea::map_surfaces_test
