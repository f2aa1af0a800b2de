// KITTI's two forms of a drive. open_drive() chooses between them.
#pragma once

#include "fovea/sensor/frame_source.h"

namespace fovea {

/// Raw: velodyne_points/, image_00..03/, oxts/, calibration in the parent folder.
std::unique_ptr<FrameSource> open_kitti_raw(const std::filesystem::path& path,
                                            const DriveOptions& options);

/// Odometry: velodyne/, image_0..3/, calib.txt, times.txt, and perhaps poses.
std::unique_ptr<FrameSource> open_kitti_odometry(const std::filesystem::path& path,
                                                 const DriveOptions& options);

/// How far the stamps of a drive of this kind (DriveInfo::kind) are ahead of UTC. KITTI recorded in
/// September and October 2011 by the clock of Karlsruhe, which is summer time. The stamps of other
/// kinds are Unix time, which is UTC.
TimeNs utc_offset_of(std::string_view kind);

}  // namespace fovea
