#include "fovea/pipeline/mapper.h"

#include <cmath>
#include <limits>

#include "fovea/geometry/transform_cloud.h"
#include "fovea/mapping/texture.h"
#include "fovea/mapping/upsample.h"
#include "fovea/pipeline/foveal_query.h"
#include "fovea/sensor/motion_compensation.h"

namespace fovea {
namespace {

double as_figure(std::size_t count) { return static_cast<double>(count); }

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

}  // namespace

Mapper::Mapper(const DriveInfo& drive, const MapperOptions& options, PoseSource pose_source)
    : drive_(drive),
      options_(options),
      pose_source_(pose_source),
      motion_model_(drive.navigation ? &*drive.navigation : nullptr,
                    options.interpolate_navigation),
      refiner_(options.refinement, drive.calibration.cameras),
      moving_things_(options.moving),
      map_(options.tile_size) {
  options.validate();
}

FrameRecord Mapper::process(const Frame& frame, bool held_out,
                            const std::optional<RigidMotion>& given_pose) {
  StageClock clock;
  FrameRecord record;
  record.index = frame.index;
  record.stamp = frame.stamp;
  record.status = held_out ? FrameStatus::kHeldOut : FrameStatus::kMapped;
  record.figures["points_scan"] = as_figure(frame.scan.size());
  record.figures["points_dropped"] = as_figure(frame.dropped_points);

  // Where are we, and how do we move?
  const TimeNs sweep_end = frame.stamp + from_seconds(drive_.sweep_period / 2);
  const MotionPrediction motion = motion_model_.predict(frame.stamp, sweep_end);
  record.T_local_lidar_navigation = motion.T_local_lidar_navigation;
  if (options_.compensate_motion && !drive_.sweep_compensated) record.velocity = motion.velocity;
  const PointCloud scan_lidar =
      clock.time("register", [&] { return compensated(frame.scan, record.velocity); });

  // Pose refinement.
  record.T_local_lidar = pose_of(scan_lidar, motion, held_out, given_pose, record, clock);
  motion_model_.update(frame.stamp, record.T_local_lidar);

  // Foveal processing, ray filtering and texture mapping, camera by camera.
  if (!held_out) {
    open_submap_if_due(frame.stamp, record.T_local_lidar);
    if (options_.moving.remove) {
      record.figures["moving_removed"] = as_figure(clock.time("filter", [&] {
        return moving_things_.observe(map_, scan_lidar, record.T_local_lidar, frame.index);
      }));
    }
    cameras_.clear();
    for (const Camera& camera : drive_.calibration.cameras) {
      cameras_.push_back(camera.at_image(motion.velocity));
    }
    if (options_.foveal_enabled) {
      for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
        map_camera(scan_lidar, frame, camera, record.T_local_lidar, record, clock);
      }
    } else {
      map_whole_scan(scan_lidar, frame, record.T_local_lidar, record, clock);
    }
  }
  record.milliseconds = clock.milliseconds();
  return record;
}

PointCloud Mapper::compensated(const PointCloud& scan, const std::optional<Twist>& velocity) const {
  PointCloud scan_lidar = scan;
  if (velocity) compensate_sweep(scan_lidar, *velocity, drive_.sweep_period);
  return scan_lidar;
}

RigidMotion Mapper::pose_of(const PointCloud& scan_lidar, const MotionPrediction& motion,
                            bool held_out, const std::optional<RigidMotion>& given_pose,
                            FrameRecord& record, StageClock& clock) {
  if (pose_source_ == PoseSource::kGiven) return given_pose.value();
  if (pose_source_ == PoseSource::kNavigation) {
    return motion.T_local_lidar_navigation.value_or(motion.T_local_lidar);
  }
  RefinedPose refined =
      refiner_.refine(scan_lidar, motion.T_local_lidar, /*as_target=*/!held_out, clock);
  record.note = std::move(refined.note);
  record.figures.merge(refined.figures);
  return refined.T_local_lidar;
}

void Mapper::open_submap_if_due(TimeNs stamp, const RigidMotion& T_local_lidar) {
  if (submap_start_ && seconds(stamp - *submap_start_) < options_.submap_duration) return;
  submap_start_ = stamp;
  map_.add_submap(T_local_lidar);
}

