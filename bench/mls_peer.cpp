#include "bench/mls_peer.h"

#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/surface/mls.h>

#include <algorithm>
#include <chrono>

namespace fovea::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Mls = pcl::MovingLeastSquares<pcl::PointXYZ, pcl::PointXYZ>;

}  // namespace

MlsRun run_mls(const float* xyz, std::size_t count, const MlsOptions& options) {
  const Cloud::Ptr input(new Cloud);
  for (std::size_t i = 0; i < count; ++i) {
    input->push_back({xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]});
  }
  Mls mls;
  mls.setInputCloud(input);
  mls.setSearchMethod(
      pcl::search::KdTree<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>));
  mls.setSearchRadius(options.search_radius);
  mls.setPolynomialOrder(options.polynomial_order);
  mls.setNumberOfThreads(static_cast<unsigned>(options.threads));
  if (options.method == MlsMethod::kLocalPlane) {
    mls.setUpsamplingMethod(Mls::SAMPLE_LOCAL_PLANE);
    mls.setUpsamplingRadius(options.sample_radius);
    mls.setUpsamplingStepSize(options.sample_step);
  } else {
    mls.setUpsamplingMethod(Mls::RANDOM_UNIFORM_DENSITY);
    mls.setPointDensity(options.points_in_radius);
  }
  Cloud output;
  const auto start = std::chrono::steady_clock::now();
  mls.process(output);
  MlsRun run;
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  run.points = output.size();
  run.finite = std::all_of(output.begin(), output.end(), [](const pcl::PointXYZ& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  });
  return run;
}

int samples_in_disc(double radius, double step) {
  int samples = 0;
  const auto r = static_cast<float>(radius), s = static_cast<float>(step);
  for (float u = -r; u <= r; u += s) {
    for (float v = -r; v <= r; v += s) samples += u * u + v * v < r * r;
  }
  return samples;
}

}  // namespace fovea::bench
