// fovea register: align two scans.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "app/commands.h"
#include "app/number_checks.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/registration/registration.h"
#include "fovea/pipeline/config_keys.h"
#include "fovea/sensor/kitti_scan.h"

namespace fovea::app {
namespace {

struct RegisterArguments {
  std::string source, target, method = "gicp", guess;
  double voxel = 0.25;
};

RegistrationCloud read_cloud(const std::string& file, double voxel,
                             const RegistrationOptions& options) {
  return prepare_cloud(
      voxel_thinned(read_kitti_scan(file).points.position, static_cast<float>(voxel)), options,
      voxel);
}

void run(const RegisterArguments& arguments) {
  RegistrationOptions options;
  for (const auto& entry : names_of(options.method)) {
    if (entry.name == arguments.method) options.method = entry.value;
  }
  const RigidMotion guess =
      arguments.guess.empty() ? RigidMotion::Identity() : read_poses(arguments.guess).front();
  const RegistrationCloud target = read_cloud(arguments.target, arguments.voxel, options);
  const RegistrationCloud source = read_cloud(arguments.source, arguments.voxel, options);
  const PointIndex index(target.points, arguments.voxel);
  const RegistrationResult result = register_clouds(target, index, source, guess, options);
  fmt::print("{}\n", format_pose(result.T_target_source));
  fmt::print(stderr, "{} after {} iterations, {} pairs, rms {:.4f} m, {} degenerate directions\n",
             result.converged ? "converged" : "NOT converged", result.iterations, result.pairs,
             result.rms_distance, result.degenerate_directions);
}

}  // namespace

void add_register_command(CLI::App& app) {
  auto arguments = std::make_shared<RegisterArguments>();
  CLI::App* command =
      app.add_subcommand("register", "Align two KITTI scans: prints T_target_source as 12 numbers");
  command->add_option("SOURCE.bin", arguments->source, "Scan to be moved")->required();
  command->add_option("TARGET.bin", arguments->target, "Scan to be met")->required();
  command->add_option("--method", arguments->method, "gicp, icp (point to point) or plane")
      ->capture_default_str()
      ->check(CLI::IsMember({"gicp", "icp", "plane"}));
  command->add_option("--guess", arguments->guess,
                      "File whose first line is a guess of T_target_source");
  command->add_option("--voxel", arguments->voxel, "Edge of the sampling voxels in m, 0 for none")
      ->capture_default_str()
      ->check(finite_range(0.0, 10.0));
  command->callback([arguments] { run(*arguments); });
}

}  // namespace fovea::app
