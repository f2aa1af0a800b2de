#include "fovea/evaluation/predicted_light.h"

namespace fovea {

std::optional<ViewLight> predicted_light(const std::vector<FrameRecord>& frames, int frame,
                                         int camera) {
  std::optional<ViewLight> before, after;
  for (const FrameRecord& record : frames) {
    const ViewRecord* view = record.find_view(camera);
    if (view == nullptr || !view->log2_gain) continue;
    if (record.index < frame) before = view->light();
    if (record.index > frame && !after) after = view->light();
  }
  if (!before || !after) return before ? before : after;
  return ViewLight{(before->gain + after->gain) / 2, before->response};
}

std::vector<Eigen::Vector3f> predicted_colors(const EvaluatedView& view,
                                              const std::vector<Eigen::Vector3f>& map_colors,
                                              const ViewLight& light, const Camera& camera) {
  std::vector<Eigen::Vector3f> colors;
  for (std::size_t i = 0; i < map_colors.size(); ++i) {
    const float s = squared_distance_from_center(camera, view.pixel[i]);
    colors.push_back(
        image_color(map_colors[i].array(), light, s).cwiseMax(0.0f).cwiseMin(255.0f).matrix());
  }
  return colors;
}

}  // namespace fovea
