#include "fovea/pipeline/mapper.h"

#include <algorithm>
#include <utility>

#include "fovea/core/angle.h"
#include "fovea/core/parallel.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/mapping/blank_image.h"
#include "fovea/mapping/scan_projection.h"
#include "fovea/mapping/view_colors.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/replaced_points.h"
#include "fovea/pipeline/scan_geometry.h"
#include "fovea/surface_samples.h"
#include "fovea/texture.h"

namespace fovea {
namespace {

const Image kNoImage;
constexpr double kMargin = 1;  // m: samples may lie beyond the foveal region

/// Points of the map are ground from this share of the LiDAR's height below it.
constexpr double kLow = 0.7;

double reach_of(const MapperOptions& options, double foveal_reach) {
  const double dynamic = options.dynamic.remove ? options.dynamic.range : 0;
  return std::max(dynamic, foveal_reach) + 2 * kMargin;  // cells, and a margin for them
}

std::optional<double> exposure_of(const Frame& frame, std::size_t slot) {
  return slot < frame.image_exposures.size() ? frame.image_exposures[slot] : std::nullopt;
}

std::vector<Eigen::Vector3f> marked(const std::vector<Eigen::Vector3f>& points,
                                    const std::vector<std::uint8_t>& marks) {
  std::vector<Eigen::Vector3f> chosen;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (marks[i] != 0) chosen.push_back(points[i]);
  }
  return chosen;
}

}  // namespace

Mapper::Mapper(const DriveInfo& drive, const MapperOptions& options, PoseSource pose_source,
               MapperServices services)
    : drive_(drive),
      options_(suited_to(drive, options)),
      services_(std::move(services)),
      lidar_origins_(lidar_origins(drive)),
      foveal_reach_(options.foveal.reach() + farthest_lidar(lidar_origins_)),
      reach_(reach_of(options, foveal_reach_)),
      ground_below_(kLow * lidar_height(drive)),
      tracker_(drive, options_, pose_source, services_.initial_velocity),
      map_(options.tile_size),
      dynamic_points_(options_.dynamic),
      occupancy_(options.tile_size, options.surface.spacing) {}

TrackedScan Mapper::track(const Frame& frame, const FrameTask& task) {
  return tracker_.track(frame, task);
}

FrameResult Mapper::map_frame(const Frame& frame, TrackedScan tracked) {
  FrameResult result = std::move(tracked.result);
  result.clock.start();
  apply_deferred_mapping();  // before points are removed, see Occupancy::follow
  map_.place_submaps(tracked.submaps);
  light_.follow(std::size_t(result.poses.submap), result.poses.T_odom_lidar, map_);
  services_.load_near(map_, result.poses.T_local_lidar.translation(), reach_);
  result.skips_texture = tracked.task.skips_texture;
  if (tracked.task.held_out || result.skips_texture) return result;

  const RigidMotion T_odom_local = tracked.T_local_odom.inverse();
  const std::vector<Camera> cameras = frame_cameras(drive_, frame, result.poses.motion);
  // One frame later than the periphery, so that the slowest frames do less.
  if (frame_before_has_periphery_) remove_replaced(cameras, result);
  const bool with_periphery = periphery_is_due(result.poses.T_odom_lidar);
  result.clock.lap("filter");
  if (options_.dynamic.remove) {
    // 6 for the map: points leave where this scan and those before it see free space.
    result.dynamic.emplace().removed =
        dynamic_points_.observe(map_, sensor_views(tracked.scan_lidar, drive_),
                                result.poses.T_odom_lidar, T_odom_local, frame.index);
    result.clock.lap("filter");
  }
  const bool has_image = !frame.images.empty();  // a LiDAR without cameras has views alone
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    if (has_image && !has_content(frame.images[k], result)) continue;
    map_view(tracked.scan_lidar, {has_image ? frame.images[k] : kNoImage, exposure_of(frame, k)},
             FovealRegion(foveal_options(with_periphery), cameras[k], lidar_origins_), T_odom_local,
             result);
  }
  return result;
}

void Mapper::remove_replaced(const std::vector<Camera>& cameras, const FrameResult& result) {
  const RigidMotion& T_local_lidar = result.poses.T_local_lidar;
  occupancy_.follow(map_, T_local_lidar.translation(), foveal_reach_ + kMargin);
  for (const Camera& camera : cameras) {
    remove_replaced_points(map_, occupancy_, camera, T_local_lidar * camera.T_cam_lidar.inverse(),
                           foveal_reach_, result.index, dynamic_points_);
  }
}

bool Mapper::periphery_is_due(const RigidMotion& T_odom_lidar) {
  constexpr double kDistance = 1.5, kAngle = 5 * kDegree;  // m, rad
  frame_before_has_periphery_ = false;
  if (last_periphery_odom_) {
    const RigidMotion moved = last_periphery_odom_->inverse() * T_odom_lidar;
    const double angle = Eigen::AngleAxisd(moved.linear()).angle();
    if (moved.translation().norm() < kDistance && angle < kAngle) return false;
  }
  last_periphery_odom_ = T_odom_lidar;
  frame_before_has_periphery_ = options_.foveal.periphery_range > options_.foveal.far_range;
  return frame_before_has_periphery_;
}

FovealOptions Mapper::foveal_options(bool with_periphery) const {
  FovealOptions foveal = options_.foveal;
  if (!with_periphery) foveal.periphery_range = 0;
  return foveal;
}

