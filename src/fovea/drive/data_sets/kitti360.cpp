// Layout: cvlibs.net/datasets/kitti-360/documentation.php.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "fovea/core/read_file.h"
#include "fovea/drive/data_sets/data_set.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/kitti/kitti_scan.h"
#include "fovea/drive/time_stamps.h"
#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_damaged(const fs::path& file, const std::string& what) {
  throw InputError(what, file.string(), "restore the file from the archive");
}

/// Numbers of the lines "KEY: NUMBERS".
using Numbers = std::map<std::string, std::vector<double>>;
Numbers read_numbers(const fs::path& file) {
  Numbers numbers;
  for (const std::string& line : read_lines(file)) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    if (const auto values = parse_numbers(line.substr(colon + 1))) {
      numbers[line.substr(0, colon)] = *values;
    }
  }
  return numbers;
}

RigidMotion motion_of(const std::vector<double>& rows, const fs::path& file,
                      const std::string& key) {
  if (rows.size() != 12) throw_damaged(file, fmt::format("{} has not 12 numbers", key));
  try {
    return checked_pose(
        Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(rows.data()));
  } catch (const std::invalid_argument& error) {
    throw_damaged(file, fmt::format("{} is no pose ({})", key, error.what()));
  }
}

struct Kitti360Calibration {
  std::vector<RecordedCamera> cameras;
  RigidMotion T_body_lidar;  // the body is that of the poses
};

/// Rectified cameras. T_lidar_cam_k = T_lidar_cam_0 * inv(T_body_cam_0) * T_body_cam_k *
/// inv(R_rect_k)
Kitti360Calibration read_calibration(const fs::path& folder) {
  const fs::path to_lidar = folder / "calib_cam_to_velo.txt",
                 to_body = folder / "calib_cam_to_pose.txt", optics = folder / "perspective.txt";
  const auto row = parse_numbers(fmt::format("{}", fmt::join(read_lines(to_lidar), " ")));
  const RigidMotion T_lidar_cam0 =
      motion_of(row.value_or(std::vector<double>()), to_lidar, "the line");
  Numbers body = read_numbers(to_body), numbers = read_numbers(optics);
  const RigidMotion T_body_cam0 = motion_of(body["image_00"], to_body, "image_00");
  Kitti360Calibration calibration;
  calibration.T_body_lidar = T_body_cam0 * T_lidar_cam0.inverse();
  for (int k = 0; k < 2; ++k) {
    const std::string suffix = fmt::format("_rect_{:02d}", k),
                      name = fmt::format("image_{:02d}", k);
    const std::vector<double>&P = numbers["P" + suffix], &R = numbers["R" + suffix],
          &size = numbers["S" + suffix];
    const bool has_size = size.size() == 2 && size[0] >= 1 && size[1] >= 1 &&
                          std::max(size[0], size[1]) <= kMaxImageSide;
    if (P.size() != 12 || R.size() != 9 || !has_size) {
      throw_damaged(optics, fmt::format("P{0}, R{0} or S{0} is missing or damaged", suffix));
    }
    const RigidMotion T_rect_cam = motion_of(
        {R[0], R[1], R[2], 0, R[3], R[4], R[5], 0, R[6], R[7], R[8], 0}, optics, "R" + suffix);
    const RigidMotion T_body_cam = motion_of(body[name], to_body, name);
    calibration.cameras.push_back(
        {name,
         k,
         {int(size[0]), int(size[1]), P[0], P[5], P[2], P[6], Lens()},
         T_lidar_cam0 * T_body_cam0.inverse() * T_body_cam * T_rect_cam.inverse()});
    if (!calibration.cameras.back().optics.has_pinhole()) {
      throw_damaged(optics, fmt::format("P{} is no camera's matrix", suffix));
    }
  }
  return calibration;
}

/// Poses of the body in the world, of those frames that have one.
std::map<int, RigidMotion> read_body_poses(const fs::path& file) {
  std::map<int, RigidMotion> poses;
  for (const std::string& line : read_lines(file)) {
    const auto numbers = parse_numbers(line);
    if (!numbers || numbers->empty()) continue;
    const bool has_frame = numbers->front() >= 0 && numbers->front() < kEndOfNames;
    if (numbers->size() != 13 || !has_frame) throw_damaged(file, "a line has not 13 numbers");
    poses[int(numbers->front())] =
        motion_of({numbers->begin() + 1, numbers->end()}, file, "a line");
  }
  return poses;
}

