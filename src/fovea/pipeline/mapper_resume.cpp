// Mapper::resume(): what an uninterrupted run would know after the frames of an earlier run.
#include <algorithm>

#include "fovea/mapping/blank_image.h"
#include "fovea/mapping/scan_projection.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/mapper.h"
#include "fovea/pipeline/scan_geometry.h"

namespace fovea {
namespace {

bool is_textured(const FrameResult& frame) {
  return frame.status == FrameStatus::kMapped && !frame.skips_texture;
}

/// Index of the first frame whose scan the filter of dynamic points depends on.
int first_voting_frame(const std::vector<FrameResult>& frames) {
  constexpr std::size_t kScans = DynamicPointFilter::kVotingScans;
  std::vector<int> mapped;
  for (const FrameResult& frame : frames) {
    if (is_textured(frame)) mapped.push_back(frame.index);
  }
  if (mapped.size() <= kScans) return 0;
  return std::min(mapped[mapped.size() - kScans], mapped.back() - DynamicPointFilter::kMemory + 1);
}

}  // namespace

void Mapper::resume(TileMap map, const std::vector<FrameRecord>& records,
                    const FrameSource& source) {
  map_ = std::move(map);
  std::vector<FrameResult> frames;
  std::vector<const FrameRecord*> of_frames;
  for (const FrameRecord& record : records) {
    if (record.status == FrameStatus::kSkipped) continue;
    frames.push_back(tracked_result(record));
    of_frames.push_back(&record);
  }
  const bool needs_images = light_.needs_images(records);
  const int first_voting = first_voting_frame(frames);
  const int first_target = tracker_.first_target(frames);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameResult& frame = frames[i];
    tracker_.follow(frame);
    map_.place_submaps(tracker_.submaps());
    const bool with_periphery = is_textured(frame) && periphery_is_due(frame.poses.T_odom_lidar);
    if (frame.status == FrameStatus::kHeldOut) {
      light_.follow(std::size_t(frame.poses.submap), frame.poses.T_odom_lidar, map_);
      continue;
    }
    const bool votes = is_textured(frame) && frame.index >= first_voting;
    const bool response = is_textured(frame) && needs_images;
    if (votes || response || tracker_.needs_scan(first_target)) {
      const LoadedFrame loaded = source.load(frame.index);
      if (const auto* read = std::get_if<Frame>(&loaded)) {
        replay(*read, frame, {votes, response, with_periphery});
      }
    }
    // After replay(), which may have moved submaps.
    light_.follow(std::size_t(frame.poses.submap), frame.poses.T_odom_lidar, map_);
    for (const Camera& camera : drive_.calibration.cameras) {
      const ViewRecord* view = of_frames[i]->find_view(camera.index);
      if (view == nullptr) continue;
      light_.replay(*view, drive_.image_exposure(camera.index, frame.index), map_);
    }
  }
}

void Mapper::resume_live(TileMap map, const std::vector<FrameRecord>& records,
                         const FindScan& find_scan) {
  map_ = std::move(map);
  static_cast<void>(light_.needs_images(records));  // there are none: responses are learned on
  for (const FrameRecord& record : records) {
    if (record.status == FrameStatus::kSkipped) continue;
    const FrameResult frame = tracked_result(record);
    tracker_.follow_live(frame);
    map_.place_submaps(tracker_.submaps());
    if (is_textured(frame)) periphery_is_due(frame.poses.T_odom_lidar);
    if (frame.status == FrameStatus::kMapped) {
      if (const auto scan_lidar = find_scan(frame.index)) tracker_.replay(*scan_lidar, frame);
      map_.place_submaps(tracker_.submaps());
    }
    light_.follow(std::size_t(frame.poses.submap), frame.poses.T_odom_lidar, map_);
    for (const ViewRecord& view : record.views) light_.replay(view, /*exposure=*/{}, map_);
  }
}

void Mapper::replay(const Frame& read, const FrameResult& frame, const ReplayedParts& parts) {
  const PointCloud scan_lidar = tracker_.compensated(read.scan, frame.poses.motion);
  tracker_.replay(scan_lidar, frame);
  map_.place_submaps(tracker_.submaps());
  if (parts.response) {
    replay_response(read, scan_lidar, frame, foveal_options(parts.with_periphery));
  }
  if (!parts.votes) return;
  const RigidMotion T_local_lidar = tracker_.T_local_odom() * frame.poses.T_odom_lidar;
  services_.load_near(map_, T_local_lidar.translation(), reach_);
  dynamic_points_.replay(map_, sensor_views(scan_lidar, drive_), frame.poses.T_odom_lidar,
                         tracker_.T_local_odom().inverse(), frame.index);
}

void Mapper::replay_response(const Frame& read, const PointCloud& scan_lidar,
                             const FrameResult& frame, const FovealOptions& foveal) {
  const std::vector<Camera> cameras = frame_cameras(drive_, read, frame.poses.motion);
  for (std::size_t k = 0; k < read.images.size(); ++k) {
    if (read.images[k].empty() || is_blank(read.images[k])) continue;
    PointCloud visible_cam =
        foveal_points(scan_lidar, FovealRegion(foveal, cameras[k], lidar_origins_));
    drop_hidden(visible_cam, scan_lidar, cameras[k]);
    const ImageMask* mask = drive_.mask(cameras[k].index);
    light_.learn_response(
        unmasked(visible_cam.position, cameras[k], mask), ImagePyramid(read.images[k]), cameras[k],
        frame.poses.T_odom_lidar * cameras[k].T_cam_lidar.inverse(), options_.footprint);
  }
}

}  // namespace fovea
