// How well upsampling fills what a scan left out, on true hits: no map is involved.
#pragma once

#include <vector>

#include "fovea/camera.h"
#include "fovea/evaluation/distribution.h"
#include "fovea/evaluation/truth_poses.h"
#include "fovea/world/surface_index.h"

namespace fovea {

struct UpsamplingErrors {
  std::vector<float> distance;  ///< of the interpolated points to the nearest true surface (m)
  std::size_t frames = 0;       ///< scans that were upsampled
  std::size_t hidden = 0;       ///< true hits on hidden rings
  std::size_t recovered = 0;    ///< of these, with an interpolated or kept point within 5 cm
};

/// Hides every other ring of a scan's true hits (the static ones in a camera's view, 3-15 m),
/// upsamples the rest with the default options, and compares with the truth; in each camera, for 16
/// frames spread evenly over `frames` (all, if they are fewer).
UpsamplingErrors upsampling_errors(const DriveTruth& truth, const std::vector<PosePair>& frames,
                                   const std::vector<Camera>& cameras,
                                   const SurfaceIndex& surfaces);

}  // namespace fovea
