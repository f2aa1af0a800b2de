#include "fovea/merging/known_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "../../../tests/sample_map.h"

namespace fovea::known_surfaces_test {

constexpr double kSpacing = 0.02;

/// A wall at x, 2 m by 2 m, seen by so many images.
TilePoints wall_at(double x, std::uint8_t views, double step = kSpacing) {
  std::vector<Eigen::Vector3f> positions;
  for (double y = 0; y < 2; y += step) {
    for (double z = 0; z < 2; z += step) positions.emplace_back(float(x), float(y), float(z));
  }
  PointCloud points = one_point_each(positions);
  points.origin = {10, -20, 0};
  TilePoints tile = TilePoints::of(points);
  for (FusedColor& color : tile.colors) color.views = views;
  return tile;
}

std::ptrdiff_t count(const std::vector<bool>& known) {
  return std::count(known.begin(), known.end(), true);
}

class KnownSurfacesTest : public testing::Test {
 protected:
  void add(const TilePoints& points) {
    surfaces_.add(points, T_cell_submap_);
    surfaces_.end_drive();
  }
  std::size_t known_of(const TilePoints& points) const {
    return std::size_t(count(surfaces_.find(points, T_cell_submap_)));
  }

  KnownSurfaces surfaces_{kSpacing};
  RigidMotion T_cell_submap_ = Eigen::Translation3d(-5, 3, 1) *
                               RigidMotion(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
};

TEST_F(KnownSurfacesTest, PointsWithin5CmShowTheSameSurface) {
  EXPECT_EQ(known_of(wall_at(1, 2)), 0u);
  add(wall_at(1, 2));
  EXPECT_EQ(known_of(wall_at(1.04, 2)), wall_at(1, 2).size());
  EXPECT_EQ(known_of(wall_at(1.06, 2)), 0u);
}

TEST_F(KnownSurfacesTest, ADriveDoesNotKnowItsOwnPointsBeforeItsEnd) {
  surfaces_.add(wall_at(1, 2), T_cell_submap_);
  EXPECT_EQ(known_of(wall_at(1, 2)), 0u);
  surfaces_.end_drive();
  EXPECT_EQ(known_of(wall_at(1, 2)), wall_at(1, 2).size());
}

TEST_F(KnownSurfacesTest, ColoredPointsFillASurfaceThatNoCameraSaw) {
  add(wall_at(1, 0, 0.2));
  const TilePoints dense = wall_at(1, 2);
  const std::size_t known = known_of(dense);
  EXPECT_GT(known, 0u);  // where a point of the same place exists
  EXPECT_LT(known, dense.size() / 10);
  EXPECT_GT(known_of(wall_at(1, 0)), 0u);
}

TEST_F(KnownSurfacesTest, EachSurfaceIsThereOnceHoweverManyDrivesShowIt) {
  std::size_t kept = 0;
  for (int drive = 0; drive < 6; ++drive) {
    const TilePoints points = wall_at(1 + 0.005 * drive, 2);
    kept += points.size() - known_of(points);
    add(points);
  }
  EXPECT_EQ(kept, wall_at(1, 2).size());
}

}  // namespace fovea::known_surfaces_test
