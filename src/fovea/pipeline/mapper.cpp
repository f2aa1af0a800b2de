#include "fovea/pipeline/mapper.h"

#include <cmath>
#include <limits>

#include "fovea/base/parallel.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/mapping/surface_samples.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/foveal_query.h"
#include "fovea/pipeline/lidar_views.h"

namespace fovea {
namespace {

const Image kNoImage;

/// Samples lie at most this far beyond the foveal region (m).
constexpr double kMargin = 1.0;

/// How well the map foretold an image that it had not seen; of several cameras the mean over all
/// points. Of too few it would be chance.
void note_texture_error(const VisibleMap::Comparison& view, FrameRecord& record) {
  constexpr std::size_t kEnough = 100;
  if (view.points < kEnough) return;
  double& points = record.figures["texture_compared"];
  double& error = record.figures["texture_error"];
  points += as_figure(view.points);
  error += (view.error - error) * as_figure(view.points) / points;
}

/// The points that passed the filter; the others are counted by verdict.
PointCloud keep_visible(const PointCloud& points, const std::vector<RayVerdict>& verdicts,
                        std::map<std::string, double>& figures) {
  std::vector<std::uint32_t> visible;
  std::array<std::size_t, 4> counts{};
  for (std::uint32_t i = 0; i < verdicts.size(); ++i) {
    ++counts[static_cast<std::size_t>(verdicts[i])];
    if (verdicts[i] == RayVerdict::kVisible) visible.push_back(i);
  }
  figures["filter_visible"] += as_figure(counts[std::size_t(RayVerdict::kVisible)]);
  figures["filter_occluding"] += as_figure(counts[std::size_t(RayVerdict::kOccluding)]);
  figures["filter_occluded"] += as_figure(counts[std::size_t(RayVerdict::kOccluded)]);
  figures["filter_shared"] += as_figure(counts[std::size_t(RayVerdict::kShared)]);
  return points.select(visible);
}

/// How far from the LiDAR any stage looks at the map.
double reach_of(const DriveInfo& drive, const MapperOptions& options) {
  double reach = options.moving.remove ? options.moving.range : 0;
  if (options.foveal_enabled) {
    reach = std::max(reach, options.foveal.far_range);
    for (const Camera& camera : drive.calibration.cameras) {
      reach = std::max(reach, foveal_options_of(options, camera.index).far_range);
    }
  }
  return reach + 2 * kMargin;
}

}  // namespace

Mapper::Mapper(const DriveInfo& drive, const MapperOptions& options, PoseSource pose_source,
               BringNear bring_near)
    : drive_(drive),
      options_(suited_to(drive, options)),
      bring_near_(std::move(bring_near)),
      reach_(reach_of(drive, options)),
      tracker_(drive, options_, pose_source),
      dynamic_points_(options.moving),
      map_(options.tile_size) {
  options.validate();
  if (options.surface.spacing > 0) occupancy_.emplace(options.tile_size, options.surface.spacing);
}

FrameRecord Mapper::process(const Frame& frame, bool held_out,
                            const std::optional<RigidMotion>& given_pose) {
  return add(frame, track(frame, held_out, given_pose));
}

TrackedFrame Mapper::track(const Frame& frame, bool held_out,
                           const std::optional<RigidMotion>& given_pose) {
  return tracker_.track(
      frame, held_out, given_pose,
      [&](const PointCloud& scan_lidar, const std::optional<SweepMotion>& motion) {
        return view_scan(scan_lidar, frame, cameras_at_images(frame.index, motion), options_);
      });
}

FrameRecord Mapper::add(const Frame& frame, TrackedFrame tracked) {
  settle_map();
  FrameRecord record = std::move(tracked.record);
  StageClock& clock = tracked.clock;
  clock.add(tracked.views.clock);
  record.figures.merge(tracked.views.figures);
  const PointCloud& scan_lidar = tracked.scan_lidar;
  follow_submaps(tracked.submaps);
  T_odom_local_ = tracked.T_local_odom.inverse();
  bring_near_(map_, record.T_local_lidar.translation(), reach_);

  // Foveal processing, ray filtering and texture mapping, camera by camera.
  if (record.status != FrameStatus::kHeldOut) {
    if (options_.moving.remove) {
      record.figures["moving_removed"] = as_figure(clock.time("filter", [&] {
        return dynamic_points_.observe(map_, *std::move(tracked.views.ranges), record.T_odom_lidar,
                                       T_odom_local_, frame.index);
      }));
    }
    if (options_.foveal_enabled) {
      for (std::size_t k = 0; k < tracked.views.of_camera.size(); ++k) {
        std::optional<ScanView>& view = tracked.views.of_camera[k];
        const Image& image = frame.images.empty() ? kNoImage : frame.images[k];
        if (view) map_view(*std::move(view), image, record, clock);
      }
    } else {
      map_whole_scan(scan_lidar, frame, cameras_at_images(frame.index, tracked.motion),
                     record.T_local_lidar, record, clock);
    }
  }
  record.milliseconds = clock.milliseconds();
  return record;
}

void Mapper::settle_map() {
  if (occupancy_ && added_near_) {
    occupancy_->follow(map_, *added_near_, options_.foveal.far_range + kMargin);
  }
  added_near_.reset();
}

void Mapper::follow_submaps(const std::vector<RigidMotion>& poses) {
  for (std::size_t id = 0; id < poses.size(); ++id) {
    if (id < map_.submaps().size()) {
      map_.move_submap(id, poses[id]);
    } else {
      map_.add_submap(poses[id]);
    }
  }
}

std::vector<Camera> Mapper::cameras_at_images(int index,
                                              const std::optional<SweepMotion>& motion) const {
  if (drive_.calibration.cameras.empty()) return lidar_views();
  std::vector<Camera> cameras;
  for (std::size_t slot = 0; slot < drive_.calibration.cameras.size(); ++slot) {
    cameras.push_back(drive_.camera_at(slot, index).at_image(motion));
  }
  return cameras;
}

PointCloud Mapper::densified(ScanView& view, const RigidMotion& T_local_cam, StageClock& clock) {
  if (view.upsampled) return *std::move(view.upsampled);
  return clock.time("upsample", [&] {
    occupancy_->follow(map_, T_local_cam.translation(), options_.foveal.far_range + kMargin);
    const SampleGrid grid{
        map_.submaps().back().T_local_submap.inverse() * T_local_cam, occupancy_->cell(),
        [&](const Eigen::Vector3d& p) { return occupancy_->taken_before(p); },
        [&](const Eigen::Array3i& brick) { return occupancy_->brick(brick); }, kPositionStep};
    return sample_surface(view.foveal_cam, *view.surface, grid);
  });
}

PointCloud Mapper::filter_rays(const PointCloud& dense_cam, const FovealRegion& region,
                               const RigidMotion& T_local_lidar, FrameRecord& record) {
  const std::vector<Ray> accumulated = map_rays(map_, region, T_local_lidar);
  record.figures["points_map_in_view"] += as_figure(accumulated.size());
  const auto verdicts = ray_filter_.filter(rays_of(dense_cam, region.camera()), accumulated,
                                           region.camera(), options_.ray_filter);
  return keep_visible(dense_cam, verdicts, record.figures);
}

bool Mapper::looks_at_map() const {
  return options_.ray_filter.mode == RayFilterMode::kScan ||
         options_.texture.views == TextureViews::kMean;
}

void Mapper::look_at_map(const FovealRegion& region, const RigidMotion& T_local_lidar) {
  if (!looks_at_map()) return;
  visible_map_.render(map_, region, region.camera().T_cam_lidar * T_local_lidar.inverse(),
                      occupancy_ ? occupancy_->cell() : options_.texture.footprint);
}

PointCloud Mapper::visible_part(PointCloud dense_cam, const FovealRegion& region,
                                const RigidMotion& T_local_lidar, FrameRecord& record) {
  std::vector<std::uint8_t> before;
  if (options_.ray_filter.mode == RayFilterMode::kScan)
    before = visible_map_.find_occluding(dense_cam);
  if (looks_at_map()) visible_map_.add_occluders(dense_cam);
  switch (options_.ray_filter.mode) {
    case RayFilterMode::kPaper:
      return filter_rays(dense_cam, region, T_local_lidar, record);
    case RayFilterMode::kScan:
      record.figures["filter_occluding"] += as_figure(dense_cam.drop(before));
      break;
    case RayFilterMode::kOff:
      break;
  }
  return dense_cam;
}

std::optional<ColorView> Mapper::colors_of(const ScanView& view, FrameRecord& record) const {
  if (!view.pyramid) return std::nullopt;
  ColorView colors{*view.pyramid, view.camera, record.index, options_.texture.footprint};
  const VisibleMap::Comparison before = visible_map_.compare(colors);
  note_texture_error(before, record);
  if (is_exposure_off(before.gain)) {
    colors.gain = matching_gain(before.gain);
    ++record.figures["exposure_off"];
  }
  return colors;
}

void Mapper::map_view(ScanView view, const Image& image, FrameRecord& record, StageClock& clock) {
  const Camera& camera = view.camera;
  const RigidMotion& T_local_lidar = record.T_local_lidar;
  const FovealRegion region(foveal_options_of(options_, camera.index), camera);
  const RigidMotion T_local_cam = T_local_lidar * camera.T_cam_lidar.inverse();

  // What the scan has to add, and what of the map is in view.
  StageClock beside;
  PointCloud dense_cam;
  run_both(
      [&] {
        dense_cam = densified(view, T_local_cam, clock);
        const std::size_t oblique = clock.time(
            "fovea", [&] { return limit_incidence(dense_cam, options_.foveal.max_incidence); });
        record.figures["points_upsampled"] += as_figure(dense_cam.size() + oblique);
        record.figures["points_oblique"] += as_figure(oblique);
      },
      [&] { beside.time("filter", [&] { look_at_map(region, T_local_lidar); }); });
  PointCloud visible_cam = clock.time(
      "filter", [&] { return visible_part(std::move(dense_cam), region, T_local_lidar, record); });

  // Colours of what is known, and of what is new.
  const std::optional<ColorView> colors =
      clock.time("texture", [&] { return colors_of(view, record); });
  std::size_t recolored = 0, moving = 0;
  PointCloud added_local;
  run_both(
      [&] {
        if (!colors || colors->is_exposure_matched()) return;
        recolored = clock.time("texture", [&] { return visible_map_.recolor(map_, *colors); });
      },
      [&] {
        beside.time("texture", [&] {
          if (colors) {
            color_new_points(visible_cam, *colors);
          } else {  // the paper's one view
            color_points(visible_cam, {image, camera, record.index}, options_.texture);
          }
        });
        visible_cam.normal.clear();  // a map has none
        added_local =
            transform_cloud(std::move(visible_cam), T_local_cam, T_local_lidar.translation());
        if (!options_.moving.remove) return;
        moving = beside.time("filter", [&] {
          return added_local.drop(dynamic_points_.classify(added_local, T_odom_local_));
        });
      });
  clock.add(beside);
  if (colors) record.figures["points_recolored"] += as_figure(recolored);
  if (options_.moving.remove) record.figures["filter_moving"] += as_figure(moving);
  clock.time("store", [&] { map_.add(added_local); });
  added_near_ = T_local_cam.translation();
  record.figures["points_added"] += as_figure(added_local.size());
}

void Mapper::map_whole_scan(const PointCloud& scan_lidar, const Frame& frame,
                            const std::vector<Camera>& cameras, const RigidMotion& T_local_lidar,
                            FrameRecord& record, StageClock& clock) {
  clock.time("texture", [&] {
    PointCloud rest_lidar = scan_lidar;
    for (std::size_t slot = 0; slot <= frame.images.size() && !rest_lidar.empty(); ++slot) {
      // Each camera colours what the ones before it have not seen; last, what none has seen.
      const bool last = slot == frame.images.size();
      const Camera& camera = cameras[last ? 0 : slot];
      PointCloud points_cam = transform_cloud(rest_lidar, camera.T_cam_lidar);
      points_cam.normal.assign(points_cam.size(), Eigen::Vector3f::Zero());
      points_cam.interpolated.assign(points_cam.size(), 0);
      points_cam.reason.assign(points_cam.size(), reason_of(PointRule::kMeasured));
      limit_incidence(points_cam, std::numeric_limits<double>::infinity());
      const Image none;
      const bool sees = !last && shows_something(frame.images[slot], record.figures);
      color_points(points_cam, {sees ? frame.images[slot] : none, camera, frame.index},
                   options_.texture);
      std::vector<std::uint32_t> added, unseen;
      for (std::uint32_t i = 0; i < points_cam.size(); ++i) {
        (last || points_cam.camera[i] != kNoCamera ? added : unseen).push_back(i);
      }
      map_.add(transform_cloud(points_cam.select(added),
                               T_local_lidar * camera.T_cam_lidar.inverse(),
                               T_local_lidar.translation()));
      record.figures["points_added"] += as_figure(added.size());
      if (last) record.figures["points_unseen"] += as_figure(added.size());
      rest_lidar = rest_lidar.select(unseen);
    }
  });
}

void Mapper::resume(TileMap map, const std::vector<FrameRecord>& records,
                    const FrameSource& source) {
  map_ = std::move(map);
  const int first_looked_at = first_to_look_through(records),
            first_target = tracker_.first_target(records);
  for (const FrameRecord& record : records) {
    if (record.status == FrameStatus::kSkipped) continue;
    tracker_.follow(record);
    follow_submaps(tracker_.submaps());
    if (record.status == FrameStatus::kHeldOut) continue;
    const bool looked_at = record.index >= first_looked_at;
    const bool is_target = record.index >= first_target && tracker_.is_target();
    if (!looked_at && !is_target && !tracker_.wants_scan()) continue;
    const LoadedFrame frame = source.load(record.index);
    if (!std::holds_alternative<Frame>(frame)) continue;
    replay(std::get<Frame>(frame).scan, record, looked_at);
  }
}

void Mapper::replay(const PointCloud& scan, const FrameRecord& record, bool looked_at) {
  const PointCloud scan_lidar = tracker_.compensated(scan, record.motion);
  tracker_.replay(scan_lidar, record);
  follow_submaps(tracker_.submaps());
  if (looked_at) {
    bring_near_(map_, (tracker_.T_local_odom() * record.T_odom_lidar).translation(), reach_);
    dynamic_points_.replay(map_, RangeImage(scan_lidar.position, options_.moving.row_height),
                           record.T_odom_lidar, tracker_.T_local_odom().inverse(), record.index);
  }
}

int Mapper::first_to_look_through(const std::vector<FrameRecord>& records) {
  constexpr std::size_t kCount = DynamicPointFilter::kVotingScans;
  std::vector<int> mapped;
  for (const FrameRecord& record : records) {
    if (record.status == FrameStatus::kMapped) mapped.push_back(record.index);
  }
  if (mapped.size() <= kCount) return 0;
  return std::min(mapped[mapped.size() - kCount], mapped.back() - DynamicPointFilter::kMemory + 1);
}

}  // namespace fovea
