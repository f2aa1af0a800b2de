// The paper's Table I: how long upsampling takes.
#pragma once

#include <cstddef>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/point_cloud.h"

namespace fovea::paper {

/// What one column upsamples.
struct UpsamplingCase {
  int wanted = 0;  ///< points to be produced, the paper's column
  int rate = 0;
  PointCloud points_cam;  ///< measured, in the camera's frame
};

/// Of the drive's middle scan in its first camera's view: the lowest rate that gives as many points
/// as a column wants, and as few points of the scan (drawn with a fixed seed) as that takes. Fewer
/// where the scan does not give as many at the highest rate.
std::vector<UpsamplingCase> upsampling_cases(const FrameSource& drive);

/// All points of that scan in view, in the camera's frame, in the order of the scan.
PointCloud scan_in_view(const FrameSource& drive);

/// The same in the order of drawing: a case's points are the first of them.
PointCloud shuffled_scan(const FrameSource& drive);

struct UpsamplingTime {
  int wanted = 0;          ///< points to be produced, the paper's column
  std::size_t given = 0;   ///< measured points that were upsampled
  std::size_t points = 0;  ///< all points after upsampling
  int rate = 0;
  double seconds = 0;  ///< median of some runs, on one thread
};

/// Upsamples the cases of a drive.
std::vector<UpsamplingTime> time_upsampling(const FrameSource& drive);

}  // namespace fovea::paper
