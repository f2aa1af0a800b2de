#include "bench/pcl_peer.h"

#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>

#include <chrono>

namespace fovea::bench {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

Cloud::Ptr cloud_of(PeerPoints points) {
  const Cloud::Ptr cloud(new Cloud);
  for (std::size_t i = 0; i < points.count; ++i) {
    cloud->push_back({points.xyz[3 * i], points.xyz[3 * i + 1], points.xyz[3 * i + 2]});
  }
  return cloud;
}

template <class Method>
PeerRegistration run(Method& method, const RegistrationTask& task) {
  const Cloud::Ptr target = cloud_of(task.target), source = cloud_of(task.source);
  Eigen::Matrix4f T;
  for (int i = 0; i < 16; ++i) T(i / 4, i % 4) = static_cast<float>(task.guess[i]);
  method.setMaxCorrespondenceDistance(task.max_distance);
  Cloud aligned;
  const auto start = std::chrono::steady_clock::now();
  method.setInputTarget(target);
  method.setInputSource(source);
  method.align(aligned, T);
  PeerRegistration result;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  T = method.getFinalTransformation();
  for (int i = 0; i < 16; ++i) result.T_target_source[i] = T(i / 4, i % 4);
  return result;
}

}  // namespace

PeerRegistration pcl_icp(const RegistrationTask& task) {
  pcl::IterativeClosestPoint<Point, Point> icp;
  return run(icp, task);
}

PeerRegistration pcl_gicp(const RegistrationTask& task) {
  pcl::GeneralizedIterativeClosestPoint<Point, Point> gicp;
  gicp.setCorrespondenceRandomness(task.neighbors);
  return run(gicp, task);
}

}  // namespace fovea::bench
