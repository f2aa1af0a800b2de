#include "fovea/geometry/city_grid.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace fovea::city_grid_test {

constexpr GeodeticPoint kOrigin{49.01, 8.43, 114};

Eigen::Vector3d ecef(const GeodeticPoint& point) { return T_ecef_enu(point).translation(); }

TEST(CityGrid, IsEastAndNorthOfTheOrigin) {
  const CityGrid grid(kOrigin, 64);
  EXPECT_LT(grid.projected(ecef(kOrigin)).norm(), 1e-6);
  const LocalTangentPlane enu(kOrigin);
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(100, 30, 5), Eigen::Vector3d(-70, -250, 20)}) {
    const Eigen::Vector2d place = grid.projected(T_ecef_enu(kOrigin) * p);
    EXPECT_LT((place - p.head<2>()).norm(), 0.01) << p.transpose();
  }
  EXPECT_EQ(grid.tile_at(T_ecef_enu(kOrigin) * Eigen::Vector3d(1, 1, 0)), (CityTile{0, 0}));
  EXPECT_EQ(grid.tile_at(T_ecef_enu(kOrigin) * Eigen::Vector3d(-1, 65, 0)), (CityTile{-1, 1}));
}

TEST(CityGrid, DoesNotDependOnTheHeight) {
  const CityGrid grid(kOrigin, 64);
  GeodeticPoint high{49.3, 8.9, 0};
  const Eigen::Vector2d low = grid.projected(ecef(high));
  high.altitude = 3000;
  EXPECT_LT((grid.projected(ecef(high)) - low).norm(), 1e-6);
}

TEST(CityGrid, TheMiddleOfACellIsInIt) {
  const CityGrid grid(kOrigin, 64);
  for (const CityTile tile : {CityTile{0, 0}, {-1, -1}, {1500, -900}, {-1600, 1600}}) {
    EXPECT_EQ(grid.tile_at(ecef(grid.middle(tile))), tile) << tile.text();
  }
}

// 12 degrees east is the border of two UTM zones, 260 km from the origin at 8.43.
TEST(CityGrid, HasNoZones) {
  const CityGrid grid({48.2, 11.99, 500}, 64);
  const Eigen::Vector2d west = grid.projected(ecef({48.2, 11.9999, 500})),
                        east = grid.projected(ecef({48.2, 12.0001, 500}));
  EXPECT_NEAR((east - west).norm(),
              (ecef({48.2, 12.0001, 500}) - ecef({48.2, 11.9999, 500})).norm(), 0.01);
}

TEST(CityGrid, CellsAreLittleSmallerFarAway) {
  const CityGrid grid(kOrigin, 64);
  const CityTile far{1560, 0};  // 100 km east
  const double edge = (ecef(grid.middle({far.x, far.y + 1})) - ecef(grid.middle(far))).norm();
  EXPECT_LT(edge, 64);
  EXPECT_NEAR(edge, 64 * (1 - 1.2e-4), 1e-3);
}

TEST(CityTile, ReadsItsText) {
  EXPECT_EQ(CityTile::parse("-3,17"), (CityTile{-3, 17}));
  EXPECT_EQ((CityTile{-3, 17}).text(), "-3,17");
  for (const char* text : {"", "3", "3,", ",3", "3;4", "3,4,5", "a,b", "1.5,2", "99999999999,1"}) {
    EXPECT_FALSE(CityTile::parse(text)) << text;
  }
  EXPECT_THROW(CityGrid(kOrigin, 0), std::invalid_argument);
}

}  // namespace fovea::city_grid_test
