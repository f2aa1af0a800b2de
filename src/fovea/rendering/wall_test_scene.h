// For tests: a textured wall whose images and scans are analytic.
#pragma once

#include <cmath>
#include <numbers>

#include "fovea/camera.h"
#include "fovea/core/random.h"
#include "fovea/image.h"
#include "fovea/point_cloud.h"

namespace fovea {

/// 200 x 100 pixels, looking along the LiDAR's x axis, at the LiDAR's centre.
inline Camera forward_camera(int index = 2) {
  Camera camera{index, 200, 100, 150, 150, 99.5, 49.5, RigidMotion::Identity()};
  camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return camera;
}

/// The wall x = kWall of the local frame and its texture (period 0.8 m: about 15 pixels).
struct WallScene {
  static constexpr double kWall = 8;

  static Eigen::Vector3f texture(double y, double z) {
    const double k = 2 * std::numbers::pi / 0.8;
    return Eigen::Vector3d(128 + 90 * std::sin(k * y), 128 + 90 * std::cos(k * z),
                           128 + 45 * std::sin(k * (y + z)) + 45 * std::cos(k * (y - z)))
        .cast<float>();
  }

  /// Photograph of the wall by a camera under T_local_cam.
  static Image photograph(const Camera& camera, const RigidMotion& T_local_cam, int channels) {
    Image image(camera.width, camera.height, channels);
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector3d ray =
            T_local_cam.linear() *
            Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
        const Eigen::Vector3d center = T_local_cam.translation();
        const Eigen::Vector3d hit = center + (kWall - center.x()) / ray.x() * ray;
        const Rgb color = to_rgb(texture(hit.y(), hit.z()));
        std::uint8_t* p = image.pixel(u, v);
        p[0] = color.r;
        if (channels == 3) p[1] = color.g, p[2] = color.b;
      }
    }
    return image;
  }

  /// Returns of the wall, LiDAR frame: rays 0.25 degrees apart, jittered by less than half of that.
  static PointCloud scan(const RigidMotion& T_local_lidar, std::uint64_t seed) {
    PointCloud scan;
    Random random(seed);
    const double step = 0.25 * std::numbers::pi / 180;
    for (int row = -80; row <= 80; ++row) {
      for (int column = -160; column <= 160; ++column) {
        const double azimuth = step * (column + random.uniform(-0.4, 0.4));
        const double elevation = step * (row + random.uniform(-0.4, 0.4));
        const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const Eigen::Vector3d ray_local = T_local_lidar.linear() * ray;
        const double range = (kWall - T_local_lidar.translation().x()) / ray_local.x();
        scan.position.push_back((range * ray).cast<float>());
      }
    }
    return scan;
  }

  /// The wall sampled every `spacing` m with a jitter of `noise` m along x, coloured by camera 2.
  static PointCloud map(double spacing, double noise = 0) {
    PointCloud map;
    Random random(7);
    for (double y = -6; y <= 6; y += spacing) {
      for (double z = -3.2; z <= 3.2; z += spacing) {
        map.position.emplace_back(float(kWall + noise * random.uniform(-1, 1)), float(y), float(z));
        map.color.push_back(to_rgb(texture(y, z)));
      }
    }
    map.camera.assign(map.size(), 2);
    map.frame.assign(map.size(), 0);
    return map;
  }
};

}  // namespace fovea
