#include "fovea/mapping/registration/place_search.h"

#include <algorithm>
#include <vector>

namespace fovea {
namespace {

/// The coarse registration with pairs of up to 4 m converges from about 2 m.
constexpr double kStep = 2.5, kMaxReach = 20;  // m
constexpr double kCoarsePairs = 4, kCoarseWidth = 1;
constexpr int kCoarseIterations = 30;
/// Points of the scan in the coarse registration. The fine one uses all.
constexpr std::size_t kCoarsePoints = 2000;

/// Offsets of the cross: the center, then the four arms, nearest first.
std::vector<Eigen::Vector3d> cross(double reach) {
  std::vector<Eigen::Vector3d> offsets{Eigen::Vector3d::Zero()};
  for (double arm = kStep; arm <= std::min(reach, kMaxReach); arm += kStep) {
    for (const Eigen::Vector3d& offset :
         {Eigen::Vector3d(arm, 0, 0), {-arm, 0, 0}, {0, arm, 0}, {0, -arm, 0}}) {
      offsets.push_back(offset);
    }
  }
  return offsets;
}

/// At most `count` points, at even steps.
RegistrationCloud sample(const RegistrationCloud& cloud, std::size_t count) {
  RegistrationCloud samples;
  const std::size_t step = std::max<std::size_t>(1, (cloud.points.size() + count - 1) / count);
  for (std::size_t i = 0; i < cloud.points.size(); i += step) {
    samples.points.push_back(cloud.points[i]);
    if (!cloud.normals.empty()) samples.normals.push_back(cloud.normals[i]);
  }
  return samples;
}

}  // namespace

double place_score(const VerticalFit& fit, double overlap) {
  return fit.confirms() ? fit.share * overlap : 0;
}

std::optional<FoundPlace> search_place(const LocalMap& map, const RegistrationCloud& source_lidar,
                                       const RigidMotion& guess_T_odom_lidar, double reach,
                                       const RegistrationOptions& options) {
  RegistrationOptions coarse = options;
  coarse.max_distance = kCoarsePairs;
  coarse.robust_width = kCoarseWidth;
  coarse.max_iterations = kCoarseIterations;
  const RegistrationCloud samples = sample(source_lidar, kCoarsePoints);
  std::optional<FoundPlace> best;
  double best_score = kLeastPlaceScore;
  for (const Eigen::Vector3d& offset : cross(reach)) {
    const RigidMotion start = guess_T_odom_lidar * Eigen::Translation3d(offset);
    const RigidMotion near = register_to(map, samples, start, coarse).T_target_source;
    const RegistrationResult result = register_to(map, source_lidar, near, options);
    if (!result.converged) continue;
    const VerticalFit fit = vertical_fit(map, source_lidar, result.T_target_source);
    const double overlap = double(result.pairs) / double(source_lidar.points.size());
    const double score = place_score(fit, overlap);
    if (score <= best_score) continue;
    best = FoundPlace{result, fit};
    best_score = score;
  }
  return best;
}

}  // namespace fovea
