// Whether an image's edges and a LiDAR's meet at all: tests for significance.
#pragma once

#include <vector>

#include "fovea/mapping/calibration/edge_profiles.h"

namespace fovea {

/// A mean over edges and its standard deviation. Edges of one frame err together, and so do edges
/// of one thing in all frames: the deviation is from the scatter over both.
struct EdgeMean {
  std::size_t edges = 0;
  double mean = 0, sigma = 0;
};
EdgeMean mean_over_edges(const std::vector<const EdgeProfile*>& profiles,
                         const std::vector<double>& values);

/// By how much edges are seen better (logarithm of their strength) under a correction than by a
/// camera turned from there by 8 to 16 pixels about one of its axes. Only edges count that such a
/// turn moves across themselves, and whose image shows a clear step anywhere on their profile.
/// Turns that lead out of a profile do not count.
/// @param axis        0: right (pitch), 1: down (yaw)
/// @param correction  in calibration_unit()s; zero: the calibration at hand
EdgeMean edge_contrast(const std::vector<EdgeProfile>& profiles, int axis,
                       const CalibrationVector& correction = CalibrationVector::Zero());

/// Whether camera and LiDAR do not agree under a correction: about one axis there are many edges,
/// and their contrast lies significantly below the least contrast of a right calibration.
bool edges_disagree(const std::vector<EdgeProfile>& profiles,
                    const CalibrationVector& correction = CalibrationVector::Zero());

/// By how much edges are seen better under one correction than under another one.
EdgeMean edge_gain(const std::vector<EdgeProfile>& profiles, const CalibrationVector& correction,
                   const CalibrationVector& other);

}  // namespace fovea
