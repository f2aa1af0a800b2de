#include "fovea/mapping/calibration/edge_maximum.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "fovea/core/random.h"

namespace fovea::edge_maximum_test {

constexpr FreeParameters kAll{true, true, true, true, true, true, true, true, true};

/// All but one.
FreeParameters without(int parameter) {
  FreeParameters free = kAll;
  free[std::size_t(parameter)] = false;
  return free;
}

/// Profiles of edges in any direction all over the view of a camera (f = 700) that moves ahead at 4
/// to 14 m/s. Their images are a pixel wide, at the position of `truth` (calibration_unit()s) but
/// for `noise` pixels.
std::vector<EdgeProfile> profiles_of(const CalibrationVector& truth, double noise,
                                     std::uint64_t seed = 1, int count = 600) {
  Random random(seed);
  std::vector<EdgeProfile> profiles;
  Camera camera;
  camera.fx = camera.fy = 700;
  for (int i = 0; i < count; ++i) {
    EdgeProfile profile;
    profile.frame = i / 30;
    profile.place = {i / 3, 0, 0};
    // The axes of the LiDAR are the camera's.
    const Twist ahead = (Twist() << 0, 0, 0, 0, 0, random.uniform(4, 14)).finished();
    const double z = random.uniform(4, 25);
    const Eigen::Vector3d p(z * random.uniform(-0.8, 0.8), z * random.uniform(-0.25, 0.25), z);
    profile.J = pixel_jacobian(camera, p, ahead).cast<float>();
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    profile.normal = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
    const bool between_rings = std::abs(profile.normal.y()) > 0.7f;
    profile.J_along << (profile.normal.transpose() * profile.J).transpose(),
        between_rings ? 0.0f : 1.0f, between_rings ? profile.normal.y() : 0.0f;
    profile.half_gap = 0.5f;
    const double place =
        profile.J_along.cast<double>().cwiseProduct(calibration_unit()).dot(truth) +
        noise * random.normal();
    for (int k = 0; k < EdgeProfile::kSize; ++k) {
      const double away = k - EdgeProfile::kReach - place;
      if (std::abs(away) > 4) continue;
      profile.strength[std::size_t(k)] = static_cast<float>(0.3 * std::exp(-away * away / 2));
    }
    profiles.push_back(profile);
  }
  return profiles;
}

CalibrationVector planted() {
  return (CalibrationVector() << 3, -4, 1.5, 2, -1, 0.8, -2, 0.4, -0.6).finished();
}

CalibrationMatrix positive_matrix() {
  const CalibrationMatrix m = CalibrationMatrix::NullaryExpr(
      [](Eigen::Index i, Eigen::Index j) { return std::sin(double(3 * i + 7 * j)); });
  return m * m.transpose() + CalibrationMatrix::Identity();
}

CalibrationMatrix curvature_at(const std::vector<EdgeProfile>& profiles,
                               const CalibrationVector& x) {
  return edge_score(profiles, x, kFinestEdgeWidth).curvature;
}

TEST(EdgeMaximum, OnlyKeepsFreeParameters) {
  const FreeParameters free = without(4);
  const CalibrationMatrix m = positive_matrix();
  const CalibrationMatrix kept = decoupled(free, m), part = free_part(free, m);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      const bool is_fixed = i == 4 || j == 4;
      EXPECT_EQ(part(i, j), is_fixed ? 0 : m(i, j));
      EXPECT_EQ(kept(i, j), i == 4 && j == 4 ? m.diagonal().maxCoeff() : is_fixed ? 0 : m(i, j));
    }
  }
  const CalibrationVector v = free_part(free, CalibrationVector(CalibrationVector::Ones()));
  EXPECT_EQ(v, CalibrationVector(CalibrationVector::Ones() - CalibrationVector::Unit(4)));
  EXPECT_EQ(decoupled(kAll, m), m);
}

