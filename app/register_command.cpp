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
#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/fusion/place_match.h"
#include "fovea/mapping/registration/registration.h"
#include "fovea/pipeline/settings_rows.h"

namespace fovea::app {
namespace {

struct RegisterArguments {
  std::string source, target, method = "gicp", guess;
  double voxel = 0.25;
};

/// A scan, thinned.
std::vector<Eigen::Vector3f> read_points(const std::string& file, double voxel) {
  return voxel_thinned(read_lidar_scan(file, {}, 0).points.position, static_cast<float>(voxel));
}

/// A scan with normals, for place_fit().
struct ScanSurfaces {
  RegistrationCloud cloud;
  PointIndex index;
  ScanSurfaces(const std::vector<Eigen::Vector3f>& points, double voxel)
      : cloud(prepare_cloud(points, RegistrationOptions(), voxel)), index(cloud.points, voxel) {}
};

/// The better one of both directions: a scan of a wider view has parts that the other one lacks.
PlaceFit fit_of(const ScanSurfaces& target, const ScanSurfaces& source,
                const RigidMotion& T_target_source) {
  constexpr PlaceFitOptions kOptions{.pair_distance = 1, .on_plane = 0.1f, .alike = 0.5f};
  const PlaceFit forward =
      place_fit(target.cloud, target.index, source.cloud, T_target_source, kOptions);
  const PlaceFit back =
      place_fit(source.cloud, source.index, target.cloud, T_target_source.inverse(), kOptions);
  return forward.overlap * forward.on_plane > back.overlap * back.on_plane ? forward : back;
}

/// InputError unless the vertical surfaces of both scans lie on each other. Scans of one place, up
/// to 20 m apart: overlap 0.86, on_plane 0.75 and more (KITTI 0009, simulated streets; 16 to 64
/// rings). Scans of two places, and false minima: overlap up to 0.45, or on_plane up to 0.53.
void require_fit(const RegisterArguments& arguments, const PlaceFit& fit) {
  constexpr std::size_t kLeastPoints = 50;
  constexpr double kLeastOverlap = 0.5, kLeastOnPlane = 0.6;
  if (fit.vertical < kLeastPoints) {
    print_err("the scans have too few vertical surfaces to confirm the motion\n");
    return;
  }
  if (fit.overlap >= kLeastOverlap && fit.on_plane >= kLeastOnPlane) return;
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
  for (const auto& entry : names_of(options.method)) {
    if (entry.name == arguments.method) options.method = entry.value;
  }
  const RigidMotion guess =
      arguments.guess.empty() ? RigidMotion::Identity() : read_poses(arguments.guess).front();
  const auto target_points = read_points(arguments.target, arguments.voxel);
  const auto source_points = read_points(arguments.source, arguments.voxel);
  const RegistrationCloud target = prepare_cloud(target_points, options, arguments.voxel);
  const RegistrationCloud source = prepare_cloud(source_points, options, arguments.voxel);
  const PointIndex index(target.points, arguments.voxel);
  const RegistrationResult result = register_clouds(target, index, source, guess, options);
  require_fit(arguments,
              fit_of(ScanSurfaces(target_points, arguments.voxel),
                     ScanSurfaces(source_points, arguments.voxel), result.T_target_source));
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
