#include "bench/open3d_peer.h"

#include <omp.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/pipelines/registration/GeneralizedICP.h>
#include <open3d/pipelines/registration/Registration.h>
#include <open3d/pipelines/registration/TransformationEstimation.h>

#include <chrono>
#include <vector>

namespace fovea::bench {
namespace {

namespace o3d = open3d::pipelines::registration;
using Cloud = open3d::geometry::PointCloud;

Cloud cloud_of(PeerPoints points) {
  std::vector<Eigen::Vector3d> positions;
  for (std::size_t i = 0; i < points.count; ++i) {
    positions.emplace_back(points.xyz[3 * i], points.xyz[3 * i + 1], points.xyz[3 * i + 2]);
  }
  return Cloud(positions);
}

/// @param align  (source, target, guess) -> RegistrationResult
template <class F>
PeerRegistration timed(const RegistrationTask& task, F&& align) {
  omp_set_num_threads(1);
  Cloud target = cloud_of(task.target), source = cloud_of(task.source);
  Eigen::Matrix4d guess;
  for (int i = 0; i < 16; ++i) guess(i / 4, i % 4) = task.guess[i];
  const auto start = std::chrono::steady_clock::now();
  const o3d::RegistrationResult aligned = align(source, target, guess);
  PeerRegistration result;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (int i = 0; i < 16; ++i) result.T_target_source[i] = aligned.transformation_(i / 4, i % 4);
  return result;
}

}  // namespace

PeerRegistration open3d_gicp(const RegistrationTask& task) {
  const open3d::geometry::KDTreeSearchParamKNN around(task.neighbors);
  return timed(task, [&](Cloud& source, Cloud& target, const Eigen::Matrix4d& guess) {
    // It makes covariances of the normals that it finds.
    source.EstimateNormals(around);
    target.EstimateNormals(around);
    return o3d::RegistrationGeneralizedICP(source, target, task.max_distance, guess);
  });
}

PeerRegistration open3d_icp(const RegistrationTask& task) {
  const open3d::geometry::KDTreeSearchParamKNN around(task.neighbors);
  return timed(task, [&](Cloud& source, Cloud& target, const Eigen::Matrix4d& guess) {
    target.EstimateNormals(around);
    return o3d::RegistrationICP(source, target, task.max_distance, guess,
                                o3d::TransformationEstimationPointToPlane());
  });
}

}  // namespace fovea::bench