TEST(EdgeMaximum, PositiveDefinite) {
  CalibrationMatrix m = positive_matrix();
  EXPECT_TRUE(is_positive_definite(m));
  EXPECT_FALSE(is_positive_definite(-m));
  const CalibrationVector v = CalibrationVector::Ones();
  EXPECT_FALSE(is_positive_definite(v * v.transpose()));
  m(2, 2) = -1;
  EXPECT_FALSE(is_positive_definite(m));
}

TEST(EdgeMaximum, TermsAddAndScale) {
  const QuadraticTerm term{planted(), positive_matrix(), 2 * positive_matrix()};
  QuadraticTerm sum = term.scaled(3);
  EXPECT_LT((sum.gradient - 3 * planted()).norm(), 1e-12);
  EXPECT_LT((sum.curvature - 3 * positive_matrix()).norm(), 1e-9);
  EXPECT_LT((sum.scatter - 18 * positive_matrix()).norm(), 1e-9);  // of a gradient times 3
  sum += term;
  EXPECT_LT((sum.gradient - 4 * planted()).norm(), 1e-12);
  EXPECT_LT((sum.curvature - 4 * positive_matrix()).norm(), 1e-9);
  EXPECT_LT((sum.scatter - 20 * positive_matrix()).norm(), 1e-9);
}

TEST(EdgeMaximum, FindsThePlantedCorrection) {
  const CalibrationVector x = maximize_edge_score(profiles_of(planted(), 0), kAll);
  EXPECT_LT((x - planted()).cwiseAbs().maxCoeff(), 0.02) << (x - planted()).transpose();
}

TEST(EdgeMaximum, FixedParametersStayZero) {
  const FreeParameters free = without(kCamDelay);
  const CalibrationVector truth = free_part(free, planted());
  const CalibrationVector x = maximize_edge_score(profiles_of(truth, 0), free);
  EXPECT_EQ(x[kCamDelay], 0);
  EXPECT_LT((x - truth).cwiseAbs().maxCoeff(), 0.02);
}

// A narrow Gaussian does not reach an edge that is far away.
TEST(EdgeMaximum, TheCoarsestGaussianIsTheReach) {
  const CalibrationVector truth = 12 * CalibrationVector::Unit(1);  // about 14 pixels
  auto profiles = profiles_of(truth, 0);
  std::erase_if(profiles, [](const EdgeProfile& p) { return std::abs(p.normal.x()) < 0.7f; });
  const FreeParameters yaw{false, true};
  EXPECT_NEAR(maximize_edge_score(profiles, yaw)[1], 12, 0.02);
  EXPECT_LT(maximize_edge_score(profiles, yaw, {}, kFinestEdgeWidth)[1], 6);
  const auto near = profiles_of(0.5 * CalibrationVector::Unit(1), 0);
  EXPECT_NEAR(maximize_edge_score(near, yaw, {}, kFinestEdgeWidth)[1], 0.5, 0.02);
}

TEST(EdgeMaximum, WithoutEdgesOtherEvidenceDecides) {
  EXPECT_EQ(maximize_edge_score({}, kAll), CalibrationVector(CalibrationVector::Zero()));
  QuadraticTerm evidence;
  evidence.curvature = positive_matrix();
  evidence.gradient = evidence.curvature * planted();
  EXPECT_LT((maximize_edge_score({}, kAll, evidence) - planted()).norm(), 1e-6);
}

// At the maximum the gradients of both cancel.
TEST(EdgeMaximum, WeighsEdgesAgainstOtherEvidence) {
  const auto profiles = profiles_of(planted(), 0);
  QuadraticTerm evidence;
  evidence.curvature = 200 * CalibrationMatrix::Identity();  // its maximum: no correction
  const CalibrationVector x = maximize_edge_score(profiles, kAll, evidence);
  EXPECT_LT(x.norm(), 0.99 * planted().norm());
  EXPECT_GT(x.norm(), 0.2 * planted().norm());
  const CalibrationVector gradient = edge_score(profiles, x, kFinestEdgeWidth).gradient;
  EXPECT_LT((gradient - evidence.curvature * x).norm(), 1e-3 * gradient.norm());
}

