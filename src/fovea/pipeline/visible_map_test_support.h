// Shared by the tests of colors: a camera, views of one image, and maps of walls.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "../../../tests/sample_map.h"
#include "fovea/mapping/color_fusion.h"
#include "fovea/pipeline/visible_map.h"

namespace fovea::visible_map_test {

inline constexpr double kSpacing = 0.02;

inline Camera test_camera() { return {3, 621, 188, 360, 360, 310, 94, RigidMotion::Identity()}; }

inline Image image_of(const Rgb& color) {
  Image image(621, 188, 3);
  for (std::size_t i = 0; i < image.data.size(); i += 3) {
    image.data[i] = color.r, image.data[i + 1] = color.g, image.data[i + 2] = color.b;
  }
  return image;
}

inline FovealOptions white_zone(double near_range, double far_range = 18) {
  FovealOptions options;
  options.near_range = near_range;
  options.far_range = far_range;
  return options;
}

/// A view of one image from a pose in the local frame.
struct TestView {
  ImagePyramid image;
  Camera camera;
  FovealRegion region;
  RigidMotion T_cam_local;
  ViewColors view;
  int frame;

  explicit TestView(const Image& picture, const RigidMotion& T_cam_local_ = RigidMotion::Identity(),
                    const FovealOptions& options = white_zone(1), int frame_ = 7)
      : image(picture),
        camera(test_camera()),
        region(options, camera, kOneLidar),
        T_cam_local(T_cam_local_),
        view(image, camera, kSpacing),
        frame(frame_) {}
  TestView(const TestView&) = delete;
  TestView& operator=(const TestView&) = delete;

  VisibleMap render(const TileMap& map) const {
    VisibleMap seen;
    seen.render(map, region, T_cam_local, kSpacing);
    return seen;
  }
  CodeDifferences differences(const TileMap& map) const {
    return render(map).differences(view, /*below=*/1).recent;
  }
  std::size_t recolor(TileMap& map, const PointCloud& new_points_cam = {}) const {
    VisibleMap seen = render(map);
    seen.add_occluders(new_points_cam);
    return seen.recolor(map, view, frame);
  }
};

inline RigidMotion camera_at(double x, double y, double z) {
  RigidMotion T_cam_local = RigidMotion::Identity();
  T_cam_local.translation() = -Eigen::Vector3d(x, y, z);
  return T_cam_local;
}

inline std::vector<Eigen::Vector3f> wall(double depth, double left, double right, double top,
                                         double bottom) {
  std::vector<Eigen::Vector3f> positions;
  for (double x = left; x < right; x += kSpacing) {
    for (double y = top; y < bottom; y += kSpacing) {
      positions.push_back(Eigen::Vector3d(x, y, depth).cast<float>());
    }
  }
  return positions;
}

/// Points after color_new_points(), with color (1, 2, 3) from 5 m; `frame` 0.
inline PointCloud new_points(const std::vector<Eigen::Vector3f>& positions) {
  PointCloud points = one_point_each(positions);
  points.frame.assign(points.size(), 0);
  points.weight.assign(points.size(), view_weight(5));
  points.reason.assign(points.size(), 0);
  return points;
}

inline TileMap map_of(const std::vector<Eigen::Vector3f>& positions) {
  TileMap map(4.0);
  map.add_submap(exp_se3((Twist() << 0.3, -0.2, 1.0, 5, -7, 2).finished()));
  map.add(new_points(positions));
  return map;
}

/// Calls f(p_local, tile, index) for all points.
inline void for_each_point(
    const TileMap& map,
    const std::function<void(const Eigen::Vector3d&, const PointCloud&, std::size_t)>& f) {
  for (const Submap& submap : map.submaps()) {
    for (const auto& [key, stored] : submap.tiles) {
      const PointCloud tile = stored.points->cloud();
      for (std::size_t i = 0; i < tile.size(); ++i) {
        f(submap.T_local_submap * (tile.origin + tile.position[i].cast<double>()), tile, i);
      }
    }
  }
}

}  // namespace fovea::visible_map_test
