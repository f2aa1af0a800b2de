#include "fovea/mapping/fusion/pose_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "fovea/core/random.h"

namespace fovea::pose_graph_test {

constexpr double kDegree = std::numbers::pi / 180;

Twist sigmas(double rotation, double translation) {
  Twist sigma;
  sigma << Eigen::Vector3d::Constant(rotation), Eigen::Vector3d::Constant(translation);
  return sigma;
}

RigidMotion pose(double x, double y, double yaw) {
  RigidMotion T(Eigen::Translation3d(x, y, 0));
  T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T;
}

Twist noise(Random& random, const Twist& sigma) {
  Twist twist;
  for (int i = 0; i < 6; ++i) twist[i] = sigma[i] * random.normal();
  return twist;
}

/// Nodes on a circle of 60 m radius that rises and falls.
std::vector<RigidMotion> laps(int nodes, int nodes_per_lap) {
  std::vector<RigidMotion> poses;
  for (int i = 0; i < nodes; ++i) {
    const double angle = 2 * std::numbers::pi * i / nodes_per_lap;
    RigidMotion T = pose(60 * std::cos(angle), 60 * std::sin(angle), angle + std::numbers::pi / 2);
    T.translation().z() = 2 * std::sin(angle);
    T.rotate(Eigen::AngleAxisd(0.03 * std::cos(angle), Eigen::Vector3d::UnitY()));
    poses.push_back(T);
  }
  return poses;
}

double distance(const RigidMotion& a, const RigidMotion& b) {
  return (a.translation() - b.translation()).norm();
}

/// Adds the chain of noisy motions, which also gives the initial poses of the nodes.
void add_chain(const std::vector<RigidMotion>& truth, const Twist& sigma, Random& random,
               PoseGraph& graph) {
  graph.add_node(truth[0]);
  graph.add(AbsolutePose{0, truth[0], sigmas(1e-4, 1e-3)});
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const RigidMotion T = truth[i - 1].inverse() * truth[i] * exp_se3(noise(random, sigma));
    graph.add_node(graph.poses().back() * T);
    graph.add(RelativePose{i - 1, i, T, sigma});
  }
}

TEST(PoseGraph, ExactMeasurementsAreMetExactly) {
  const auto truth = laps(20, 20);
  PoseGraph graph;
  Random random(1);
  for (const RigidMotion& T : truth) graph.add_node(T * exp_se3(noise(random, sigmas(0.1, 1))));
  graph.add(AbsolutePose{0, truth[0], sigmas(0.01, 0.1)});
  for (std::size_t i = 1; i < truth.size(); ++i) {
    graph.add(RelativePose{i - 1, i, truth[i - 1].inverse() * truth[i], sigmas(0.01, 0.1)});
  }
  graph.add(RelativePose{0, 19, truth[0].inverse() * truth[19], sigmas(0.01, 0.1)});
  graph.optimize();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_TRUE(graph.poses()[i].isApprox(truth[i], 1e-9)) << i;
    EXPECT_TRUE(is_rotation(graph.poses()[i].linear(), 1e-12));
  }
}

TEST(PoseGraph, TwoMeasurementsOfOnePoseAreWeighted) {
  PoseGraph graph;
  graph.add_node(pose(0, 0, 0));
  graph.add(AbsolutePose{0, pose(1, 0, 0), sigmas(0.1, 0.1)});
  graph.add(AbsolutePose{0, pose(2, 0, 0.3), sigmas(0.1, 0.2)});
  graph.optimize();
  EXPECT_NEAR(graph.poses()[0].translation().x(), 1.2, 1e-6);  // weights 100 and 25
  EXPECT_NEAR(rotation_angle(graph.poses()[0].linear()), 0.15, 1e-6);
}

TEST(PoseGraph, AClosedLoopTakesTheDriftOut) {
  const auto truth = laps(60, 50);
  PoseGraph graph;
  Random random(7);
  add_chain(truth, sigmas(0.3 * kDegree, 0.02), random, graph);
  const double before = distance(graph.poses()[50], truth[50]);
  for (std::size_t i = 50; i < 60; ++i) {
    graph.add(RelativePose{i - 50, i, truth[i - 50].inverse() * truth[i], sigmas(1e-3, 0.02),
                           /*robust=*/true});
  }
  graph.optimize();
  EXPECT_GT(before, 0.5);
  for (std::size_t i = 50; i < 60; ++i) {
    const RigidMotion apart = graph.poses()[i - 50].inverse() * graph.poses()[i];
    EXPECT_LT(distance(apart, truth[i - 50].inverse() * truth[i]), 0.05) << i;
  }
  EXPECT_LT(distance(graph.poses()[50], truth[50]), 0.05);
  // The error is distributed between the measurements.
  for (const std::size_t i : {12u, 25u, 37u}) {
    EXPECT_LT(distance(graph.poses()[i], truth[i]), before) << i;
  }
}

