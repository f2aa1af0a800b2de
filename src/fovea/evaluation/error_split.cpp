#include "fovea/evaluation/error_split.h"

#include <limits>

namespace fovea {

void ErrorSplit::append(const ErrorSplit& other) {
  points += other.points;
  total += other.total;
  sampling += other.sampling;
  same_place += other.same_place;
}

double ErrorSplit::mean(double sum) const {
  return points > 0 ? sum / static_cast<double>(points) : std::numeric_limits<double>::quiet_NaN();
}

ErrorSplit split_errors(const EvaluatedView& view, const std::vector<Eigen::Vector3d>& nearest_cam,
                        const std::vector<Eigen::Vector3f>& nearest_color, const Camera& camera,
                        const Image& image) {
  ErrorSplit split;
  for (std::size_t i = 0; i < view.color.size(); ++i) {
    const auto pixel = scored_pixel(camera, nearest_cam[i]);
    if (!pixel) continue;
    const Eigen::Vector3f photograph = bilinear(image, pixel->x(), pixel->y());
    ++split.points;
    split.total += color_error(view.color[i], nearest_color[i], view.grey);
    split.sampling += color_error(view.color[i], photograph, view.grey);
    split.same_place += color_error(photograph, nearest_color[i], view.grey);
  }
  return split;
}

}  // namespace fovea
