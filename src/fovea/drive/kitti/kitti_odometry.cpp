// KITTI odometry sequences: sequences/NN.
#include <fmt/format.h>

#include "fovea/drive/drive_files.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/kitti/kitti_drives.h"
#include "fovea/drive/plausible_lens.h"
#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"

namespace fovea {
namespace {

/// The images' size, which calib.txt does not give: that of the first image that can be read.
void read_image_size(const NumberedFiles& images, Camera& camera) {
  for (const auto& [index, file] : images) {
    try {
      const Image image = read_image(file);
      camera.width = image.width;
      camera.height = image.height;
    } catch (const InputError&) {
      continue;  // load() reports it when its turn comes
    }
    if (const auto problem = lens_problem(camera)) {
      throw InputError(fmt::format("P{} of calib.txt is wrong: {}", camera.index, problem->what),
                       file.string(), problem->remedy);
    }
    return;
  }
  throw InputError(fmt::format("no image of camera {} can be read", camera.index),
                   images.begin()->second.parent_path().string(),
                   "restore the images from the drive's archive");
}

/// poses.txt in the sequence's folder, or ../../poses/NN.txt as KITTI ships them.
std::optional<std::filesystem::path> find_poses(const std::filesystem::path& sequence) {
  for (const auto& file : {sequence / "poses.txt", shipped_poses(sequence)}) {
    if (std::filesystem::exists(file)) return file;
  }
  return std::nullopt;
}

/// Reads poses of (rectified) camera 0 into info.reference_poses, which are the LiDAR's, relative
/// to its first. A damaged file gives a note and no poses: only an evaluation would miss them.
void find_reference_poses(const RigidMotion& T_cam0_lidar, DriveInfo& info) {
  const auto file = find_poses(info.path);
  if (!file) return;
  try {
    info.reference_poses = read_poses(*file);
  } catch (const InputError& error) {
    info.warn(fmt::format("{}: the reference poses are not used", error.what()));
    return;
  }
  const RigidMotion T_first_world = (info.reference_poses.front() * T_cam0_lidar).inverse();
  for (RigidMotion& pose : info.reference_poses) pose = T_first_world * pose * T_cam0_lidar;
}

}  // namespace

std::filesystem::path shipped_poses(const std::filesystem::path& sequence) {
  const auto folder = std::filesystem::absolute(sequence / "").lexically_normal().parent_path();
  return folder.parent_path().parent_path() / "poses" / (folder.filename().string() + ".txt");
}

std::unique_ptr<FrameSource> open_kitti_odometry(const std::filesystem::path& path,
                                                 const DriveOptions& options) {
  DriveInfo info;
  DriveFiles files;
  info.path = path;
  info.kind = "kitti-odometry";
  info.sweep_compensated = true;
  files.scans = list_numbered_files(path / "velodyne", {".bin"});
  if (files.scans.empty()) {
    throw InputError("the sequence has no scan", (path / "velodyne" / "*.bin").string(),
                     "restore the scans from KITTI's data_odometry_velodyne archive");
  }
  std::tie(info.begin, info.end) = frame_range(files.scans, options, path);
  const KittiCalibration calibration = read_kitti_odometry_calibration(path / "calib.txt");
  if (options.use_images) find_images(calibration, options, "image_", "", info, files);
  for (std::size_t k = 0; k < files.images.size(); ++k) {
    read_image_size(files.images[k], info.calibration.cameras[k]);
  }
  find_stamps(path / "times.txt", read_seconds, info, files);
  find_reference_poses(calibration.T_cam0_lidar, info);
  return make_frame_source(std::move(info), std::move(files));
}

}  // namespace fovea
