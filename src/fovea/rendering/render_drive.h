// A map as the test bed of a drive that nobody has driven: images, depth and scans from any poses.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fovea/camera.h"
#include "fovea/map/color_display.h"
#include "fovea/map/map_store.h"
#include "fovea/rendering/virtual_lidar.h"
#include "fovea/time.h"

namespace fovea {

struct RenderedCamera {
  std::string name;  ///< of its folder
  Camera camera;     ///< with its number
};

struct RenderJob {
  std::filesystem::path output;
  bool force = false;                      ///< replace a drive that is there
  std::vector<RigidMotion> T_local_lidar;  ///< of the frames, in the map's frame
  TimeNs period = kNsPerSecond / 10;       ///< from frame to frame
  std::vector<RenderedCamera> cameras;
  std::optional<LidarPattern> lidar;
  double reach = 80;  ///< m, how far is seen
  ExposureChoice exposure = {};
};

struct RenderFigures {
  std::size_t frames = 0;
  double covered = 0;     ///< mean share of the images' pixels that show something
  double points = 0;      ///< mean of the scans
  std::size_t blank = 0;  ///< images without anything
  std::size_t empty = 0;  ///< scans without a point: not written
};

/// Writes a drive as docs/drives.md describes it: images/NAME/, lidar/ (KITTI's .bin), poses.csv,
/// drive.toml; and depth/NAME/NNNNNN.png: 16 bits, metres along the optical axis x 256, 0 where
/// nothing is (the form of KITTI's depth maps; nothing beyond 255 m). Images are the map's coloured
/// points as discs (rendering/splat.h), black where it has none. InputError if the map is damaged,
/// OutputError as GenericDriveWriter.
/// @param progress  called after each frame with how many are done, of how many
RenderFigures render_drive(const MapReader& map, const RenderJob& job,
                           const std::function<void(int, int)>& progress);

}  // namespace fovea
