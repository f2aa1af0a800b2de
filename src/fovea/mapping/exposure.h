// How much brighter one account of some colours is than another (docs/method.md 6).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace fovea {

/// What brings a colour to the one known of the same point, a channel; nothing if one of them tells
/// nothing: too dark (noise) or too bright (saturated).
/// @param known, seen  grey values
std::optional<Eigen::Array3f> gain_between(const Eigen::Array3f& known, const Eigen::Array3f& seen);

/// Whether an image's exposure is so far off the map's that its colours must not be mixed with
/// those of others: by over 40 %. What automatic exposure does from frame to frame is less.
bool is_exposure_off(const Eigen::Array3f& gain_to_map);

/// Median of each channel; 1 where too few tell.
Eigen::Array3f median_gain(const std::vector<Eigen::Array3f>& gains);

}  // namespace fovea
