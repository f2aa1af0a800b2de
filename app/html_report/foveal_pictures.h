// The paper's picture of foveal processing: the region before and after upsampling, and textured.
#pragma once

#include <string>

#include "app/html_report/training_scans.h"

namespace fovea::app {

/// The foveal region of the middle one of the training frames in the drive's first camera, with the
/// settings the map was made with, from beside the camera: points as measured, upsampled,
/// and coloured. A paragraph that says why, where there is nothing to show.
std::string foveal_section(const ScoredMap& map, const FrameSource& drive,
                           const std::vector<PlacedFrame>& training);

}  // namespace fovea::app
