// fovea evaluate --protocol truth, as a user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/world/world_file.h"
#include "tests/kitti_writer.h"
#include "tests/program.h"
#include "tests/truth_writer.h"

namespace fovea::program_truth_test {

using testing::HasSubstr;

void add_box(const Box& box, TriangleMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (int corner = 0; corner < 8; ++corner) {
    mesh.position.emplace_back((corner & 1 ? box.max : box.min).x(),
                               (corner & 2 ? box.max : box.min).y(),
                               (corner & 4 ? box.max : box.min).z());
    mesh.texture.emplace_back(0.f, 0.f, 0.f);
  }
  for (const auto& [a, b, c, d] : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                                   {4, 5, 7, 6},
                                   {0, 1, 5, 4},
                                   {2, 6, 7, 3},
                                   {0, 4, 6, 2},
                                   {1, 3, 7, 5}}) {
    mesh.triangle.push_back({first + a, first + b, first + c});
    mesh.triangle.push_back({first + a, first + c, first + d});
  }
  mesh.material.resize(mesh.triangle.size(), 0);
  mesh.surface.resize(mesh.triangle.size(), 1);
}

World boxes(const BoxScene& scene) {
  World world;
  for (const Box& box : scene.boxes) add_box(box, world.mesh_local);
  world.materials.resize(1);
  world.surfaces[1] = "box";
  return world;
}

DepthImage true_depth(const BoxScene& scene, const Camera& camera, const RigidMotion& T_local_cam) {
  DepthImage depth{camera.width, camera.height, {}};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
      const auto hit = scene.cast(T_local_cam.translation(), T_local_cam.linear() * ray);
      depth.depth.push_back(hit ? static_cast<float>(std::min(*hit, 250.0)) : 0.f);
    }
  }
  return depth;
}

/// The truth of a synthetic drive, written beside its files. Nothing in it moves.
void write_truth(const SyntheticDrive& drive, const std::filesystem::path& folder) {
  const std::filesystem::path truth = folder / "truth";
  const Camera& camera = drive.info().calibration.cameras.at(0);
  test::write_truth_poses(truth, {49.01, 8.43, 114.5}, drive.T_local_lidar, {camera});
  for (int i = 0; i < drive.info().end; ++i) {
    const Frame frame = std::get<Frame>(drive.load(i));
    std::vector<TrueReturn> returns;
    for (const Eigen::Vector3f& p : frame.scan.position) {
      TrueReturn r;
      r.hit_lidar = p;
      const double elevation = std::asin(p.z() / p.norm()) * 180 / std::numbers::pi;
      r.ring = static_cast<std::uint8_t>(std::lround((3 - elevation) / 28 * (drive.beams - 1)));
      returns.push_back(r);
    }
    test::write_file(truth / "velodyne_points" / test::frame_file(i, "bin"),
                     test::return_records(returns));
    const RigidMotion T_local_cam =
        drive.T_local_lidar[static_cast<std::size_t>(i)] * camera.T_cam_lidar.inverse();
    test::write_png_file(truth / "image_02/perfect" / test::frame_file(i, "png"), frame.images[0]);
    test::write_depth_png(truth / "image_02/depth" / test::frame_file(i, "png"),
                          true_depth(drive.scene, camera, T_local_cam));
  }
  write_world(boxes(drive.scene), truth);
}

TEST(ProgramTruth, AMapOfTruePosesLiesOnTheTrueSurfaces) {
  const TemporaryFolder scratch;
  const SyntheticDrive drive(street_scene(), 5, 0.8);
  const std::filesystem::path root = scratch / "drives";
  const std::filesystem::path folder = write_kitti_drive(drive, root);
  const auto map = (scratch / "out.fovea").string(), json = (scratch / "scores.json").string();
  const auto evaluate = [&](const std::string& more) {
    return run_fovea("evaluate '" + map + "' '" + root.string() + "' " + more);
  };
  const ProgramRun mapped = run_fovea("map '" + root.string() + "' -o '" + map +
                                      "' --poses navigation --set motion.compensate=false");
  ASSERT_EQ(mapped.exit_code, 0) << mapped.err;

  const ProgramRun untrue = evaluate("--truth");
  EXPECT_EQ(untrue.exit_code, 1);
  EXPECT_THAT(untrue.err, HasSubstr("the drive has no truth"));
  EXPECT_EQ(std::count(untrue.err.begin(), untrue.err.end(), '\n'), 1) << untrue.err;

  write_truth(drive, folder);
  const ProgramRun run = evaluate("--protocol truth --json '" + json + "'");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("F-score"));
  const auto scores = nlohmann::json::parse(read_text(json));
  EXPECT_EQ(scores.at("protocol"), "truth");
  EXPECT_EQ(scores.at("georeferenced"), true);
  EXPECT_LT(scores.at("pose_absolute_m").at("max"), 1e-3);
  EXPECT_LT(scores.at("pose_aligned_m").at("max"), 1e-3);
  EXPECT_LT(scores.at("accuracy_measured_max"), 0.01);
  EXPECT_LT(scores.at("accuracy_interpolated_median"), 0.005);
  EXPECT_GT(scores.at("precision_5cm"), 0.95);
  EXPECT_GT(scores.at("completeness_20cm"), 0.9);
  EXPECT_LT(scores.at("color_view").at("mean"), 3);
  EXPECT_EQ(scores.at("ghosts"), 0);
  EXPECT_GT(scores.at("upsampling_recovered_5cm"), 0.1);

  EXPECT_EQ(evaluate("--truth --no-align").exit_code, 0);
  EXPECT_EQ(evaluate("--truth --protocol held-out").exit_code, 2);
  EXPECT_EQ(evaluate("--truth --hold-out 8:4").exit_code, 2);
  EXPECT_EQ(evaluate("--no-align").exit_code, 2);

  // The exported cloud scores the same with its poses.
  const auto ply = (scratch / "out.ply").string(), poses = (scratch / "poses.txt").string();
  ASSERT_EQ(run_fovea("export '" + map + "' '" + ply + "'").exit_code, 0);
  ASSERT_EQ(run_fovea("export '" + map + "' '" + poses + "' --format kitti-poses").exit_code, 0);
  const ProgramRun cloud = run_fovea("evaluate '" + ply + "' '" + root.string() +
                                     "' --truth --poses '" + poses + "' --json '" + json + "'");
  ASSERT_EQ(cloud.exit_code, 0) << cloud.err;
  const auto cloud_scores = nlohmann::json::parse(read_text(json));
  for (const char* key : {"accuracy_measured_mean", "accuracy_interpolated_p95", "f_score_5cm"}) {
    EXPECT_NEAR(cloud_scores.at(key), scores.at(key), 1e-5) << key;
  }
  EXPECT_EQ(cloud_scores.at("color_view").at("points"), scores.at("color_view").at("points"));
}

}  // namespace fovea::program_truth_test
