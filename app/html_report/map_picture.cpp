#include "app/html_report/map_picture.h"

#include <fmt/format.h>

#include "app/html_report/markup.h"
#include "app/html_report/viewpoint.h"
#include "fovea/base/angle.h"

namespace fovea::app {

std::string hero_picture(const ScoredMap& map, const Scorer& scorer) {
  constexpr Viewpoint kBehind{"behind", 9, 5, 20 * kDegree, 75 * kDegree};
  constexpr int kWidth = 1280, kHeight = 620, kQuality = 80;
  if (map.frames.empty()) return "";
  const FrameRecord& middle = map.frames[map.frames.size() / 2];
  const Camera camera = viewpoint_camera(kBehind, kWidth, kHeight);
  const SplatView drawn =
      splat(scorer.coloured(), scorer.spacing(), camera,
            viewpoint_pose(kBehind, middle.T_local_lidar).inverse(), {.max_radius = 20});
  return fmt::format(
      "<img alt=\"The map from behind the vehicle at frame {}\" width=\"{}\" height=\"{}\" "
      "src=\"{}\"/>",
      middle.index, kWidth, kHeight, jpeg_uri(drawn.image, kQuality));
}

}  // namespace fovea::app
