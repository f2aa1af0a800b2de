#include "fovea/evaluation/truth_upsampling.h"

#include "fovea/core/parallel.h"
#include "fovea/evaluation/truth_surfaces.h"
#include "fovea/geometry/kd_tree.h"
#include "fovea/upsample.h"

namespace fovea {
namespace {

constexpr std::size_t kMaxFrames = 16;
constexpr float kRecovered = 0.05f;  // m

void upsample_scan(const std::vector<TrueReturn>& returns, const PosePair& frame,
                   const Camera& camera, const SurfaceIndex& surfaces, UpsamplingErrors& errors) {
  PointCloud kept_cam;
  std::vector<Eigen::Vector3f> hidden_cam;
  for (const TrueReturn& r : visible_static(returns, {camera})) {
    const Eigen::Vector3f p_cam = (camera.T_cam_lidar * r.hit_lidar.cast<double>()).cast<float>();
    (r.ring % 2 == 0 ? kept_cam.position : hidden_cam).push_back(p_cam);
  }
  const PointCloud dense_cam = upsample(kept_cam, camera, UpsampleOptions{});
  const RigidMotion T_true_cam = frame.T_true_lidar * camera.T_cam_lidar.inverse();
  for (std::size_t i = kept_cam.size(); i < dense_cam.size(); ++i) {
    const Eigen::Vector3d p = T_true_cam * dense_cam.position[i].cast<double>();
    errors.distance.push_back(static_cast<float>((surfaces.nearest(p).position - p).norm()));
  }
  errors.hidden += hidden_cam.size();
  const KdTree tree(dense_cam.position);
  for (const Eigen::Vector3f& p_cam : hidden_cam) {
    if (tree.nearest(p_cam, kRecovered).squared_distance <= kRecovered * kRecovered) {
      ++errors.recovered;
    }
  }
}

}  // namespace

UpsamplingErrors upsampling_errors(const DriveTruth& truth, const std::vector<PosePair>& frames,
                                   const std::vector<Camera>& cameras,
                                   const SurfaceIndex& surfaces) {
  UpsamplingErrors all;
  all.frames = std::min(kMaxFrames, frames.size());
  std::vector<UpsamplingErrors> parts(all.frames);
  parallel_for(parts.size(), 1, [&](std::size_t k) {
    const PosePair& frame = frames[k * frames.size() / parts.size()];
    const std::vector<TrueReturn> returns = truth.returns(frame.frame);
    for (const Camera& camera : cameras) {
      upsample_scan(returns, frame, camera, surfaces, parts[k]);
    }
  });
  for (const UpsamplingErrors& part : parts) {
    all.distance.insert(all.distance.end(), part.distance.begin(), part.distance.end());
    all.hidden += part.hidden;
    all.recovered += part.recovered;
  }
  return all;
}

}  // namespace fovea