void Mapper::map_camera(const PointCloud& scan_lidar, const Frame& frame, std::size_t camera_slot,
                        const RigidMotion& T_local_lidar, FrameRecord& record, StageClock& clock) {
  const Camera& camera = cameras_[camera_slot];
  const FovealRegion region(foveal_options_of(options_, camera.index), camera);
  const PointCloud foveal_cam = clock.time("fovea", [&] {
    const PointCloud points_cam = transform_cloud(scan_lidar, camera.T_cam_lidar);
    return points_cam.select(foveal_points(points_cam, region));
  });
  PointCloud dense_cam =
      clock.time("upsample", [&] { return upsample(foveal_cam, camera, options_.upsample); });
  const std::size_t oblique = clock.time(
      "fovea", [&] { return limit_incidence(dense_cam, options_.foveal.max_incidence); });

  const std::vector<Ray> accumulated =
      clock.time("filter", [&] { return map_rays(map_, region, T_local_lidar); });
  PointCloud visible_cam = clock.time("filter", [&] {
    const auto verdicts =
        ray_filter_.filter(rays_of(dense_cam, camera), accumulated, camera, options_.ray_filter);
    return keep_visible(dense_cam, verdicts, record.figures);
  });
  clock.time("texture", [&] {
    colour_points(visible_cam, {frame.images[camera_slot], camera, frame.index}, options_.texture);
  });
  PointCloud added_local = transform_cloud(
      visible_cam, T_local_lidar * camera.T_cam_lidar.inverse(), T_local_lidar.translation());
  if (options_.moving.remove) {
    added_local = clock.time("filter", [&] { return keep_still(added_local, record.figures); });
  }
  clock.time("store", [&] { map_.add(added_local); });

  record.figures["points_foveal"] += as_figure(foveal_cam.size());
  record.figures["points_upsampled"] += as_figure(dense_cam.size() + oblique);
  record.figures["points_oblique"] += as_figure(oblique);
  record.figures["points_map_in_view"] += as_figure(accumulated.size());
  record.figures["points_added"] += as_figure(added_local.size());
}

PointCloud Mapper::keep_still(const PointCloud& points_local,
                              std::map<std::string, double>& figures) const {
  const std::vector<std::uint8_t> moving = moving_things_.marks(points_local);
  std::vector<std::uint32_t> still;
  for (std::uint32_t i = 0; i < moving.size(); ++i) {
    if (moving[i] == 0) still.push_back(i);
  }
  figures["filter_moving"] += as_figure(moving.size() - still.size());
  return points_local.select(still);
}

void Mapper::map_whole_scan(const PointCloud& scan_lidar, const Frame& frame,
                            const RigidMotion& T_local_lidar, FrameRecord& record,
                            StageClock& clock) {
  clock.time("texture", [&] {
    PointCloud rest_lidar = scan_lidar;
    for (std::size_t slot = 0; slot <= frame.images.size() && !rest_lidar.empty(); ++slot) {
      // Each camera colours what the ones before it have not seen; last, what none has seen.
      const bool last = slot == frame.images.size();
      const Camera& camera = cameras_[last ? 0 : slot];
      PointCloud points_cam = transform_cloud(rest_lidar, camera.T_cam_lidar);
      points_cam.normal.assign(points_cam.size(), Eigen::Vector3f::Zero());
      points_cam.interpolated.assign(points_cam.size(), 0);
      limit_incidence(points_cam, std::numeric_limits<double>::infinity());
      colour_points(points_cam, {frame.images[last ? 0 : slot], camera, frame.index},
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
  std::vector<const FrameRecord*> targets;
  for (const FrameRecord& record : records) {
    if (record.status == FrameStatus::kSkipped) continue;
    motion_model_.update(record.stamp.value(), record.T_local_lidar);
    if (record.status == FrameStatus::kHeldOut) continue;
    targets.push_back(&record);
    if (!submap_start_ || seconds(*record.stamp - *submap_start_) >= options_.submap_duration) {
      submap_start_ = record.stamp;
    }
  }
  for (std::size_t i = first_to_replay(targets); i < targets.size(); ++i) {
    const FrameRecord& record = *targets[i];
    const FrameResult frame = source.load(record.index);
    if (!std::holds_alternative<Frame>(frame)) continue;
    const PointCloud scan_lidar = compensated(std::get<Frame>(frame).scan, record.velocity);
    moving_things_.replay(map_, scan_lidar, record.T_local_lidar, record.index);
    const bool is_target = targets.size() - i <= std::size_t(refiner_.memory());
    if (is_target && pose_source_ == PoseSource::kRefine) {
      refiner_.add_target(scan_lidar, record.T_local_lidar);
    }
  }
}

std::size_t Mapper::first_to_replay(const std::vector<const FrameRecord*>& targets) const {
  const std::size_t count =
      std::max(std::size_t(refiner_.memory()), std::size_t(MovingThings::kJudges));
  std::size_t first = targets.size() - std::min(targets.size(), count);
  while (first > 0 && targets[first - 1]->index > targets.back()->index - MovingThings::kMemory) {
    --first;
  }
  return first;
}

}  // namespace fovea