TEST(PoseGraph, AFalseLoopIsNotBelieved) {
  const auto truth = laps(45, 50);
  PoseGraph graph;
  Random random(3);
  add_chain(truth, sigmas(0.02 * kDegree, 0.01), random, graph);
  const std::vector<RigidMotion> before = graph.poses();
  const RelativePose wrong{5, 40, RigidMotion::Identity(), sigmas(1e-3, 0.05), /*robust=*/true};
  graph.add(wrong);
  graph.optimize();
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LT(distance(graph.poses()[i], before[i]), 0.15) << i;
  }
  EXPECT_GT(graph.squared_error(wrong), 1000);
}

TEST(PoseGraph, PositionsBendADriftingChainTowardsThem) {
  std::vector<RigidMotion> truth;
  for (int i = 0; i < 100; ++i) truth.push_back(pose(20.0 * i, 0, 0));
  PoseGraph graph;
  Random random(11);
  add_chain(truth, sigmas(0.1 * kDegree, 0.02), random, graph);
  EXPECT_GT(distance(graph.poses().back(), truth.back()), 10);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    AbsolutePose position{i, truth[i], sigmas(5 * kDegree, 0.5), /*robust=*/true};
    for (int axis = 0; axis < 3; ++axis) {
      position.T_local_node.translation()[axis] += 0.5 * random.normal();
    }
    // One in ten is an outlier.
    if (i % 10 == 3) position.T_local_node.translation().y() += 5;
    graph.add(position);
  }
  graph.optimize();
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) sum += distance(graph.poses()[i], truth[i]);
  EXPECT_LT(sum / double(truth.size()), 0.5);
}

// A drive with measured positions. Solving after each node, as a mapper does, does not move nodes
// far back, and gives the same result as one solution of the whole graph.
TEST(PoseGraph, ALongRoadIsSolvedAsItComes) {
  const std::vector<RigidMotion> truth = laps(200, 1000);
  const Twist odometry = sigmas(0.05 * kDegree, 0.02), navigation = sigmas(2 * kDegree, 0.5);
  Random random(5);
  PoseGraph graph, whole;
  std::vector<RigidMotion> before;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const AbsolutePose measured{i, truth[i], navigation, /*robust=*/true};
    if (i == 0) {
      graph.add_node(truth[0]);
      whole.add_node(truth[0]);
    } else {
      const RigidMotion T = truth[i - 1].inverse() * truth[i] * exp_se3(noise(random, odometry));
      for (PoseGraph* each : {&graph, &whole}) {
        each->add_node(each->poses().back() * T);
        each->add(RelativePose{i - 1, i, T, odometry});
      }
    }
    graph.add(measured);
    whole.add(measured);
    if (i + 1 == truth.size()) before = graph.poses();
    graph.optimize();
  }
  whole.optimize();
  whole.add(RelativePose{0, 199, RigidMotion::Identity(),
                         sigmas(1e9, 1e9)});  // optimizes all nodes again
  whole.optimize();
  EXPECT_EQ(distance(graph.poses()[100], before[100]), 0);
  EXPECT_GT(distance(graph.poses()[198], before[198]), 0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT(distance(graph.poses()[i], whole.poses()[i]), 0.05) << i;
    EXPECT_LT(distance(graph.poses()[i], truth[i]), 0.3) << i;
  }
  // A loop moves all nodes.
  graph.add(RelativePose{0, 199, pose(1, 0, 0) * truth[0].inverse() * truth[199], odometry});
  graph.optimize();
  EXPECT_GT(distance(graph.poses()[100], before[100]), 0.001);
}

/// Points of three nodes of a chain, as surveyed.
std::vector<PointPosition> surveyed(const std::vector<RigidMotion>& truth) {
  std::vector<PointPosition> points;
  for (const std::size_t node : {std::size_t{0}, truth.size() / 2, truth.size() - 1}) {
    const Eigen::Vector3d p_node(3, -2, 1.5);
    points.push_back({node, p_node, truth[node] * p_node, 0.02});
  }
  return points;
}

