#include "fovea/mapping/fusion/plan_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fovea::plan_view_test {

using testing::ElementsAre;
using testing::IsEmpty;
using Points = std::vector<Eigen::Vector3f>;

TEST(PlanView, PointsCountWhereAColumnHasSomethingAboutAsHigh) {
  const PlanView plan(Points{{0.5f, 0.5f, 0}, {0.2f, 0.7f, 2}, {-3.5f, 4.5f, 1}});
  const Points points{{0.9f, 0.1f, 1},                       // between low and high
                      {0.9f, 0.1f, 2.4f},                    // a little higher
                      {0.9f, 0.1f, 2.6f},                    // too high
                      {0.1f, 0.1f, -0.6f}, {1.1f, 0.5f, 1},  // too low; in the next column
                      {-3.1f, 4.1f, 1},    {500, 0, 0}};
  EXPECT_THAT(plan.covered(points, RigidMotion::Identity(), 0.5),
              ElementsAre(points[0], points[1], points[5]));
}

TEST(PlanView, GivesPointsBackInTheirOwnFrame) {
  const PlanView plan(Points{{10.5f, 0.5f, 0}});
  const RigidMotion T_plan_points(Eigen::Translation3d(10, 0, 0));
  const Points points{{0.5f, 0.5f, 0}, {10.5f, 0.5f, 0}};
  EXPECT_THAT(plan.covered(points, T_plan_points, 0.5), ElementsAre(points[0]));
}

TEST(PlanView, OfNothingCoversNothing) {
  EXPECT_THAT(PlanView({}).covered(Points{{0, 0, 0}}, RigidMotion::Identity(), 1), IsEmpty());
}

}  // namespace fovea::plan_view_test
