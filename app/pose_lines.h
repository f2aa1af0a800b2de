// Poses as lines of text, for programs that read standard output.
#pragma once

#include <cstdio>
#include <string>

#include "app/print.h"
#include "fovea/drive/bridge/published_pose.h"

namespace fovea::app {

/// "FRAME STAMP_NS STATE X Y Z QX QY QZ QW", and if the covariance is known, the standard
/// deviations "SX SY SZ SRX SRY SRZ" of the position (m) and of rotations (rad) about the axes of
/// the world. No line end.
std::string pose_line(const bridge::PublishedPose& pose);

/// Prints the line to standard output at once.
inline void print_pose(const bridge::PublishedPose& pose) {
  print_lines(pose_line(pose) + "\n");
  std::fflush(stdout);
}

}  // namespace fovea::app