// Edges of one frame or of one place have common errors: their gradients add before the square.
TEST(EdgeMaximum, ScatterIsThatOfFramesPlusThatOfPlaces) {
  std::vector<EdgeProfile> profiles = profiles_of(0.1 * planted(), 0, 1, 3);
  const CalibrationVector x = CalibrationVector::Zero();
  std::vector<CalibrationVector> g;
  for (const EdgeProfile& p : profiles) g.push_back(edge_score(p, x, kFinestEdgeWidth).gradient);
  ASSERT_GT(g[0].norm(), 0);
  const auto squared = [](const CalibrationVector& v) {
    return CalibrationMatrix(v * v.transpose());
  };
  // Frames: (0, 1) and 2, places: 0 and (1, 2). The factor of two groups is 2 / (2 - 1).
  profiles[0].frame = profiles[1].frame = 0, profiles[2].frame = 1;
  profiles[0].place = {0, 0, 0}, profiles[1].place = profiles[2].place = {1, 0, 0};
  const CalibrationMatrix expected =
      2 * (squared(g[0] + g[1]) + squared(g[2]) + squared(g[0]) + squared(g[1] + g[2]));
  EXPECT_LT((edge_scatter(profiles, kAll, x) - expected).norm(), 1e-9 * expected.norm());
  const FreeParameters free = without(1);
  EXPECT_LT((edge_scatter(profiles, free, x) - free_part(free, expected)).norm(),
            1e-9 * expected.norm());
}

// Over 30 drives the errors of the maxima, in sigmas, have a spread of about 1.
TEST(EdgeMaximum, CovarianceIsTheScatterOfTheMaxima) {
  CalibrationVector square = CalibrationVector::Zero();
  constexpr int kDrives = 30;
  for (int i = 0; i < kDrives; ++i) {
    auto profiles = profiles_of(0.1 * planted(), 0.5, 100 + static_cast<std::uint64_t>(i), 300);
    for (std::size_t k = 0; k < profiles.size(); ++k) {  // each edge is alone
      profiles[k].place = {int(k), 0, 0};
    }
    const CalibrationVector x = maximize_edge_score(profiles, kAll);
    const CalibrationMatrix cov = edge_covariance(profiles, kAll, x, curvature_at(profiles, x));
    square += (x - 0.1 * planted()).cwiseAbs2().cwiseQuotient(cov.diagonal()) / kDrives;
  }
  for (int k = 0; k < 9; ++k) {
    EXPECT_GT(std::sqrt(square[k]), 0.4) << k;  // frames and places count the same errors twice
    EXPECT_LT(std::sqrt(square[k]), 1.3) << k;
  }
}

// An unknown delay of 20 ms adds what it moves the other parameters by.
TEST(EdgeMaximum, AFixedDelayAddsToTheCovariance) {
  const FreeParameters free = without(kCamDelay);
  const CalibrationVector x = CalibrationVector::Zero();
  const auto profiles = profiles_of(x, 0.5);
  const CalibrationMatrix curvature = curvature_at(profiles, x);
  const CalibrationMatrix inverse = decoupled(free, curvature).inverse();
  const CalibrationMatrix added = edge_covariance(profiles, free, x, curvature) -
                                  inverse * edge_scatter(profiles, free, x) * inverse;
  // The maximum that moves if the images are 20 ms late.
  const double delay = 0.02 / calibration_unit()[kCamDelay];
  const CalibrationVector late =
      profiles_of(delay * CalibrationVector::Unit(kCamDelay), 0).empty()
          ? x
          : maximize_edge_score(profiles_of(delay * CalibrationVector::Unit(kCamDelay), 0), free);
  for (int k = 0; k < 9; ++k) {
    EXPECT_NEAR(std::sqrt(added(k, k)), std::abs(late[k]), 0.2 * late.norm()) << k;
  }
  EXPECT_NEAR(added(kCamDelay, kCamDelay), 0, 1e-9);
}

}  // namespace fovea::edge_maximum_test
