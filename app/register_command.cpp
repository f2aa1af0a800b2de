// fovea register: align two scans.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "fovea/drive/scans/lidar_scan.h"
#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/pipeline/settings_rows.h"
#include "fovea/registration.h"

namespace fovea::app {
namespace {

struct RegisterArguments {
  std::string source, target, method = "gicp", guess;
  double voxel = 0.25;
};

/// InputError unless the vertical surfaces of both scans lie on each other.
void require_fit(const RegisterArguments& arguments, const ScanFit& fit) {
  if (fit.shows_one_place()) return;
  if (fit.vertical < ScanFit::kLeastPoints) {
    print_err("the scans have too few vertical surfaces to confirm the motion\n");
    return;
  }
  throw InputError(
      fmt::format(
          "the registered scans do not lie on each other's surfaces ({:.0f} % of the points "
          "of vertical surfaces have a counterpart, {:.0f} % of these lie on its plane)",
          100 * fit.overlap, 100 * fit.on_plane),
      fmt::format("{} and {}", arguments.source, arguments.target),
      "give two scans of one place, or a closer --guess");
}

void run(const RegisterArguments& arguments) {
  RegistrationOptions options;
  options.voxel = arguments.voxel;
  for (const auto& entry : names_of(options.method)) {
    if (entry.name == arguments.method) options.method = entry.value;
  }
  const RigidMotion guess =
      arguments.guess.empty() ? RigidMotion::Identity() : read_poses(arguments.guess).front();
  const PointCloud target = read_lidar_scan(arguments.target, {}, 0).points;
  const PointCloud source = read_lidar_scan(arguments.source, {}, 0).points;
  const RegistrationResult result = register_scans(target, source, guess, options);
  require_fit(arguments, scan_fit(target, source, result.T_target_source));
  print_out("{}\n", format_pose(result.T_target_source));
  print_err("{} after {} iterations, {} pairs, rms {:.4f} m, {} degenerate directions\n",
            result.converged ? "converged" : "NOT converged", result.iterations, result.pairs,
            result.rms_distance, result.degenerate_directions);
}

}  // namespace

void add_register_command(CLI::App& app, Session&) {
  auto arguments = std::make_shared<RegisterArguments>();
  CLI::App* command = app.add_subcommand(
      "register", "Align two scans (.bin, PCD, PLY): prints T_target_source as 12 numbers");
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
