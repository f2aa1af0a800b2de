#include "fovea/pipeline/paper_mapper.h"

#include <array>
#include <utility>

#include "fovea/geometry/transform_cloud.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/foveal_query.h"
#include "fovea/pipeline/registration_check.h"
#include "fovea/pipeline/scan_geometry.h"

namespace fovea {
namespace {

constexpr double kMargin = 2;  // m, beyond the white zone: tiles at its border

}  // namespace

PaperMapper::PaperMapper(const DriveInfo& drive, const PaperOptions& options,
                         PoseSource pose_source, MapperServices services)
    : drive_(drive),
      options_(suited_to(drive, options)),
      pose_source_(pose_source),
      services_(std::move(services)),
      history_(drive),
      motion_model_(history_.navigation(),
                    {.doubt = false, .sweep_rest = from_seconds(drive.sweep.end_time())}),
      map_(options.tile_size) {}

double PaperMapper::reach() const {
  const double foveal = options_.foveal.far_range + farthest_lidar(lidar_origins(drive_));
  return kMargin + (options_.foveal_enabled ? foveal : 0);
}

TrackedScan PaperMapper::track(const Frame& frame, const FrameTask& task) {
  TrackedScan tracked;
  tracked.task = task;
  tracked.result = started_result(frame, task.held_out);
  return tracked;
}

FrameResult PaperMapper::map_frame(const Frame& frame, TrackedScan tracked) {
  FrameResult result = std::move(tracked.result);
  StageClock& clock = result.clock;
  clock.start();
  // Sec. Pose Refinement: "with the raw poses as initial guess".
  const MotionGuess raw = raw_pose(frame, tracked.task, result);
  RigidMotion T_local_lidar = raw.T_odom_lidar;
  // 1. Deskew (the paper's scans need none): each point at the scan's time stamp.
  const PointCloud scan_lidar = deskewed(frame.scan, raw.motion, drive_);
  clock.lap("register");
  if (uses_registration()) {
    // 2. Ground: "we extract the ground plane by using z thresholding".
    const std::vector<std::uint8_t> is_ground =
        segment_ground(scan_lidar.position, options_.ground);
    // 3. Constrained upsampling in view: "only the non-ground points", edges below tau.
    std::vector<Eigen::Vector3f> dense_lidar = densified(scan_lidar, is_ground);
    clock.lap("upsample");
    // 4. Registration to the previous scan.
    RegistrationCloud cloud = prepare_cloud(std::move(dense_lidar), registration_options());
    if (!tracked.task.given_pose)
      T_local_lidar = register_to_previous(cloud, T_local_lidar, result);
    if (!tracked.task.held_out) previous_ = {std::move(cloud), T_local_lidar};
    clock.lap("register");
  }
  apply_pose(T_local_lidar, result);
  if (tracked.task.held_out) return result;

  const std::vector<Camera> cameras = frame_cameras(drive_, frame, raw.motion);
  if (!options_.foveal_enabled) {
    add_whole_scan(scan_lidar, frame, cameras, result);  // baselines
    return result;
  }
  for (std::size_t k = 0; k < frame.images.size(); ++k) {
    if (!has_content(frame.images[k], result)) continue;
    FovealStats& stats = stats_of(result.foveal);
    // 5.1 Foveal region (Sec. Foveal Processing): white zone and slices of the camera.
    const FovealRegion region(options_.foveal, cameras[k], lidar_origins(drive_));
    const PointCloud foveal_cam = foveal_points(scan_lidar, region);
    stats.measured += foveal_cam.size();
    clock.lap("fovea");
    // 5.2 Upsampling, with the ground.
    PointCloud dense_cam = upsample(foveal_cam, cameras[k], options_.upsample);
    stats.upsampled += dense_cam.size();
    clock.lap("upsample");
    // 5.3 Incidence limit; the preset has none (config/paper.toml).
    stats.oblique += limit_incidence(dense_cam, options_.foveal.max_incidence);
    clock.lap("fovea");
    // 5.4 Ray filter (Sec. Ray-filtering, Eq. 1-2) against the accumulated points.
    PointCloud new_cam = visible_points(dense_cam, region, T_local_lidar, result);
    clock.lap("filter");
    // 5.5 Texture "by projecting them into the image": one view, no average.
    color_points(new_cam, {frame.images[k], cameras[k], frame.index, drive_.mask(cameras[k].index)},
                 options_.sampling);
    clock.lap("texture");
    // 5.6 Accumulation: "later add them to the accumulated cloud".
    add_points(std::move(new_cam), T_local_lidar * cameras[k].T_cam_lidar.inverse(), result);
    clock.lap("store");
  }
  return result;
}

bool PaperMapper::uses_registration() const {
  return pose_source_ == PoseSource::kRefine || pose_source_ == PoseSource::kGivenFirst;
}

MotionGuess PaperMapper::raw_pose(const Frame& frame, const FrameTask& task, FrameResult& result) {
  history_.add(frame.motion);
  motion_model_.begin_if_needed(frame.stamp, frame.index, services_.initial_velocity);
  const MotionPrediction prediction = motion_model_.predict(frame.stamp);
  MotionGuess raw = prediction.guesses.front();
  const auto& navigation = prediction.T_local_lidar_navigation;
  result.poses.T_local_lidar_navigation = navigation;
  if (!drive_.sweep_compensated || drive_.has_image_delays()) result.poses.motion = raw.motion;
  if (pose_source_ == PoseSource::kNavigation && navigation) raw.T_odom_lidar = *navigation;
  if (task.given_pose) raw.T_odom_lidar = *task.given_pose;
  return raw;
}

std::vector<Eigen::Vector3f> PaperMapper::densified(
    const PointCloud& scan_lidar, const std::vector<std::uint8_t>& is_ground) const {
  if (!options_.foveal_enabled) return scan_lidar.position;  // a baseline
  return upsample_non_ground(scan_lidar, is_ground, drive_.calibration.cameras, options_.upsample);
}

RegistrationOptions PaperMapper::registration_options() const {
  return {.method = options_.registration};
}

RigidMotion PaperMapper::register_to_previous(const RegistrationCloud& cloud_lidar,
                                              const RigidMotion& raw_T_local_lidar,
                                              FrameResult& result) const {
  RegistrationStats& stats = result.tracking.registration.emplace();
  stats.points = cloud_lidar.points.size();
  if (!previous_) return raw_T_local_lidar;
  const RigidMotion& T_local_previous = previous_->T_local_lidar;
  const RegistrationResult found = register_clouds(
      previous_->cloud_lidar, PointIndex(previous_->cloud_lidar.points), cloud_lidar,
      T_local_previous.inverse() * raw_T_local_lidar, registration_options());
  const RigidMotion T_local_lidar = T_local_previous * found.T_target_source;
  stats.alignment = alignment_stats(found, raw_T_local_lidar.inverse() * T_local_lidar);
  result.note = failure_of(found, *stats.alignment);
  stats.alignment->has_failed = !result.note.empty();
  return result.note.empty() ? T_local_lidar : raw_T_local_lidar;
}

void PaperMapper::apply_pose(const RigidMotion& T_local_lidar, FrameResult& result) {
  result.poses.T_local_lidar = result.poses.T_odom_lidar = T_local_lidar;
  motion_model_.update(*result.stamp, T_local_lidar);
  const bool is_first = map_.submaps().empty();
  if (is_first || is_submap_due(*result.stamp, T_local_lidar)) {
    map_.add_submap(T_local_lidar);
    submap_start_ = *result.stamp;
  }
  result.poses.submap = static_cast<int>(map_.submaps().size()) - 1;
  services_.load_near(map_, T_local_lidar.translation(), reach());
}

bool PaperMapper::is_submap_due(TimeNs stamp, const RigidMotion& T_local_lidar) const {
  constexpr double kDuration = 2, kLength = 5;  // s, m; at least
  const RigidMotion& T_local_submap = map_.submaps().back().T_local_submap;
  return seconds(stamp - submap_start_) >= kDuration &&
         (T_local_lidar.translation() - T_local_submap.translation()).norm() >= kLength;
}

PointCloud PaperMapper::visible_points(const PointCloud& points_cam, const FovealRegion& region,
                                       const RigidMotion& T_local_lidar, FrameResult& result) {
  const std::vector<Ray> accumulated = map_rays(map_, region, T_local_lidar);
  const std::vector<RayVerdict> verdicts = ray_filter_.filter(
      rays_of(points_cam, region.camera()), accumulated, region.camera(), options_.ray_filter);
  std::vector<std::uint32_t> visible;
  std::array<std::size_t, 4> counts{};
  for (std::uint32_t i = 0; i < verdicts.size(); ++i) {
    ++counts[static_cast<std::size_t>(verdicts[i])];
    if (verdicts[i] == RayVerdict::kVisible) visible.push_back(i);
  }
  RayFilterStats& stats = stats_of(result.ray_filter);
  stats.map_points += accumulated.size();
  stats.visible += counts[std::size_t(RayVerdict::kVisible)];
  stats.occluded += counts[std::size_t(RayVerdict::kOccluded)];
  stats.shared += counts[std::size_t(RayVerdict::kShared)];
  result.foveal->occluding += counts[std::size_t(RayVerdict::kOccluding)];
  return points_cam.select(visible);
}

void PaperMapper::add_points(PointCloud points_cam, const RigidMotion& T_local_cam,
                             FrameResult& result) {
  points_cam.normal.clear();  // a map has none
  stats_of(result.added) += points_cam.size();
  map_.add(transform_cloud(std::move(points_cam), T_local_cam,
                           result.poses.T_local_lidar.translation()));
}

/// A baseline: each camera colors the points that the cameras before it do not see. The other
/// points are added without color.
void PaperMapper::add_whole_scan(const PointCloud& scan_lidar, const Frame& frame,
                                 const std::vector<Camera>& cameras, FrameResult& result) {
  PointCloud rest_lidar = scan_lidar;
  for (std::size_t slot = 0; slot <= frame.images.size() && !rest_lidar.empty(); ++slot) {
    const bool is_last = slot == frame.images.size();
    const Camera& camera = cameras[is_last ? 0 : slot];
    PointCloud points_cam = transform_cloud(rest_lidar, camera.T_cam_lidar);
    points_cam.normal.assign(points_cam.size(), Eigen::Vector3f::Zero());
    points_cam.interpolated.assign(points_cam.size(), 0);
    points_cam.reason.assign(points_cam.size(), reason_of(PointRule::kMeasured));
    limit_incidence(points_cam, std::numeric_limits<double>::infinity());
    const Image none;
    const bool is_seen = !is_last && has_content(frame.images[slot], result);
    color_points(
        points_cam,
        {is_seen ? frame.images[slot] : none, camera, frame.index, drive_.mask(camera.index)},
        options_.sampling);
    std::vector<std::uint32_t> added, unseen;
    for (std::uint32_t i = 0; i < points_cam.size(); ++i) {
      (is_last || points_cam.camera[i] != kNoCamera ? added : unseen).push_back(i);
    }
    add_points(points_cam.select(added), result.poses.T_local_lidar * camera.T_cam_lidar.inverse(),
               result);
    if (is_last) result.unseen = added.size();
    rest_lidar = rest_lidar.select(unseen);
  }
  result.clock.lap("texture");
}

const FrameRecord* PaperMapper::follow(const std::vector<FrameRecord>& records) {
  const FrameRecord* last_mapped = nullptr;
  int last_submap = -1;
  for (const FrameRecord& record : records) {
    if (record.status == FrameStatus::kSkipped) continue;
    motion_model_.begin_if_needed(*record.stamp, record.index, services_.initial_velocity);
    motion_model_.update(*record.stamp, record.T_odom_lidar);
    if (record.submap > last_submap) submap_start_ = *record.stamp;
    last_submap = record.submap;
    if (record.status == FrameStatus::kMapped) last_mapped = &record;
  }
  return last_mapped;
}

void PaperMapper::keep_previous(const PointCloud& scan_lidar, const RigidMotion& T_local_lidar) {
  const std::vector<std::uint8_t> is_ground = segment_ground(scan_lidar.position, options_.ground);
  previous_ = {prepare_cloud(densified(scan_lidar, is_ground), registration_options()),
               T_local_lidar};
}

void PaperMapper::resume(TileMap map, const std::vector<FrameRecord>& records,
                         const FrameSource& source) {
  map_ = std::move(map);
  const FrameRecord* const last_mapped = follow(records);
  if (last_mapped == nullptr || !uses_registration()) return;
  const LoadedFrame loaded = source.load(last_mapped->index);
  const auto* frame = std::get_if<Frame>(&loaded);
  if (frame == nullptr) return;
  keep_previous(deskewed(frame->scan, last_mapped->motion, drive_), last_mapped->T_odom_lidar);
}

void PaperMapper::resume_live(TileMap map, const std::vector<FrameRecord>& records,
                              const FindScan& find_scan) {
  map_ = std::move(map);
  const FrameRecord* const last_mapped = follow(records);
  if (last_mapped == nullptr || !uses_registration()) return;
  if (const auto scan_lidar = find_scan(last_mapped->index)) {
    keep_previous(*scan_lidar, last_mapped->T_odom_lidar);
  }
}

}  // namespace fovea
