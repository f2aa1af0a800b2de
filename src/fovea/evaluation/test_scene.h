// For tests: a drive in memory towards a textured wall, every image and every return analytic.
#pragma once

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "fovea/core/random.h"
#include "fovea/drive/frame_source.h"
#include "fovea/evaluation/scored_map.h"
#include "fovea/rendering/wall_test_scene.h"

namespace fovea {

/// Frames 0 ... n-1, 0.2 m and 0.1 s apart along x, without sweep motion.
class WallDrive : public FrameSource {
 public:
  explicit WallDrive(int frames = 9, std::vector<Camera> cameras = {forward_camera()}) {
    info_.calibration.cameras = std::move(cameras);
    info_.end = frames;
    info_.sweep_compensated = true;
  }

  DriveInfo& mutable_info() { return info_; }
  void lose(int frame) { lost_.insert(frame); }
  void lose_image(int frame, int camera) { lost_images_.insert({frame, camera}); }
  void make_grey() { channels_ = 1; }

  static RigidMotion T_local_lidar(int frame) {
    return RigidMotion(Eigen::Translation3d(0.2 * frame, 0, 0));
  }

  const DriveInfo& info() const override { return info_; }
  std::optional<TimeNs> stamp(int index) const override { return index * (kNsPerSecond / 10); }
  LoadedFrame load(int index) const override {
    if (lost_.contains(index)) return SkippedFrame{index, SkipReason::kMissingScan, "no file"};
    Frame frame;
    frame.index = index;
    frame.scan = WallScene::scan(T_local_lidar(index), static_cast<std::uint64_t>(index));
    for (const Camera& camera : info_.calibration.cameras) {
      if (lost_images_.contains({index, camera.index})) {
        frame.images.emplace_back();
        continue;
      }
      frame.images.push_back(WallScene::photograph(
          camera, T_local_lidar(index) * camera.T_cam_lidar.inverse(), channels_));
    }
    return frame;
  }

 private:
  DriveInfo info_;
  std::set<int> lost_;
  std::set<std::pair<int, int>> lost_images_;  // frame and camera
  int channels_ = 3;
};

/// A map of the drive's frames; frames with index % 8 == 4 are held out.
inline ScoredMap wall_map(PointCloud points_local, int frames = 9) {
  ScoredMap map;
  map.points_local = std::move(points_local);
  map.cameras = {2};
  for (int i = 0; i < frames; ++i) {
    FrameRecord record;
    record.index = i;
    record.stamp = i * (kNsPerSecond / 10);
    record.status = i % 8 == 4 ? FrameStatus::kHeldOut : FrameStatus::kMapped;
    record.T_local_lidar = WallDrive::T_local_lidar(i);
    map.frames.push_back(record);
  }
  return map;
}

}  // namespace fovea
