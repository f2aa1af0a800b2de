// When the cameras take their images, and to which frame each image belongs.
#pragma once

#include <optional>
#include <vector>

#include "fovea/simulation/simulation_options.h"
#include "fovea/time.h"

namespace fovea {

/// One moment at which a camera is simulated.
struct Shot {
  TimeNs stamp = 0;
  std::optional<int> image;  ///< its number; absent: no image is taken, the truth alone is wanted
  bool is_of_frame = false;  ///< the truth of the frame is that of this moment
};

/// The shots by frame. Every frame has exactly one shot that is of the frame: the image that
/// belongs to it (docs/drives.md), or the middle of the sweep if no image does. Images that belong
/// to no frame are with the frame whose sweep's middle is nearest.
std::vector<std::vector<Shot>> image_schedule(const SimulationOptions& options,
                                              const SimulatedCamera& camera);

/// How many images the camera takes.
std::size_t image_count(const std::vector<std::vector<Shot>>& schedule);

/// Images a second; 0: one a sweep.
double image_rate(const CameraOptions& options, const SimulatedCamera& camera);

/// ConfigError for a rate or phase out of range.
void check_image_times(const CameraOptions& options);
/// ConfigError for those that KITTI's format cannot describe.
void check_kitti_image_times(const CameraOptions& options);

}  // namespace fovea
