#include "fovea/evaluation/evaluated_set.h"

#include <stdexcept>

#include "fovea/deskew.h"

namespace fovea {

std::optional<Eigen::Vector2d> scored_pixel(const Camera& camera, const Eigen::Vector3d& p_cam) {
  if (!(p_cam.z() > kEvaluatedDepth)) return std::nullopt;
  const std::optional<Eigen::Vector2d> pixel = camera.project(p_cam);
  if (!pixel) return std::nullopt;
  const bool inside = pixel->x() >= 0 && pixel->x() < camera.width - 1 && pixel->y() >= 0 &&
                      pixel->y() < camera.height - 1;
  return inside ? pixel : std::nullopt;
}

EvaluatedView select(const EvaluatedView& view, const std::vector<std::uint8_t>& marks) {
  EvaluatedView selected{view.frame, view.camera, view.grey, {}, {}, {}, {}};
  for (std::size_t i = 0; i < view.position.size(); ++i) {
    if (marks[i] == 0) continue;
    selected.position.push_back(view.position[i]);
    selected.color.push_back(view.color[i]);
    selected.pixel.push_back(view.pixel[i]);
    selected.scan_index.push_back(view.scan_index[i]);
  }
  return selected;
}

EvaluatedView without_masked(const EvaluatedView& view, const ImageMask* mask) {
  if (mask == nullptr) return view;
  std::vector<std::uint8_t> is_seen;
  for (const Eigen::Vector2d& pixel : view.pixel) {
    constexpr float kNeighbor = 0.5f;  // of the interpolation, pixels
    is_seen.push_back(mask->covers(float(pixel.x()), float(pixel.y()), kNeighbor) ? 0 : 1);
  }
  return select(view, is_seen);
}

PointCloud compensated_scan(const PointCloud& scan_lidar, const PlacedFrame& placed,
                            const DriveInfo& drive) {
  PointCloud compensated;
  compensated.position = scan_lidar.position;
  compensated.sensor = scan_lidar.sensor;
  if (placed.motion && !drive.sweep_compensated) {
    compensated.time = scan_lidar.time;
    compensate_sweep(compensated, *placed.motion, drive.sweep);
  }
  return compensated;
}

EvaluatedView evaluated_view(const PointCloud& measured_lidar, const PointCloud& compensated_lidar,
                             const PlacedFrame& placed, const Camera& camera, const Image& image,
                             const Eigen::Vector3d& origin_local, const RangeBand& band) {
  if (measured_lidar.size() != compensated_lidar.size()) {
    throw std::invalid_argument("the measured and the compensated scan differ in length");
  }
  if (image.width != camera.width || image.height != camera.height) {
    throw std::invalid_argument("the image is not of its camera's size");
  }
  EvaluatedView view{placed.index, camera.index, image.channels == 1, {}, {}, {}, {}};
  for (std::size_t i = 0; i < measured_lidar.size(); ++i) {
    const float range = measured_lidar.position[i].norm();
    if (!(range > band.near && range < band.far)) continue;
    const Eigen::Vector3d p_lidar = compensated_lidar.position[i].cast<double>();
    const std::optional<Eigen::Vector2d> pixel =
        scored_pixel(camera, Eigen::Vector3d(camera.T_cam_lidar * p_lidar));
    if (!pixel) continue;
    view.position.push_back((placed.T_local_lidar * p_lidar - origin_local).cast<float>());
    view.color.push_back(bilinear(image, pixel->x(), pixel->y()));
    view.pixel.push_back(*pixel);
    view.scan_index.push_back(static_cast<std::uint32_t>(i));
  }
  return view;
}

}  // namespace fovea
