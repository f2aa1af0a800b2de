#include "fovea/exporting/mesh/seen_points.h"

#include <gtest/gtest.h>

#include "fovea/exporting/mesh/mesh_lattice.h"

namespace fovea::seen_points_test {

constexpr double kCell = 0.05;

SeenPoint point_at(float x, const Eigen::Vector3f& towards, Rgb color, bool colored = true) {
  SeenPoint point = seen_point({x, 0.01f, 0.01f}, towards);
  point.color = color;
  point.colored = colored;
  return point;
}

TEST(SeenPoints, OneForACell) {
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  const auto kept = thinned({point_at(0.01f, up, {10, 20, 30}), point_at(0.06f, up, {1, 1, 1}),
                             point_at(0.03f, up, {20, 40, 50})},
                            kCell);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_NEAR(kept[0].position[0], 0.02, 1e-6);
  EXPECT_EQ(kept[0].color, (Rgb{15, 30, 40}));
  EXPECT_NEAR(kept[1].position[0], 0.06, 1e-6);
}

TEST(SeenPoints, TheSidesOfAThinWallStayApart) {
  const Eigen::Vector3f x = Eigen::Vector3f::UnitX();
  const auto kept = thinned({point_at(0.03f, x, {200, 0, 0}), point_at(0.01f, -x, {0, 200, 0}),
                             point_at(0.03f, x, {220, 0, 0})},
                            kCell);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].color, (Rgb{210, 0, 0}));
  EXPECT_EQ(kept[1].color, (Rgb{0, 200, 0}));
  EXPECT_LT(direction_of(kept[0]).dot(direction_of(kept[1])), -0.9);
}

TEST(SeenPoints, PointsWithoutColourGiveNone) {
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  const auto kept =
      thinned({point_at(0.01f, up, {128, 128, 128}, false), point_at(0.02f, up, {10, 20, 30}),
               point_at(0.09f, up, {128, 128, 128}, false)},
              kCell);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].color, (Rgb{10, 20, 30}));
  EXPECT_EQ(kept[0].colored, 1);
  EXPECT_EQ(kept[1].colored, 0);
}

TEST(SeenPoints, ASensorAtThePointHasSeenItFromAbove) {
  EXPECT_EQ(direction_of(seen_point({1, 2, 3}, Eigen::Vector3f::Zero())), Eigen::Vector3f::UnitZ());
}

TEST(SeenPoints, OnTheFarFaceOfABlockThePointIsInItsLastCell) {
  const auto edge = static_cast<float>(kBlockCells * kCell);
  EXPECT_EQ(cell_in_block(seen_point({edge, -1e-9f, 0}, {0, 0, 1}), kCell).matrix(),
            Eigen::Vector3i(kBlockCells - 1, 0, 0));
}

}  // namespace fovea::seen_points_test
