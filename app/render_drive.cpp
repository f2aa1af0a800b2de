#include "app/render_drive.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "app/drive_arguments.h"
#include "app/map_arguments.h"
#include "app/print.h"
#include "app/progress_bar.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/kitti/kitti_calibration.h"
#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/rendering/render_drive.h"

namespace fovea::app {
namespace {

constexpr const char* kCameraForm =
    "give W,H,fx,fy,cx,cy (pixels), or a drive or KITTI calibration folder";

/// "a,b,c" as numbers; nothing if it is something else.
std::optional<std::vector<double>> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  const char* begin = text.data();
  const char* const end = begin + text.size();
  while (true) {
    double number = 0;
    const auto [after, error] = std::from_chars(begin, end, number);
    if (error != std::errc()) return std::nullopt;
    numbers.push_back(number);
    if (after == end) return numbers;
    if (*after != ',') return std::nullopt;
    begin = after + 1;
  }
}

/// A camera at the LiDAR that looks where it does: x right, y down, z forward.
RenderedCamera camera_of(const std::vector<double>& numbers) {
  const auto whole = [](double side) {
    return side >= 1 && side <= kMaxImageSide && side == std::floor(side);
  };
  const bool finite = std::all_of(numbers.begin(), numbers.end(),
                                  [](double number) { return std::isfinite(number); });
  if (numbers.size() != 6 || !finite || !whole(numbers[0]) || !whole(numbers[1]) ||
      !(numbers[2] > 0) || !(numbers[3] > 0)) {
    throw CLI::ValidationError("--camera", kCameraForm);
  }
  Camera camera;
  camera.width = int(numbers[0]), camera.height = int(numbers[1]);
  camera.fx = numbers[2], camera.fy = numbers[3];
  camera.cx = numbers[4], camera.cy = numbers[5];
  camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return {"camera", camera};
}

/// Whether the cameras are those of DRIVE, if there is one.
bool uses_cameras_of_drive(const RenderDriveArguments& arguments) {
  return arguments.camera.empty() || arguments.camera == "calib";
}

/// InputError if the map was not made of DRIVE.
void check_drive(const MapReader& map, const RenderDriveArguments& arguments) {
  if (arguments.drive.empty()) return;
  DriveOptions options;
  options.use_images = uses_cameras_of_drive(arguments);
  if (options.use_images && !arguments.cameras.empty()) {
    options.cameras = parse_cameras(arguments.cameras);
  }
  const auto drive = open_drive(arguments.drive, options);
  find_drive_in_map(map, arguments.map, *drive, arguments.foreign, arguments.quiet);
}

std::vector<Camera> calibrated_cameras(const std::string& path, const std::vector<int>& wanted) {
  namespace fs = std::filesystem;
  if (!fs::exists(fs::path(path) / "calib_cam_to_cam.txt")) {
    DriveOptions options;
    options.cameras = wanted;
    return open_drive(path, options)->info().calibration.cameras;
  }
  std::vector<Camera> cameras;
  for (const auto& [index, camera] : read_kitti_raw_calibration(path).cameras) {
    if (wanted.empty() || std::count(wanted.begin(), wanted.end(), index) > 0) {
      cameras.push_back(camera);
    }
  }
  if (cameras.size() < std::max<std::size_t>(1, wanted.size())) {
    throw ConfigError("the calibration lacks a camera", path,
                      "give --cameras with numbers that it has");
  }
  return cameras;
}

std::vector<RenderedCamera> find_cameras(const RenderDriveArguments& arguments) {
  const auto numbers = numbers_of(arguments.camera);
  const bool unused = numbers || (arguments.camera.empty() && arguments.drive.empty());
  if (unused && !arguments.cameras.empty()) {
    throw CLI::ValidationError("--cameras", "needs a DRIVE, or --camera with a calibration");
  }
  if (numbers) return {camera_of(*numbers)};
  const bool of_drive = uses_cameras_of_drive(arguments);
  if (of_drive && arguments.drive.empty()) {
    if (arguments.camera.empty()) return {};
    throw CLI::ValidationError("--camera",
                               "calib is that of DRIVE, which is named after MAP.fovea");
  }
  const std::string& calibration = of_drive ? arguments.drive : arguments.camera;
  std::vector<int> wanted;
  if (!arguments.cameras.empty()) wanted = parse_cameras(arguments.cameras);
  std::vector<RenderedCamera> cameras;
  for (Camera camera : calibrated_cameras(calibration, wanted)) {
    if (camera.width <= 0 || camera.height <= 0) {
      throw InputError(fmt::format("the size of camera {} is not known", camera.index), calibration,
                       "give W,H,fx,fy,cx,cy instead");
    }
    camera.image_delay = 0;  // a rendered image is of its frame's own moment
    cameras.push_back({fmt::format("camera_{}", camera.index), camera});
  }
  return cameras;
}

}  // namespace

void render_drive_command(const RenderDriveArguments& arguments, Warnings& warnings) {
  const ThreadLimit threads(arguments.threads);
  const MapReader map = open_map(arguments.map);
  check_drive(map, arguments);
  RenderJob job;
  job.output = arguments.output;
  job.force = arguments.force;
  job.cameras = find_cameras(arguments);
  if (!arguments.lidar.empty()) job.lidar = lidar_pattern(parse_lidar_model(arguments.lidar));
  if (job.cameras.empty() && !job.lidar) {
    throw CLI::ValidationError("--poses", "needs --camera, --lidar, or both");
  }
  job.T_local_lidar = read_poses(arguments.poses);
  job.period = from_seconds(1 / arguments.rate);
  job.reach = arguments.reach;
  job.exposure = arguments.exposure;
  const RenderFigures figures = [&] {
    ProgressBar bar(arguments.quiet);
    return render_drive(map, job, [&](int done, int total) { bar.draw(done, total); });
  }();
  if (figures.blank > 0) {
    warnings.add({fmt::format("{} images are black: the map has nothing there", figures.blank)},
                 arguments.quiet);
  }
  if (figures.empty > 0) {
    warnings.add({fmt::format("{} scans have no point and were not written", figures.empty)},
                 arguments.quiet);
  }
  if (arguments.quiet) return;
  print_out("{}: {} frames", arguments.output, figures.frames);
  if (!job.cameras.empty()) {
    print_out(", {} images each, {:.0f} % of their pixels show something", job.cameras.size(),
              100 * figures.covered);
  }
  if (job.lidar) print_out(", {:.0f} points a scan", figures.points);
  print_out("\n");
  if (job.cameras.empty() || !job.lidar || figures.empty == figures.frames) {
    print_out("note: it takes both images and scans to be a drive that fovea map reads\n");
  }
}

}  // namespace fovea::app
