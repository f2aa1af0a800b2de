// Significance tests of the agreement between an image's edges and a LiDAR's edges.
#pragma once

#include <array>
#include <vector>

#include "fovea/mapping/calibration/edge_profiles.h"

namespace fovea {

/// A mean over edges and its standard deviation, from the scatter over frames and over objects.
/// Edges of one frame have common errors, and so do edges of one object in all frames.
struct EdgeMean {
  std::size_t edges = 0;
  double mean = 0, sigma = 0;
};
EdgeMean mean_over_edges(const std::vector<const EdgeProfile*>& profiles,
                         const std::vector<double>& values);

/// Gain in the logarithm of edge strength of a correction over cameras rotated by a further 8 to 16
/// pixels about one axis. Counts edges that the rotation moves across themselves, with a clear step
/// of the image on their profile. Rotations that lead out of a profile do not count.
/// @param axis        0: right (pitch), 1: down (yaw)
/// @param correction  in calibration_unit()s; zero: the present calibration
EdgeMean edge_contrast(const std::vector<EdgeProfile>& profiles, int axis,
                       const CalibrationVector& correction = CalibrationVector::Zero());

/// Whether camera and LiDAR disagree under a correction. About one axis there must be many edges,
/// with a contrast significantly below that of a right calibration.
bool edges_disagree(const std::vector<EdgeProfile>& profiles,
                    const CalibrationVector& correction = CalibrationVector::Zero());

/// The profiles of the first and of the second half of the frames.
std::array<std::vector<EdgeProfile>, 2> halves_of(const std::vector<EdgeProfile>& profiles);

/// Whether the mean logarithm of edge strength at a correction exceeds that of cameras rotated by 8
/// pixels, by more than clutter does.
bool edges_stand_out(const std::vector<EdgeProfile>& profiles,
                     const CalibrationVector& correction = CalibrationVector::Zero());

/// Gain in the logarithm of edge strength of one correction over another.
EdgeMean edge_gain(const std::vector<EdgeProfile>& profiles, const CalibrationVector& correction,
                   const CalibrationVector& other);

}  // namespace fovea
