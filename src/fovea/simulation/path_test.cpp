#include "fovea/simulation/path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace fovea::path_test {

Path arc(double curvature) {
  return Path([=](double s) { return curvature * s; }, [=](double) { return curvature; }, -20.3,
              501.7);
}

TEST(Path, ConstantCurvatureIsACircle) {
  const double radius = 40;
  const Path path = arc(1 / radius);
  for (const double s : {-20.3, -7.123, 0.0, 0.25, 33.333, 499.9, 501.7}) {
    const Eigen::Vector2d expected(radius * std::sin(s / radius),
                                   radius * (1 - std::cos(s / radius)));
    EXPECT_LT((path.at(s).position - expected).norm(), 1e-10) << s;
    EXPECT_DOUBLE_EQ(path.at(s).heading, s / radius);
    EXPECT_DOUBLE_EQ(path.at(s).curvature, 1 / radius);
  }
}

TEST(Path, StraightLineAndOffsets) {
  const double heading = 0.3;
  const Path path([=](double) { return heading; }, [](double) { return 0.0; }, -1, 100);
  const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
  const Eigen::Vector2d left(-along.y(), along.x());
  EXPECT_LT((path.at(70.7).position - 70.7 * along).norm(), 1e-12);
  EXPECT_LT((path.offset(70.7, -2) - (70.7 * along - 2 * left)).norm(), 1e-12);
}

TEST(Path, BeginsAnywhere) {
  const Eigen::Vector2d start(30, -4);
  const auto heading = [](double s) { return 0.01 * s; };
  const Path path(heading, [](double) { return 0.01; }, -20.3, 501.7, start);
  EXPECT_LT((path.at(0).position - start).norm(), 1e-12);
  EXPECT_LT((path.at(77).position - start - arc(0.01).at(77).position).norm(), 1e-10);
}

TEST(Path, BendsAgreeWithAFineSum) {
  const double bend = 0.4, length = 25;
  const auto heading = [=](double s) { return bend * std::sin(s / length); };
  const Path path(heading, [=](double s) { return bend / length * std::cos(s / length); }, -3, 200);
  // Midpoint rule with steps of a millimetre: an error of 1e-9 m or so over 61 m.
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  const double step = 1e-3;
  for (int i = 0; i < 61'111; ++i) {
    const double h = heading((i + 0.5) * step);
    sum += step * Eigen::Vector2d(std::cos(h), std::sin(h));
  }
  EXPECT_LT((path.at(61.111).position - sum).norm(), 1e-8);
}

TEST(Path, IsSmoothAcrossItsKnots) {
  const Path path = arc(0.05);
  for (double s = -20; s < 20; s += 0.0997) {
    const Eigen::Vector2d step = path.at(s + 1e-4).position - path.at(s - 1e-4).position;
    EXPECT_NEAR(step.norm(), 2e-4, 1e-12);
  }
}

TEST(Path, KnowsItsRange) {
  const Path path = arc(0.01);
  EXPECT_THROW(path.at(-20.4), std::out_of_range);
  EXPECT_THROW(path.at(501.8), std::out_of_range);
  EXPECT_THROW(path.at(NAN), std::out_of_range);
  EXPECT_THROW(Path([](double) { return 0.0; }, [](double) { return 0.0; }, 1, 2),
               std::invalid_argument);
}

}  // namespace fovea::path_test
