#include "fovea/mapping/calibration/calibration_view.h"

#include "fovea/core/parallel.h"
#include "fovea/geometry/transform_cloud.h"

namespace fovea {

std::optional<ImageMoment> image_moment(const CalibrationView& view, double delay,
                                        const PoseSpline& T_local_lidar) {
  const auto at_stamp = T_local_lidar.at(view.stamp);
  const auto at_image = T_local_lidar.at(view.stamp + from_seconds(delay + view.image_offset));
  if (!at_stamp || !at_image) return std::nullopt;
  return ImageMoment{at_image->T_local_body.inverse() * at_stamp->T_local_body,
                     at_image->T_local_body, at_image->velocity};
}

std::vector<EdgeProfile> profiles_of_views(const std::vector<CalibrationView>& views,
                                           const Camera& camera, const PoseSpline& T_local_lidar) {
  std::vector<std::vector<EdgeProfile>> of_view(views.size());
  parallel_for(views.size(), 1, [&](std::size_t i) {
    const auto moment = image_moment(views[i], camera.image_delay, T_local_lidar);
    if (!moment) return;
    EdgeView view{camera, moment->velocity, moment->T_local_lidar, views[i].frame};
    view.camera.image_delay = 0;  // the edges are where they are at the image
    std::vector<LidarEdges> edges_lidar = views[i].edges_lidar;
    for (LidarEdges& edges : edges_lidar) {
      edges.inside = transform_cloud(std::move(edges.inside), moment->T_image_stamp);
      edges.outside = transform_cloud(std::move(edges.outside), moment->T_image_stamp);
    }
    of_view[i] = profiles_of_lidars(edges_lidar, views[i].image, view);
    std::erase_if(of_view[i], [&](const EdgeProfile& profile) {
      return views[i].is_masked(profile.pixel.cast<double>());
    });
  });
  std::vector<EdgeProfile> all;
  for (const auto& profiles : of_view) all.insert(all.end(), profiles.begin(), profiles.end());
  return all;
}

}  // namespace fovea
