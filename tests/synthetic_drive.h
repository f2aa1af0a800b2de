// A drive through a scene of boxes whose every surface point and colour is known, in memory:
// analytic truth for the whole chain. (The full simulator writes drives to disk; this one serves
// unit tests.)
#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "fovea/drive/frame_source.h"

namespace fovea {

/// Axis-aligned box in the local frame; seen from outside or inside.
struct Box {
  Eigen::Vector3d min, max;
};

struct BoxScene {
  std::vector<Box> boxes;

  /// Distance along the unit ray to the nearest surface.
  std::optional<double> cast(const Eigen::Vector3d& from, const Eigen::Vector3d& along) const {
    std::optional<double> nearest;
    for (const Box& box : boxes) {
      double enter = -1e300, leave = 1e300;
      for (int axis = 0; axis < 3; ++axis) {
        double a = (box.min[axis] - from[axis]) / along[axis];
        double b = (box.max[axis] - from[axis]) / along[axis];
        if (a > b) std::swap(a, b);
        enter = std::max(enter, a);
        leave = std::min(leave, b);
      }
      if (enter > leave || leave < 1e-6) continue;
      const double hit = enter > 1e-6 ? enter : leave;
      if (!nearest || hit < *nearest) nearest = hit;
    }
    return nearest;
  }

  /// Distance of a point to the nearest surface of any box.
  double distance(const Eigen::Vector3d& p) const {
    double nearest = 1e300;
    for (const Box& box : boxes) {
      const Eigen::Vector3d outside = (box.min - p).cwiseMax(p - box.max);
      const double d = outside.maxCoeff() > 0 ? outside.cwiseMax(0).norm() : -outside.maxCoeff();
      nearest = std::min(nearest, d);
    }
    return nearest;
  }
};

/// A smooth colour for every place: its gradient is at most 60 a metre and channel.
inline Eigen::Vector3f synthetic_color(const Eigen::Vector3d& p) {
  return Eigen::Vector3d(128 + 40 * std::sin(1.5 * p.x() + 0.3 * p.z()),
                         128 + 40 * std::sin(1.5 * p.y() + 1.0 * p.x()),
                         128 + 40 * std::sin(1.2 * p.z() + 0.8 * p.y()))
      .cast<float>();
}

class SyntheticDrive : public FrameSource {
 public:
  BoxScene scene;
  std::vector<RigidMotion> T_local_lidar;  ///< true pose of each frame
  int beams = 48, columns = 720;
  int paused_frame = 0;  ///< the recording pauses before this frame,
  TimeNs pause = 0;      ///< for so long

  /// Straight ahead (local x) in steps, with a slight weave, one camera, scans without sweep
  /// motion.
  SyntheticDrive(BoxScene scene_, int frames, double step) : scene(std::move(scene_)) {
    std::vector<StampedPose> navigation;
    for (int i = 0; i < frames; ++i) {
      RigidMotion T = RigidMotion::Identity();
      T.translation() = Eigen::Vector3d(i * step, 0.05 * std::sin(0.7 * i), 0);
      T.linear() = Eigen::AngleAxisd(0.01 * std::sin(0.5 * i), Eigen::Vector3d::UnitZ()).matrix();
      T_local_lidar.push_back(T);
      navigation.push_back({stamp_of(i), T});
    }
    info_.path = "synthetic";
    info_.kind = "synthetic";
    info_.end = frames;
    info_.sweep_compensated = true;
    info_.navigation = Trajectory(navigation);
    Camera camera;
    camera.index = 2;
    camera.width = 621;
    camera.height = 188;
    camera.fx = camera.fy = 360;
    camera.cx = 310;
    camera.cy = 80;
    camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    camera.T_cam_lidar.translation() = Eigen::Vector3d(0.06, -0.08, -0.27);  // KITTI's, nearly
    info_.calibration.cameras = {camera};
  }

  static TimeNs stamp_of(int frame) { return frame * (kNsPerSecond / 10); }
  DriveInfo& editable_info() { return info_; }

  const DriveInfo& info() const override { return info_; }
  std::optional<TimeNs> stamp(int index) const override {
    return stamp_of(index) + (index >= paused_frame ? pause : 0);
  }
  LoadedFrame load(int index) const override {
    Frame frame;
    frame.index = index;
    frame.stamp = *stamp(index);
    const RigidMotion& T = T_local_lidar[std::size_t(index)];
    for (int b = 0; b < beams; ++b) {
      const double elevation = (3.0 - 28.0 * b / (beams - 1)) * std::numbers::pi / 180;
      for (int c = 0; c < columns; ++c) {
        const double azimuth = (0.5 - double(c) / columns) * 2 * std::numbers::pi;
        const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const auto hit = scene.cast(T.translation(), T.linear() * ray);
        if (!hit || *hit > 80) continue;
        frame.scan.position.push_back((ray * *hit).cast<float>());
        frame.scan.intensity.push_back(0.5f);
      }
    }
    for (std::size_t k = 0; k < info_.calibration.cameras.size(); ++k) {
      frame.image_offsets.push_back(info_.image_offset(k, index));
      const Camera camera = camera_of(info_, frame, k);
      const TimeNs taken = frame.stamp + from_seconds(camera.image_delay);
      frame.images.push_back(
          photo(camera, taken == frame.stamp ? T : info_.navigation->at(taken).value()));
    }
    return frame;
  }

 private:
  Image photo(const Camera& camera, const RigidMotion& T) const {
    Image image(camera.width, camera.height, 3);
    const RigidMotion T_local_cam = T * camera.T_cam_lidar.inverse();
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector3d ray =
            Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1)
                .normalized();
        const Eigen::Vector3d along = T_local_cam.linear() * ray;
        const auto hit = scene.cast(T_local_cam.translation(), along);
        if (!hit) continue;
        const Rgb color = to_rgb(synthetic_color(T_local_cam.translation() + *hit * along));
        std::uint8_t* pixel = image.pixel(u, v);
        pixel[0] = color.r, pixel[1] = color.g, pixel[2] = color.b;
      }
    }
    return image;
  }

  DriveInfo info_;
};

/// A street: ground, a house row on either side, and two parked cars.
inline BoxScene street_scene() {
  return {{{{-50, -6, -3}, {80, 6, -1.73}},
           {{-50, 6, -3}, {80, 9, 8}},
           {{-50, -9, -3}, {80, -6, 8}},
           {{8, 2.5, -1.73}, {12, 4.3, -0.2}},
           {{14, -4.4, -1.73}, {18, -2.6, 0.1}},
           {{30, -6, -1.73}, {31, -5, 3}},
           {{-20, -6, -1.73}, {-19, -4.5, 3}}}};
}

/// A street with side walls, so that registration knows where along it the vehicle is.
inline BoxScene town_scene() {
  BoxScene scene = street_scene();
  for (const double x : {-28.0, -11.0, 3.0, 22.0, 41.0, 57.0}) {
    scene.boxes.push_back({{x, 4.5, -1.73}, {x + 0.4, 6, 3}});
    scene.boxes.push_back({{x + 5, -6, -1.73}, {x + 5.4, -4.8, 2.5}});
  }
  return scene;
}

}  // namespace fovea
