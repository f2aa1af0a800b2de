// KITTI's two forms of a drive. open_drive() chooses between them.
#pragma once

#include "fovea/drive/frame_source.h"

namespace fovea {

/// Raw: velodyne_points/, image_00..03/, oxts/, calibration in the parent folder.
std::unique_ptr<FrameSource> open_kitti_raw(const std::filesystem::path& path,
                                            const DriveOptions& options);

/// Odometry: velodyne/, image_0..3/, calib.txt, times.txt, and perhaps poses.
std::unique_ptr<FrameSource> open_kitti_odometry(const std::filesystem::path& path,
                                                 const DriveOptions& options);

/// ../../poses/NN.txt of a sequence sequences/NN, where KITTI ships its poses.
std::filesystem::path shipped_poses(const std::filesystem::path& sequence);

/// The synced raw drives two folders below: ROOT/DATE/DATE_drive_NNNN_sync; sorted.
std::vector<std::filesystem::path> raw_drives_below(const std::filesystem::path& root);

}  // namespace fovea
