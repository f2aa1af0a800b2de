// The paper's picture of registration: two scans from above before and after, at each rate of
// upsampling.
#pragma once

#include <string>

#include "app/html_report/training_scans.h"

namespace fovea::app {

/// Rates that are shown: 0 to 3, the paper's E0-E3.
inline constexpr int kPairRates = 4;

/// The pair of neighbouring scans that the first guess places worst against the map's poses,
/// registered anew at each rate (generalised ICP against the scan before, as E0-E3), with the
/// distance of the scans before and after (see scan_matching.h). A paragraph that says why, where
/// there is no such pair.
/// @param training  see training_scans
std::string scan_pair_section(const FrameSource& drive, const std::vector<PlacedFrame>& training);

/// A window of the ground seen from above.
struct Window {
  Eigen::Vector2f center = Eigen::Vector2f::Zero();  ///< m
  float pixel = 1;                                   ///< m, edge
  int width = 0, height = 0;                         ///< pixels
};

/// Two clouds as dots in two colours, white where both are.
/// @param a, b  frame of the window, x to the right, y upwards (m)
Image draw_pair(const std::vector<Eigen::Vector3f>& a, const std::vector<Eigen::Vector3f>& b,
                const Window& window);

}  // namespace fovea::app