/// How far a chain without any other absolute measurement lies from its true poses, if it starts at
/// a wrong place.
double error_of_surveyed_chain(const std::vector<RigidMotion>& truth) {
  RigidMotion wrong(Eigen::Translation3d(4, -3, 2));
  wrong.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, 3).normalized()));
  PoseGraph graph;
  for (const RigidMotion& T : truth) graph.add_node(wrong * T);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    graph.add(RelativePose{i - 1, i, truth[i - 1].inverse() * truth[i], sigmas(1e-3, 0.01)});
  }
  for (const PointPosition& point : surveyed(truth)) graph.add(point);
  graph.optimize();
  double worst = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    worst = std::max(worst, (graph.poses()[i].matrix() - truth[i].matrix()).cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(PoseGraph, ThreeSurveyedPointsPlaceAChain) {
  EXPECT_LT(error_of_surveyed_chain(laps(20, 30)), 1e-6);
}

// More nodes than those that a measurement without a loop moves: the points of the first nodes
// count, too.
TEST(PoseGraph, ThreeSurveyedPointsPlaceALongChain) {
  EXPECT_LT(error_of_surveyed_chain(laps(100, 150)), 1e-6);
}

TEST(PoseGraph, SurveyedPointsAreWeighted) {
  PoseGraph graph;
  graph.add_node(pose(0, 0, 0.4));
  graph.add(PointPosition{0, Eigen::Vector3d::Zero(), {1, 5, -1}, 0.1});
  graph.add(PointPosition{0, Eigen::Vector3d::Zero(), {2, 5, 1}, 0.2});
  graph.optimize();
  // Weights 100 and 25.
  EXPECT_LT((graph.poses()[0].translation() - Eigen::Vector3d(1.2, 5, -0.6)).norm(), 1e-6);
  EXPECT_NEAR(rotation_angle(graph.poses()[0].linear()), 0.4, 1e-9);  // without a measurement
}

// A surveyed point at the end of a lever and a measured pose share the error by their variances.
TEST(PoseGraph, ASurveyedPointAndAPoseAreWeighted) {
  PoseGraph graph;
  graph.add_node(pose(0, 0, 0));
  graph.add(AbsolutePose{0, pose(0, 0, 0), sigmas(1e-6, 0.3)});
  graph.add(PointPosition{0, {10, 0, 0}, {10, 1, 0}, 0.1});
  graph.optimize();
  EXPECT_NEAR(graph.poses()[0].translation().y(), 0.9, 1e-6);  // 0.09 / (0.09 + 0.01)
}

TEST(PoseGraph, PosesWithoutMeasurementsStay) {
  PoseGraph graph;
  graph.add_node(pose(1, 2, 0.1));
  graph.add_node(pose(3, 4, 0.2));
  graph.optimize();
  EXPECT_TRUE(graph.poses()[1].isApprox(pose(3, 4, 0.2), 1e-12));
}

TEST(PoseGraph, NothingIsOptimisedToNothing) {
  PoseGraph graph;
  graph.optimize();
  EXPECT_TRUE(graph.poses().empty());
}

// Narrowing the kernel step by step from an infinite error would never end.
TEST(PoseGraph, AnInfiniteErrorEnds) {
  PoseGraph graph;
  RigidMotion far = RigidMotion::Identity();
  far.translation().x() = 1e200;
  graph.add_node(RigidMotion::Identity());
  graph.add_node(far);
  RelativePose loop;
  loop.from = 0;
  loop.to = 1;
  loop.robust = true;
  graph.add(loop);
  graph.optimize();
  EXPECT_EQ(graph.poses().size(), 2u);
}

TEST(PoseGraph, RejectsNodesThatAreNotThere) {
  PoseGraph graph;
  graph.add_node(RigidMotion::Identity());
  EXPECT_THROW(graph.add(RelativePose{0, 1, {}, {}}), std::invalid_argument);
  EXPECT_THROW(graph.add(RelativePose{0, 0, {}, {}}), std::invalid_argument);
  EXPECT_THROW(graph.add(AbsolutePose{3, {}, {}}), std::invalid_argument);
  EXPECT_THROW(graph.add(PointPosition{1, {}, {}, 1}), std::invalid_argument);
}

}  // namespace fovea::pose_graph_test
