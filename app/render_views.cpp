#include "app/render_views.h"

#include <CLI/Error.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <sstream>

#include "app/html_report/viewpoint.h"
#include "fovea/core/angle.h"

namespace fovea::app {
namespace {

/// "1,2,3"; CLI::ValidationError for anything else.
Eigen::Vector3d parse_place(const std::string& text, const char* option) {
  Eigen::Vector3d place;
  char comma1 = 0, comma2 = 0, more = 0;
  std::istringstream in(text);
  in >> place.x() >> comma1 >> place.y() >> comma2 >> place.z();
  if (!in || comma1 != ',' || comma2 != ',' || in >> more || !place.allFinite()) {
    throw CLI::ValidationError(option, "a place in the map's local frame, m: X,Y,Z");
  }
  return place;
}

}  // namespace

PlacedCamera free_camera(const std::string& from_text, const std::string& to_text, int width,
                         int height) {
  const Eigen::Vector3d from = parse_place(from_text, "--from");
  const Eigen::Vector3d to = parse_place(to_text, "--to");
  if (from == to) throw CLI::ValidationError("--to", "another place than --from");
  const Viewpoint view{"free", 0, 0, 0, 75 * kDegree};
  return {viewpoint_camera(view, width, height), pose_looking_at(from, to)};
}

PlacedCamera above_map(const PointCloud& points, int width, int height) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : points.position) box.extend(points.origin + p.cast<double>());
  const Viewpoint view{"map", 0, 0, 0, 20 * kDegree};  // narrow: nearly without perspective
  const Camera camera = viewpoint_camera(view, width, height);
  const Eigen::Vector3d size = box.sizes();
  const double distance = camera.fx * std::max(size.x() / width, size.y() / height);
  constexpr double kMargin = 1.02;
  const Eigen::Vector3d middle = box.center();
  const Eigen::Vector3d eye(middle.x(), middle.y(),
                            box.max().z() + std::max(1.0, kMargin * distance));
  return {camera, pose_looking_at(eye, middle)};
}

}  // namespace fovea::app
