#include "app/html_report/foveal_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/html_report/markup.h"
#include "fovea/core/angle.h"
#include "fovea/foveal_region.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/rendering/splat.h"
#include "fovea/rendering/viewpoint.h"
#include "fovea/surface_samples.h"
#include "fovea/texture.h"
#include "fovea/upsample.h"

namespace fovea::app {
namespace {

constexpr int kWidth = 640, kHeight = 420, kQuality = 82;
/// From behind, above and to the right of the vehicle, half turned to the region before it.
constexpr Viewpoint kBeside{"beside", 3, 4.5, 25 * kDegree, 56 * kDegree, -3.5, 17 * kDegree};

/// Dark blue over green to yellow ("viridis"): brightness tells the distance without colour vision.
Rgb color_of_range(float range, const FovealOptions& options) {
  static const std::array<Eigen::Vector3f, 5> kStops{
      Eigen::Vector3f(253, 231, 37), {94, 201, 98}, {33, 145, 140}, {59, 82, 139}, {68, 1, 84}};
  const auto near = static_cast<float>(options.near_range);
  const auto far = static_cast<float>(options.far_range);
  const float at = std::clamp((range - near) / (far - near), 0.0f, 0.999f) * (kStops.size() - 1);
  const auto stop = static_cast<std::size_t>(at);
  const float share = at - static_cast<float>(stop);
  return to_rgb((1 - share) * kStops[stop] + share * kStops[stop + 1]);
}

ColoredPoints as_coloured(const PointCloud& points_lidar, const std::vector<LogColor>& color) {
  ColoredPoints points;
  points.position = points_lidar.position;
  points.color = color;
  constexpr std::size_t kRun = 1024;
  points.runs = make_runs(points.position, kRun);
  return points;
}

std::vector<LogColor> range_colors(const PointCloud& points_lidar, const FovealOptions& options) {
  std::vector<LogColor> colors;
  for (const Eigen::Vector3f& p : points_lidar.position) {
    colors.push_back(color_of_range(p.norm(), options));
  }
  return colors;
}

std::string figure(const ColoredPoints& points, const std::vector<float>& spacing,
                   const std::string& alt, const std::string& caption) {
  const Camera camera = viewpoint_camera(kBeside, kWidth, kHeight);
  const SplatView drawn =
      splat(points, spacing, camera, viewpoint_pose(kBeside, RigidMotion::Identity()).inverse());
  return fmt::format(
      "<figure><img alt=\"{}\" width=\"{}\" height=\"{}\" src=\"{}\"/><figcaption>{}</figcaption>"
      "</figure>\n",
      escaped(alt), kWidth, kHeight, jpeg_uri(drawn.image, kQuality), caption);
}

/// As the map's options say, without a map that would have some of it already.
PointCloud densified(const PointCloud& measured_cam, const Camera& camera,
                     const MapSettings& settings, const DriveInfo& drive) {
  if (settings.is_paper()) return upsample(measured_cam, camera, settings.paper().upsample);
  const MapperOptions options = suited_to(drive, settings.mapper());
  const SampleGrid grid{camera.T_cam_lidar.inverse(), options.surface.spacing,
                        [](const Eigen::Vector3d&, int) { return false; }};
  return sample_surfaces(measured_cam, camera, options.surface, grid);
}

std::string what_upsampled(const MapSettings& settings) {
  return settings.is_paper()
             ? fmt::format("at rate {}", settings.paper().upsample.rate)
             : fmt::format("every {:g} cm", 100 * settings.mapper().surface.spacing);
}

}  // namespace

std::string foveal_section(const ScoredMap& map, const FrameSource& drive,
                           const std::vector<PlacedFrame>& training) {
  if (training.empty()) return excuse("No frame was mapped.");
  const PlacedFrame& placed = training[training.size() / 2];
  const std::optional<TrainingFrame> loaded = load_frame(drive, placed);
  if (!loaded) return excuse("The frame could not be loaded again.");
  const std::vector<Image>& images = loaded->frame.images;
  const auto shot =
      std::find_if(images.begin(), images.end(), [](const Image& image) { return !image.empty(); });
  if (shot == images.end()) return excuse("The frame has no image.");
  const auto place = static_cast<std::size_t>(shot - images.begin());
  const Camera camera = drive.info().camera_at(place, placed.index).at_image(placed.motion);
  const MapSettings settings = settings_of(map);
  const FovealOptions& foveal = settings.foveal();
  const FovealRegion region(foveal, camera, lidar_origins(drive.info()));

  const PointCloud measured_cam = foveal_points(loaded->scan_lidar, region);
  if (measured_cam.empty()) return excuse("No point lies in the foveal region.");
  PointCloud dense_cam = densified(measured_cam, camera, settings, info_with_lidars(drive));
  limit_incidence(dense_cam, foveal.max_incidence);
  color_points(dense_cam, {*shot, camera, placed.index});

  const RigidMotion T_lidar_cam = camera.T_cam_lidar.inverse();
  const PointCloud measured = transform_cloud(measured_cam, T_lidar_cam);
  const PointCloud dense = transform_cloud(dense_cam, T_lidar_cam);
  constexpr float kDot = 0.012f;  // m: radius of a point that is to be seen as one
  std::string html = fmt::format(
      "<p>What frame {} gives to the map in camera {}: the points {:g} to {:g} m from the LiDAR, "
      "from behind the vehicle's right shoulder. The first two are coloured by distance, near ones "
      "bright; the last by the photograph, before ray filtering takes away what another view must "
      "not paint.</p>\n<div class=\"strip wide\">\n",
      placed.index, camera.index, foveal.near_range, foveal.far_range);
  html += figure(as_coloured(measured, range_colors(measured, foveal)),
                 std::vector<float>(measured.size(), kDot), "Measured points",
                 fmt::format("<b>As measured</b>: {} points", count(measured.size())));
  html += figure(
      as_coloured(dense, range_colors(dense, foveal)), std::vector<float>(dense.size(), kDot),
      "Upsampled points",
      fmt::format("<b>Upsampled</b> {}: {} points", what_upsampled(settings), count(dense.size())));
  html += figure(as_coloured(dense, dense.color), sample_spacing(dense.position), "Textured points",
                 "<b>Textured</b> from the photograph");
  return html + "</div>\n";
}

}  // namespace fovea::app
