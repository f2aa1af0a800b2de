// The whole chain against exact truth: a drive without noise, simulated, written as KITTI's files,
// read back and mapped under its true poses, must give a map without errors. What is left tells of
// a mistake in frames, times or pixels, which a real drive cannot show.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "fovea/drive/drive_truth.h"
#include "fovea/map/map_store.h"
#include "fovea/simulation/camera_model.h"
#include "fovea/simulation/drive_texts.h"
#include "fovea/simulation/rig.h"
#include "fovea/simulation/simulate.h"
#include "fovea/simulation/vehicle_motion.h"
#include "fovea/world/surface_index.h"
#include "fovea/world/world_file.h"
#include "tests/program.h"

namespace fovea::simulated_chain_test {

/// A simulated drive, and its map made by the program from true poses without upsampling.
struct Chain {
  explicit Chain(const SimulationOptions& options_) : options(options_) {
    folder = simulate(options, own / "drive");
    const ProgramRun run =
        run_fovea("map '" + folder.string() + "' -o '" + (own / "map.fovea").string() +
                  "' --poses '" + (folder / "truth/poses.txt").string() +
                  "' --preset paper --set upsample.rate=0 --set 'foveal.slices_deg=[]' --quiet");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    map = MapReader(own / "map.fovea").all_points_local();
  }

  /// Distance of every map point to the nearest true surface (m).
  std::vector<double> surface_distances() const {
    const World world = read_world(folder / "truth");
    const SurfaceIndex index(world.mesh_local);
    std::vector<double> distances;
    for (const Eigen::Vector3f& p : map.position) {
      const Eigen::Vector3d local = map.origin + p.cast<double>();
      distances.push_back((index.nearest(local).position - local).norm());
    }
    return distances;
  }

  TemporaryFolder own;
  SimulationOptions options;
  std::filesystem::path folder;
  PointCloud map;
};

/// Without noise; on a circle at constant speed, on which poses interpolate exactly.
SimulationOptions constant_twist() {
  SimulationOptions options = simulation_options(Scene::kStreet, "none");
  options.frames = 6;
  options.bends = 0;
  options.curvature = 0.004;
  options.vehicle.speed_variation = options.vehicle.weave = 0;
  options.vehicle.sway = options.vehicle.heave = 0;
  options.camera.cameras = {kitti_camera(2)};
  return options;
}

/// Shows the scene of a drive again, through the simulator's own eyes.
class Eye {
 public:
  explicit Eye(const SimulationOptions& options)
      : options_(options),
        scenery_(make_scenery(options)),
        motion_(scenery_->path(), scenery_->lane_offset(), options.vehicle, options.seed),
        rig_(make_rig(options)),
        caster_(*scenery_),
        shader_(caster_, options.light),
        camera_(caster_, shader_, rig_.cameras.front()) {
    T_world_local_.translation() = T_world_lidar(0).translation();
  }

  void look(int frame) {
    const double time = seconds(stamp_of(frame, options_) - stamp_of(0, options_));
    T_world_cam_ = T_world_lidar(time) * rig_.cameras.front().T_cam_lidar.inverse();
    moment_ = caster_.moment(time, motion_.way(time));
    caster_.move_to(T_world_cam_.translation().head<2>(), 260);
  }

  /// What a perfect camera sees at the very pixel of a point; empty if the point is not matte, is
  /// not what is seen there, or lies within two pixels of an edge in depth.
  std::optional<Eigen::Vector3f> color_at(const Eigen::Vector3d& p_local) const {
    const Eigen::Vector3d p_cam = T_world_cam_.inverse() * (T_world_local_ * p_local);
    const auto pixel = rig_.cameras.front().project(p_cam);
    if (!pixel) return std::nullopt;
    for (int dv = -2; dv <= 2; ++dv) {
      for (int du = -2; du <= 2; ++du) {
        const auto hit = camera_.hit_at(pixel->x() + du, pixel->y() + dv, T_world_cam_, moment_);
        if (!hit || scenery_->palette().materials[hit->material].gloss > 0) return std::nullopt;
        const double depth = (T_world_cam_.inverse() * hit->position).z();
        if (std::abs(depth - p_cam.z()) > 0.02 * p_cam.z()) return std::nullopt;
      }
    }
    return encode_srgb_float(
        camera_.light_at(pixel->x(), pixel->y(), T_world_cam_, moment_).cwiseMin(1.0f));
  }

