// For tests: the wall of test_scene.h with a truth folder, where every figure is known in advance.
#pragma once

#include "../../../tests/temporary_folder.h"
#include "../../../tests/truth_writer.h"
#include "fovea/evaluation/test_scene.h"
#include "fovea/world/world_file.h"

namespace fovea {

/// WallDrive's frames in a folder with their truth: the wall is matte where y < 0 and mirrors where
/// y > 0; rings and columns of hits stand `step` degrees apart.
class TruthScene {
 public:
  static constexpr double kStep = 0.4;
  static constexpr float kEdge = 0.5f;  ///< half the side of the board that moves (m)

  explicit TruthScene(int frames = 9, double step = kStep) : frames_(frames), drive_(frames) {
    drive_.mutable_info().path = folder_.path();
    std::vector<RigidMotion> poses;
    for (int i = 0; i < frames; ++i) poses.push_back(WallDrive::T_local_lidar(i));
    test::write_truth_poses(truth(), origin(), poses, {camera()});
    for (int i = 0; i < frames; ++i) write_frame(i, step);
    write_world(world(), truth());
  }

  static GeodeticPoint origin() { return {49.01, 8.43, 114.5}; }
  static Camera camera() { return forward_camera(2); }
  const WallDrive& drive() const { return drive_; }
  std::filesystem::path truth() const { return folder_ / "truth"; }
  std::filesystem::path image_file(const char* kind, int frame) const {
    return truth() / "image_02" / kind / test::frame_file(frame, "png");
  }

  static Rgb matte_color() { return encode_srgb(world().materials[0].color); }
  static Rgb glossy_color() { return encode_srgb(world().materials[1].color); }

  static World world() {
    World world;
    TriangleMesh& mesh = world.mesh_local;
    for (const double y : {-20.0, 0.0}) {
      const auto first = static_cast<std::uint32_t>(mesh.position.size());
      for (const auto& [dy, z] : {std::pair(0, -10), {20, -10}, {20, 10}, {0, 10}}) {
        mesh.position.emplace_back(WallScene::kWall, y + dy, z);
        mesh.texture.emplace_back(0.f, 0.f, 0.f);
      }
      mesh.triangle.push_back({first, first + 2, first + 1});
      mesh.triangle.push_back({first, first + 3, first + 2});
    }
    mesh.material = {0, 0, 1, 1};
    mesh.surface = {1, 1, 1, 1};
    Material matte;
    matte.name = "matte";
    matte.color = {0.2f, 0.4f, 0.6f};
    Material glossy = matte;
    glossy.name = "glossy";
    glossy.gloss = 0.3f;
    glossy.color = {0.5f, 0.3f, 0.1f};
    world.materials = {matte, glossy};
    world.surfaces = {{1, "wall"}};
    return world;
  }

  /// The frame's hits on the wall; before it, at x = 5, those on the board that moves, if `board`.
  static std::vector<TrueReturn> returns(int frame, bool board = false, double step = kStep) {
    std::vector<TrueReturn> returns;
    const Eigen::Vector3d center = WallDrive::T_local_lidar(frame).translation();
    const double radians = step * std::numbers::pi / 180;
    const int rings = static_cast<int>(16 / step), columns = static_cast<int>(40 / step);
    for (int ring = 0; ring <= rings; ++ring) {
      for (int column = -columns; column <= columns; ++column) {
        const double elevation = (0.5 * rings - ring) * radians, azimuth = column * radians;
        const Eigen::Vector3d slope(1, std::tan(azimuth), std::tan(elevation) / std::cos(azimuth));
        TrueReturn r;
        r.ring = static_cast<std::uint8_t>(ring);
        r.hit_lidar = ((5 - center.x()) * slope).cast<float>();
        r.moving = board && r.hit_lidar.tail<2>().cwiseAbs().maxCoeff() < kEdge;
        if (!r.moving) r.hit_lidar = ((WallScene::kWall - center.x()) * slope).cast<float>();
        returns.push_back(r);
      }
    }
    return returns;
  }
  void write_returns(int frame, const std::vector<TrueReturn>& returns) const {
    test::write_file(truth() / "velodyne_points" / test::frame_file(frame, "bin"),
                     test::return_records(returns));
  }

  /// The map of WallDrive's frames; its points come from frame 1.
  ScoredMap map(PointCloud points) const {
    points.frame.assign(points.size(), 1);
    return wall_map(std::move(points), frames_);
  }

 private:
  void write_frame(int frame, double step) const {
    write_returns(frame, returns(frame, false, step));
    const RigidMotion T_local_cam =
        WallDrive::T_local_lidar(frame) * camera().T_cam_lidar.inverse();
    test::write_png_file(image_file("perfect", frame),
                         WallScene::photograph(camera(), T_local_cam, 3));
    const int width = camera().width, height = camera().height;
    DepthImage depth{width, height, {}};
    depth.depth.assign(std::size_t(width) * std::size_t(height),
                       float(WallScene::kWall - T_local_cam.translation().x()));
    test::write_depth_png(image_file("depth", frame), depth);
  }

  int frames_;
  TemporaryFolder folder_;
  WallDrive drive_;
};

}  // namespace fovea
