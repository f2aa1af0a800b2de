#include "fovea/mapping/response_estimate.h"

#include <bit>

#include "fovea/mapping/view_colors.h"

namespace fovea {
namespace {

constexpr std::size_t kViewsBetween = 5;              // half a second at 10 Hz
constexpr std::size_t kFirstFit = 5, kLastFit = 160;  // pairs
constexpr std::size_t kPointsOfView = 1500;

bool can_be_compared(const PointInImage& point) {
  return point.value.minCoeff() >= kDarkValue && point.value.maxCoeff() < kSaturatedValue;
}

/// The points that are in view as the image shows them; f(i, seen) for each.
template <class F>
void for_each_seen(const std::vector<Eigen::Vector3d>& points_cam, const ImagePyramid& image,
                   const Camera& camera, double footprint, F&& f) {
  for (std::size_t i = 0; i < points_cam.size(); ++i) {
    const auto pixel = camera.project(points_cam[i]);
    if (!pixel || !camera.in_view(*pixel)) continue;
    const float u = float(pixel->x()), v = float(pixel->y());
    const float width = float(footprint * camera.fx / points_cam[i].z());
    ColorBlock color;
    image.colors_at({&u, 1}, {&v, 1}, {&width, 1}, color);
    f(i, PointInImage{{color.red[0], color.green[0], color.blue[0]},
                      squared_distance_from_center(camera, *pixel)});
  }
}

}  // namespace

bool ResponseEstimate::is_finished() const { return pairs_ >= kLastFit; }

void ResponseEstimate::resume(std::size_t images, const CameraResponse& response) {
  if (images < kViewsBetween + kLastFit) return;
  pairs_ = kLastFit;
  response_ = response;
}

void ResponseEstimate::add(const std::vector<Eigen::Vector3f>& points_cam,
                           const ImagePyramid& image, const Camera& camera,
                           const RigidMotion& T_odom_cam, double footprint) {
  if (is_finished()) return;
  if (views_.size() == kViewsBetween) {
    const View& before = views_.front();
    std::vector<Eigen::Vector3d> now_cam;
    now_cam.reserve(before.points_odom.size());
    const RigidMotion T_cam_odom = T_odom_cam.inverse();
    for (const Eigen::Vector3d& p : before.points_odom) now_cam.push_back(T_cam_odom * p);
    std::vector<SharedPoint> pair;
    for_each_seen(now_cam, image, camera, footprint, [&](std::size_t i, const PointInImage& seen) {
      if (can_be_compared(seen)) pair.push_back({before.seen[i], seen});
    });
    views_.pop_front();
    fit_.add(pair);
    ++pairs_;
    const std::size_t times = pairs_ / kFirstFit;  // the first fit's pairs
    if (pairs_ % kFirstFit == 0 && std::has_single_bit(times)) response_ = fit_.response();
  }
  std::vector<Eigen::Vector3d> chosen_cam;
  const std::size_t step = points_cam.size() / kPointsOfView + 1;
  for (std::size_t i = 0; i < points_cam.size(); i += step) {
    chosen_cam.push_back(points_cam[i].cast<double>());
  }
  View& view = views_.emplace_back();
  for_each_seen(chosen_cam, image, camera, footprint, [&](std::size_t i, const PointInImage& seen) {
    if (!can_be_compared(seen)) return;
    view.points_odom.push_back(T_odom_cam * chosen_cam[i]);
    view.seen.push_back(seen);
  });
}

}  // namespace fovea
