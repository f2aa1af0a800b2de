// What a scan and its images show before anybody knows where they were taken: made while the scan
// is registered.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fovea/mapping/image_pyramid.h"
#include "fovea/mapping/range_image.h"
#include "fovea/mapping/surface.h"
#include "fovea/pipeline/mapper_options.h"
#include "fovea/pipeline/stage_clock.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

/// One camera's view of a scan.
struct ScanView {
  Camera camera;  ///< where it was when the image was taken
  /// The foveal points in the camera's frame; where the ray filter says so, without those that
  /// other points hide from the camera.
  PointCloud foveal_cam;
  std::optional<Surface> surface;       ///< between them, where it is sampled on a grid ...
  std::optional<PointCloud> upsampled;  ///< ... or else they and what is between them
  std::optional<ImagePyramid> pyramid;  ///< of the image, where colours are those of patches
};

struct ScanViews {
  /// By camera of the drive; none of those whose image is missing or blank, and none at all unless
  /// a foveal region is mapped.
  std::vector<std::optional<ScanView>> of_camera;
  std::optional<RangeImage> ranges;       ///< of the whole scan, where moving things are removed
  std::map<std::string, double> figures;  ///< for the frame's record
  StageClock clock;
};

/// Whether an image can give colours; a blank one is counted, a missing one the drive has told of.
bool shows_something(const Image& image, std::map<std::string, double>& figures);

/// @param scan_lidar  motion compensated
/// @param cameras     of the drive, where they were when the frame's images were taken; of a drive
///                    without cameras, lidar_views()
ScanViews view_scan(const PointCloud& scan_lidar, const Frame& frame,
                    const std::vector<Camera>& cameras, const MapperOptions& options);

}  // namespace fovea
