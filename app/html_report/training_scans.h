// The scans that a map was made of, or with a cloud's poses could have been, for the pictures that
// show how mapping works.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/evaluation/protocol.h"
#include "fovea/pipeline/map_settings.h"

namespace fovea::app {

/// The mapped frames of a map, or of a cloud all that have a pose and are not among `scored`; by
/// increasing index, with their poses and velocities. Empty if there is none.
std::vector<PlacedFrame> training_scans(const ScoredMap& map, const FrameSource& drive,
                                        const std::vector<PlacedFrame>& scored);

/// A frame with its scan motion compensated.
struct TrainingFrame {
  Frame frame;
  PointCloud scan_lidar;
};
/// Empty if the drive cannot load it.
std::optional<TrainingFrame> load_frame(const FrameSource& drive, const PlacedFrame& placed);

/// The settings that the map was made with; of a cloud, or where they are not known, the default's.
MapSettings settings_of(const ScoredMap& map);

/// Why a section has no pictures, as a paragraph.
std::string excuse(const std::string& why);

}  // namespace fovea::app