 private:
  RigidMotion T_world_lidar(double time) const {
    return motion_.T_world_vehicle(time) * rig_.T_vehicle_lidar;
  }

  SimulationOptions options_;
  std::unique_ptr<Scenery> scenery_;
  VehicleMotion motion_;
  Rig rig_;
  RayCaster caster_;
  Shader shader_;
  CameraModel camera_;
  RigidMotion T_world_local_ = RigidMotion::Identity(), T_world_cam_ = RigidMotion::Identity();
  RayCaster::Moment moment_;
};

/// One drive for both tests.
const Chain& noise_free_chain() {
  static const Chain chain(constant_twist());
  return chain;
}

TEST(SimulatedChain, WithoutNoiseEveryPointLiesOnATrueSurface) {
  const Chain& chain = noise_free_chain();
  ASSERT_GT(chain.map.size(), 50'000u);
  const std::vector<double> distances = chain.surface_distances();
  EXPECT_LT(*std::max_element(distances.begin(), distances.end()), 0.001);
}

TEST(SimulatedChain, WithoutNoiseColoursAreWhatACameraSeesAtThatVeryPoint) {
  const Chain& chain = noise_free_chain();
  Eye eye(chain.options);
  double sum = 0;
  std::size_t compared = 0;
  for (int frame = 0; frame < chain.options.frames; ++frame) {
    eye.look(frame);
    for (std::size_t i = 0; i < chain.map.size(); i += 20) {
      if (chain.map.frame[i] != frame) continue;
      const auto seen = eye.color_at(chain.map.origin + chain.map.position[i].cast<double>());
      if (!seen) continue;
      sum += (*seen - to_float(chain.map.color[i])).norm();
      ++compared;
    }
  }
  ASSERT_GT(compared, 1000u);
  EXPECT_LT(sum / double(compared), 3.0) << compared << " points";
}

// The vehicle speeds up, weaves and sways: poses between records are interpolated, and that is all
// that is off.
TEST(SimulatedChain, AnOrdinaryDriveIsOffByItsInterpolationOnly) {
  SimulationOptions options = simulation_options(Scene::kStreet, "none");
  options.frames = 8;
  options.camera.cameras = {kitti_camera(2)};
  const Chain chain(options);
  ASSERT_GT(chain.map.size(), 50'000u);
  const std::vector<double> distances = chain.surface_distances();
  EXPECT_LT(*std::max_element(distances.begin(), distances.end()), 0.006);
}

TEST(SimulatedChain, PositionsThatJitterDoNotBendScans) {
  // 15 cm from record to record are 2 m/s; the velocities that the unit measures are right.
  SimulationOptions options = simulation_options(Scene::kStreet, "default");
  options.frames = 10;
  options.navigation.position_noise = 0.15;
  options.camera.cameras = {kitti_camera(2)};
  options.camera.width = 310;
  options.camera.height = 94;
  options.camera.focal = 180;
  options.camera.cx = 152;
  options.camera.cy = 43;
  const TemporaryFolder own;
  const std::string drive = "'" + simulate(options, own / "drive").string() + "'";
  const std::string map = "'" + (own / "map.fovea").string() + "'";
  const std::filesystem::path json = own / "truth.json";
  const ProgramRun mapped = run_fovea("map " + drive + " -o " + map + " --quiet");
  ASSERT_EQ(mapped.exit_code, 0) << mapped.err;
  const ProgramRun scored =
      run_fovea("evaluate " + map + " " + drive + " --truth --json '" + json.string() + "'");
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  const nlohmann::json figures = nlohmann::json::parse(read_text(json));
  EXPECT_LT(figures["pose_relative_deg"]["max"].get<double>(), 0.1);
  EXPECT_LT(figures["pose_relative_m"]["max"].get<double>(), 0.02);
}

}  // namespace fovea::simulated_chain_test