void Mapper::map_view(const PointCloud& scan_lidar, const ViewImage& view,
                      const FovealRegion& region, const RigidMotion& T_odom_local,
                      FrameResult& result) {
  const Image& image = view.image;
  const Camera& camera = region.camera();
  const RigidMotion& T_local_lidar = result.poses.T_local_lidar;
  const RigidMotion T_local_cam = T_local_lidar * camera.T_cam_lidar.inverse();
  FovealStats& stats = stats_of(result.foveal);
  PointCloud visible_cam, new_cam;
  std::optional<ImagePyramid> pyramid;
  run_both(
      [&] {
        // 3. Visible points: in the foveal region, not hidden by another point of the scan.
        visible_cam = foveal_points(scan_lidar, region);
        stats.measured += visible_cam.size();
        result.clock.lap("fovea");
        stats_of(result.hidden) += drop_hidden(visible_cam, scan_lidar, camera);
        // 4. Surface samples, in cells of the map's grid that have no point yet.
        new_cam = new_points_of(visible_cam, camera, T_local_cam);
        stats.upsampled += new_cam.size();
        stats.oblique += limit_incidence(new_cam, options_.foveal.max_incidence);
      },
      [&] {  // In parallel, on other data: what steps 5 to 7 compare with.
        visible_map_.render(map_, region, T_local_cam.inverse(), occupancy_.cell());
        if (!image.empty()) pyramid.emplace(image);
      });
  result.clock.lap("upsample");
  // 5. Points in front of the map: a new object hides the surface.
  const std::vector<std::uint8_t> is_occluding = visible_map_.find_occluding(new_cam);
  visible_map_.add_occluders(new_cam);  // also the dropped ones: a passing object hides the map
  stats.occluding += new_cam.drop(is_occluding);
  // 6. Dynamic points: new points where other scans see free space.
  PointCloud placed;
  placed.position = new_cam.position;
  placed = transform_cloud(std::move(placed), T_local_cam, T_local_lidar.translation());
  if (pyramid) visible_map_.find_edges();
  if (options_.dynamic.remove) {
    const std::vector<std::uint8_t> is_dynamic = dynamic_points_.classify(placed, T_odom_local);
    visible_map_.doubt_around(marked(new_cam.position, is_dynamic));
    placed.drop(is_dynamic);
    result.dynamic->dropped += new_cam.drop(is_dynamic);
  }
  result.clock.lap("filter");

  if (pyramid) {
    color_view(visible_cam, *pyramid, view.exposure, camera, new_cam, result);
  } else {
    color_points(new_cam, {image, camera, result.index});  // no image: empty columns
  }
  result.clock.lap("texture");
  new_cam.normal.clear();  // a map has none
  new_cam.origin = placed.origin;
  new_cam.position = std::move(placed.position);
  // 9. Add.
  map_.add(new_cam);
  occupancy_update_center_ = T_local_cam.translation();
  stats_of(result.added) += new_cam.size();
  result.clock.lap("store");
}

void Mapper::color_view(const PointCloud& visible_cam, const ImagePyramid& image,
                        std::optional<double> exposure, const Camera& camera, PointCloud& new_cam,
                        FrameResult& result) {
  const ImageMask* mask = drive_.mask(camera.index);
  const ViewColors image_colors(image, camera, options_.footprint, mask);
  // 7. Light: the response of the camera, and the gain of the image.
  light_.learn_response(unmasked(visible_cam.position, camera, mask), image, camera,
                        result.poses.T_odom_lidar * camera.T_cam_lidar.inverse(),
                        options_.footprint);
  const ViewColors colors =
      image_colors.in_light(find_light(image_colors, exposure, camera.index, result));
  // 8. Colors in the exposure of the map: known points fuse one more view, new ones get a first.
  std::size_t& recolored = stats_of(result.colors).recolored;
  run_both([&] { recolored += visible_map_.recolor(map_, colors, result.index); },
           [&] {
             color_new_points(new_cam, colors, camera, &visible_map_.depth(), result.index,
                              map_.submaps().back().log2_gain);
           });
}

ViewLight Mapper::find_light(const ViewColors& image_colors, std::optional<double> exposure,
                             int camera, FrameResult& result) {
  constexpr std::size_t kEnough = 100;  // of fewer points the error is chance
  const ViewColors colors = image_colors.in_light({LogGain::Zero(), light_.response(camera)});
  const MapDifferences differences = visible_map_.differences(colors, ground_below_);
  ColorStats& stats = stats_of(result.colors);
  stats.views.push_back(light_.next(camera, differences, exposure, map_));
  const ViewLight light = light_.light(stats.views.back(), map_.submaps().size() - 1);
  const std::size_t compared = differences.recent.size();
  if (compared >= kEnough) {
    stats.compared += compared;
    stats.error += (residual_percent(differences.recent, light.gain) - stats.error) *
                   double(compared) / double(stats.compared);
  }
  return light;
}

PointCloud Mapper::new_points_of(const PointCloud& points_cam, const Camera& camera,
                                 const RigidMotion& T_local_cam) {
  occupancy_.follow(map_, T_local_cam.translation(), foveal_reach_ + kMargin);
  const SampleGrid grid{
      map_.submaps().back().T_local_submap.inverse() * T_local_cam, occupancy_.cell(),
      [&](const Eigen::Vector3d& p, int level) { return occupancy_.holds_point(p, level, level); },
      kPositionStep};
  return sample_surfaces(points_cam, camera, options_.surface, grid);
}

void Mapper::apply_deferred_mapping() {
  if (occupancy_update_center_) {
    occupancy_.follow(map_, *occupancy_update_center_, foveal_reach_ + kMargin);
  }
  occupancy_update_center_.reset();
}

}  // namespace fovea
