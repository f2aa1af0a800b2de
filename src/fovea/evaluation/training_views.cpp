#include "fovea/evaluation/training_views.h"

#include <cmath>
#include <set>

#include "fovea/rendering/splat.h"

namespace fovea {
namespace {

/// How far behind the front surface a point still counts as on it: noise, and what the surface
/// slants within a pixel (the road at 15 m: 0.2 m a row).
constexpr float kToleranceFixed = 0.10f;    // m
constexpr float kToleranceOfDepth = 0.02f;  // of the depth

}  // namespace

std::vector<FrameRecord> training_frames(const ScoredMap& map, const DriveInfo& drive,
                                         const std::vector<PlacedFrame>& scored,
                                         const HoldOut& hold_out) {
  std::set<int> held_out;
  for (const PlacedFrame& placed : scored) held_out.insert(placed.index);
  std::vector<FrameRecord> frames;
  for (const FrameRecord& record : map.frames) {
    if (record.status != FrameStatus::kMapped || hold_out.contains(record.index)) continue;
    if (held_out.contains(record.index)) continue;
    if (record.index >= drive.begin && record.index < drive.end) frames.push_back(record);
  }
  return frames;
}

std::vector<TrainingView> load_training_views(const FrameSource& drive, const FrameRecord& record,
                                              const std::vector<std::size_t>& cameras,
                                              const ColoredPoints& points,
                                              const std::vector<float>& spacing, TimeNs first) {
  LoadedFrame loaded = drive.load(record.index);
  if (!std::holds_alternative<Frame>(loaded)) return {};
  Frame& frame = std::get<Frame>(loaded);
  SplatOptions options;
  options.min_depth = kEvaluatedDepth;
  options.max_depth = kViewReach;
  std::vector<TrainingView> views;
  for (const std::size_t place : cameras) {
    if (frame.images.at(place).empty()) continue;
    TrainingView view;
    view.camera = drive.info().camera_at(place, record.index).at_image(record.motion);
    view.T_cam_local = view.camera.T_cam_lidar * record.T_local_lidar.inverse();
    view.image = std::move(frame.images.at(place));
    view.depth = splat(points, spacing, view.camera, view.T_cam_local, options).depth;
    view.time = static_cast<float>(seconds(frame.stamp - first));
    views.push_back(std::move(view));
  }
  return views;
}

std::optional<ColorObservation> observation_of(const TrainingView& view,
                                               const Eigen::Isometry3f& T_cam_map,
                                               const Eigen::Vector3f& p,
                                               const Eigen::Vector3f& normal) {
  const Eigen::Vector3f p_cam = T_cam_map * p;
  const float distance = p_cam.norm();
  if (!(distance < kViewReach)) return std::nullopt;
  const auto pixel = scored_pixel(view.camera, p_cam.cast<double>());
  if (!pixel) return std::nullopt;
  const auto column = static_cast<std::size_t>(std::lround(pixel->x()));
  const auto row = static_cast<std::size_t>(std::lround(pixel->y()));
  const float front = view.depth[row * static_cast<std::size_t>(view.camera.width) + column];
  ColorObservation seen;
  seen.color = to_rgb(bilinear(view.image, pixel->x(), pixel->y()));
  seen.distance = distance;
  if (normal.squaredNorm() > 0.5f) {
    seen.cos_incidence = std::abs((T_cam_map.linear() * normal).dot(p_cam)) / distance;
  }
  seen.time = view.time;
  seen.visible = p_cam.z() <= front + kToleranceFixed + kToleranceOfDepth * p_cam.z();
  return seen;
}

}  // namespace fovea
