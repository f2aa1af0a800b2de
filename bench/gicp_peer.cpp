#include "bench/gicp_peer.h"

#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>

#include <chrono>

namespace fovea::bench {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

Cloud::Ptr cloud_of(PclPoints points) {
  const Cloud::Ptr cloud(new Cloud);
  for (std::size_t i = 0; i < points.count; ++i) {
    cloud->push_back({points.xyz[3 * i], points.xyz[3 * i + 1], points.xyz[3 * i + 2]});
  }
  return cloud;
}

template <class Method>
PclRegistration run(Method& method, PclPoints target, PclPoints source, const double* guess,
                    double max_distance) {
  const Cloud::Ptr target_cloud = cloud_of(target), source_cloud = cloud_of(source);
  Eigen::Matrix4f T;
  for (int i = 0; i < 16; ++i) T(i / 4, i % 4) = static_cast<float>(guess[i]);
  method.setMaxCorrespondenceDistance(max_distance);
  Cloud aligned;
  const auto start = std::chrono::steady_clock::now();
  method.setInputTarget(target_cloud);
  method.setInputSource(source_cloud);
  method.align(aligned, T);
  PclRegistration result;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.converged = method.hasConverged();
  T = method.getFinalTransformation();
  for (int i = 0; i < 16; ++i) result.T_target_source[i] = T(i / 4, i % 4);
  return result;
}

}  // namespace

PclRegistration register_by_pcl(PclMethod method, PclPoints target, PclPoints source,
                                const double* guess, double max_distance, int neighbors) {
  if (method == PclMethod::kIcp) {
    pcl::IterativeClosestPoint<Point, Point> icp;
    return run(icp, target, source, guess, max_distance);
  }
  pcl::GeneralizedIterativeClosestPoint<Point, Point> gicp;
  gicp.setCorrespondenceRandomness(neighbors);
  return run(gicp, target, source, guess, max_distance);
}

}  // namespace fovea::bench
