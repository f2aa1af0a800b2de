// New colours for a map that is there: its points and poses stay, the images are seen again.
#pragma once

#include <filesystem>
#include <functional>

#include "fovea/drive/frame_source.h"
#include "fovea/map/map_store.h"
#include "fovea/pipeline/map_settings.h"

namespace fovea {

struct RecolorJob {
  std::filesystem::path output;
  MapSettings settings;  ///< those of foveal region, texture and sampling are used
  bool force = false;    ///< overwrite `output`
  int drive = 0;         ///< number of the drive in the map, for the points' column `session`
  std::size_t memory = std::size_t{1} << 30;  ///< as MapJob::memory
};

struct RecolorFigures {
  std::size_t points = 0;
  std::size_t uncolored = 0;   ///< points that no image shows, or none in the foveal region
  int frames = 0, unread = 0;  ///< used; of the map, but no longer to be had
  int images_left_out = 0;     ///< blank
};

/// Shows the images of a map's frames to its points anew, in order, under the poses that the map
/// has; held-out frames stay held out. What hides a point is all of the map, also what came later.
/// The colours are fused as the mapper fuses them. The output appears when it is whole. `progress`
/// is called after each frame with how many are done, and of how many.
/// @param source  the drive, under the calibration that is to be used
/// @throws InputError   if map or drive cannot be read, or no frame of the map is to be had
/// @throws OutputError  as MapWriter
RecolorFigures recolor_map(const MapReader& map, const FrameSource& source, const RecolorJob& job,
                           const std::function<void(int, int)>& progress = {});

}  // namespace fovea
