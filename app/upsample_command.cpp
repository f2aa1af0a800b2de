// fovea upsample: one scan, densified on the triangles of its image projection.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "app/commands.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "fovea/drive/command_files.h"
#include "fovea/drive/kitti/kitti_calibration.h"
#include "fovea/drive/scans/lidar_scan.h"
#include "fovea/errors.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/upsample.h"

namespace fovea::app {
namespace {

struct UpsampleArguments {
  std::string scan, calibration, output;
  UpsampleOptions options;
  int camera = 2;
  bool force = false;
};

Camera find_camera(const UpsampleArguments& arguments) {
  const KittiCalibration calibration = read_kitti_raw_calibration(arguments.calibration);
  const auto found = calibration.cameras.find(arguments.camera);
  if (found == calibration.cameras.end()) {
    throw ConfigError(fmt::format("there is no camera {}", arguments.camera), arguments.calibration,
                      "give --camera with a number that the calibration has");
  }
  return found->second;
}

PointCloud in_view(const PointCloud& points_cam, const Camera& camera) {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < points_cam.size(); ++i) {
    const auto pixel = camera.project(points_cam.position[i].cast<double>());
    if (pixel && camera.in_view(*pixel)) indices.push_back(i);
  }
  return points_cam.select(indices);
}

void run(const UpsampleArguments& arguments) {
  check_files({{arguments.scan, arguments.calibration},
               {{arguments.output, ContentKind::kPly, arguments.force}}});
  const Camera camera = find_camera(arguments);
  const PointCloud scan_lidar = read_lidar_scan(arguments.scan, {}, 0).points;
  const PointCloud visible_cam = in_view(transform_cloud(scan_lidar, camera.T_cam_lidar), camera);
  const PointCloud dense_cam = upsample(visible_cam, camera, arguments.options);
  write_cloud_ply(transform_cloud(dense_cam, camera.T_cam_lidar.inverse()), arguments.output,
                  arguments.force);
  print_out("{} points in view, {} after upsampling\n", visible_cam.size(), dense_cam.size());
}

}  // namespace

void add_upsample_command(CLI::App& app, Session&) {
  auto arguments = std::make_shared<UpsampleArguments>();
  CLI::App* command = app.add_subcommand("upsample", "Densify one scan in a camera's view");
  command->add_option("SCAN", arguments->scan, "Scan in .bin, PCD or PLY")->required();
  command->add_option("CALIB_DIR", arguments->calibration, "Folder of the date's calibration files")
      ->required();
  command->add_option("OUT.ply", arguments->output, "Points in the LiDAR frame")->required();
  command->add_option("--rate", arguments->options.rate, "How often centroids are inserted")
      ->capture_default_str()
      ->check(whole_number(0, 5));
  command->add_option("--camera", arguments->camera, "Camera number")
      ->capture_default_str()
      ->check(whole_number(0));
  command->add_option("--tau", arguments->options.max_edge, "Longest edge of a filled triangle, m")
      ->capture_default_str()
      ->check(finite_range(1e-6, 1e6));
  command->add_flag("--force", arguments->force, "Overwrite OUT.ply");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace fovea::app
