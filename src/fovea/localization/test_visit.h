// For tests: a map of a scene, and another drive through the scene.
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "../../../tests/synthetic_drive.h"
#include "fovea/core/random.h"
#include "fovea/pipeline/map_drive.h"

namespace fovea::test {

/// Drives through the town on its own way, with a LiDAR whose ranges have noise.
class Visit : public SyntheticDrive {
 public:
  double noise = 0.01;  // m
  Visit(BoxScene scene_, double start, double step, int frames)
      : SyntheticDrive(std::move(scene_), frames, step) {
    std::vector<StampedPose> navigation;
    for (int i = 0; i < frames; ++i) {
      RigidMotion& T = T_local_lidar[std::size_t(i)];
      T = RigidMotion(Eigen::Translation3d(start, 0.4, 0)) * T;
      navigation.push_back({stamp_of(i), RigidMotion(Eigen::Translation3d(1.2, -0.8, 0.3)) * T});
    }
    editable_info().navigation = Trajectory(navigation);  // off, as GPS is
  }
  LoadedFrame load(int index) const override {
    LoadedFrame result = SyntheticDrive::load(index);
    Random random(static_cast<std::uint64_t>(index));
    for (Eigen::Vector3f& p : std::get<Frame>(result).scan.position) {
      p *= 1 + float(noise * random.normal()) / p.norm();
    }
    return result;
  }
};

/// Makes the map of a drive of 14 m with true poses. Returns its path.
inline std::filesystem::path map_scene(BoxScene scene, const std::filesystem::path& output) {
  const SyntheticDrive drive(std::move(scene), 14, 1.0);
  MapJob job;
  job.output = output;
  job.pose_source = PoseSource::kNavigation;
  job.settings.mapper().surface.spacing = 0.06;
  map_drive(drive, job, {});
  return output;
}

}  // namespace fovea::test