std::string sequence_name(const DataSetOptions& options) {
  const auto number = parse_numbers(options.scene);
  return choose_scene(kitti360_scenes(options.root), options, [&](const std::string& name) {
    const bool is_number =
        number && number->size() == 1 && number->front() >= 0 && number->front() < 10'000 &&
        name.find(fmt::format("_drive_{:04d}_", int(number->front()))) != std::string::npos;
    return name == options.scene || is_number;
  });
}

/// Files of a sensor by frame, with their stamps.
struct SensorFiles {
  explicit SensorFiles(const fs::path& folder, const char* data, const char* ending)
      : files(list_numbered_files(folder / data, {ending})),
        stamps(read_date_times(folder / "timestamps.txt")) {}

  std::optional<TimeNs> stamp(int frame) const {
    const bool is_known = frame >= 0 && std::size_t(frame) < stamps.times.size();
    return is_known ? stamps.times[std::size_t(frame)] : std::nullopt;
  }

  NumberedFiles files;
  TimeStamps stamps;
};

}  // namespace

std::vector<std::string> kitti360_scenes(const fs::path& root) {
  std::vector<std::string> names;
  std::error_code unknown;
  for (const auto& entry : fs::directory_iterator(root / "data_3d_raw", unknown)) {
    if (entry.is_directory()) names.push_back(entry.path().filename().string());  // no archive
  }
  if (names.empty()) {
    throw InputError("there are no sequences in data_3d_raw", root.string(),
                     "give the folder of KITTI-360");
  }
  std::sort(names.begin(), names.end());
  return names;
}

DataSetFigures convert_kitti360(const DataSetOptions& options) {
  const std::string sequence = sequence_name(options);
  const Kitti360Calibration calibration = read_calibration(options.root / "calibration");
  const std::map<int, RigidMotion> poses =
      read_body_poses(options.root / "data_poses" / sequence / "poses.txt");
  const SensorFiles scans(options.root / "data_3d_raw" / sequence / "velodyne_points", "data",
                          ".bin");
  std::vector<SensorFiles> images;
  images.reserve(calibration.cameras.size());
  for (const RecordedCamera& camera : calibration.cameras) {
    images.emplace_back(options.root / "data_2d_raw" / sequence / camera.name, "data_rect", ".png");
  }
  AdapterWriter writer(options.output, calibration.cameras, {options.force, false, {}});
  DataSetFigures figures;
  DroppedPoints dropped;
  std::optional<TimeNs> first;
  int done = 0, without_stamp = 0;
  for (const auto& [frame, file] : scans.files) {
    options.progress(++done, int(scans.files.size()));
    const auto stamp = scans.stamp(frame);
    without_stamp += !stamp;
    if (!stamp) continue;
    if (!first) first = stamp;
    if (!options.contains(*stamp, *first)) continue;
    std::vector<DriveImage> of_frame;
    for (std::size_t k = 0; k < images.size(); ++k) {
      const auto image = images[k].files.find(frame);
      const auto image_stamp = images[k].stamp(frame);
      if (image == images[k].files.end() || !image_stamp) continue;
      of_frame.push_back({calibration.cameras[k].name, *image_stamp, image->second});
    }
    std::optional<RigidMotion> T_world_lidar;
    if (const auto pose = poses.find(frame); pose != poses.end()) {
      T_world_lidar = pose->second * calibration.T_body_lidar;
    }
    const LidarScan points = read_kitti_scan(file);
    add_scan(file, *stamp, points, of_frame, T_world_lidar, writer);
    dropped += points.dropped;
  }
  if (!first) {
    throw InputError("no scan has a time stamp", (options.root / "data_3d_raw" / sequence).string(),
                     "restore timestamps.txt from the archive");
  }
  if (writer.scans() == 0) options.throw_nothing_left();
  static_cast<DriveWriterFigures&>(figures) = writer.close();
  figures.dropped += dropped;
  if (without_stamp > 0) figures.warn(fmt::format("{} scans have no time stamp", without_stamp));
  figures.notes.emplace_back("not used: the fisheye cameras and the SICK scanners");
  return figures;
}

}  // namespace fovea
