#include "app/html_report/map_picture.h"

#include <fmt/format.h>

#include "app/html_report/markup.h"
#include "fovea/core/angle.h"
#include "fovea/rendering/viewpoint.h"

namespace fovea::app {

std::string picture_from_behind(const ColoredPoints& points, const std::vector<float>& spacing,
                                const RigidMotion& T_local_lidar, const std::string& alt,
                                const ColorDisplay& display) {
  constexpr Viewpoint kBehind{"behind", 9, 5, 20 * kDegree, 75 * kDegree};
  constexpr int kWidth = 1280, kHeight = 620, kQuality = 80;
  const Camera camera = viewpoint_camera(kBehind, kWidth, kHeight);
  const SplatView drawn =
      splat(points, spacing, camera, viewpoint_pose(kBehind, T_local_lidar).inverse(),
            {.display = display, .max_radius = 20});
  return fmt::format("<img alt=\"{}\" width=\"{}\" height=\"{}\" src=\"{}\"/>", escaped(alt),
                     kWidth, kHeight, jpeg_uri(drawn.image, kQuality));
}

std::string hero_picture(const ScoredMap& map, const Scorer& scorer) {
  if (map.frames.empty()) return "";
  const FrameRecord& middle = map.frames[map.frames.size() / 2];
  return picture_from_behind(
      scorer.coloured(), scorer.spacing(), middle.T_local_lidar,
      fmt::format("The map from behind the vehicle at frame {}", middle.index),
      color_display({}, map.frames));
}

}  // namespace fovea::app
