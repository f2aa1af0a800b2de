// Gain between two colors of the same points (docs/method.md 6).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fovea/core/eigen_alignment.h"

namespace fovea {

/// Gain of each channel that brings a color to the known color of the same point. None if one of
/// the two is too dark (noise) or too bright (saturated).
/// @param known, seen  gray values
std::optional<Eigen::Array3f> gain_between(const Eigen::Array3f& known, const Eigen::Array3f& seen);

/// Whether an image's exposure differs from the map's by over 40 %: its colors must then not be
/// mixed with those of other images. Automatic exposure changes less from frame to frame.
bool is_exposure_off(const Eigen::Array3f& gain_to_map);

/// The gain for new points of an image whose exposure is off: nine tenths of the way to the map's
/// exposure. The map therefore follows a lasting change of light within seconds.
Eigen::Array3f matching_gain(const Eigen::Array3f& gain_to_map);

/// Median of each channel; 1 if there are too few gains.
Eigen::Array3f median_gain(const std::vector<Eigen::Array3f>& gains);

}  // namespace fovea
