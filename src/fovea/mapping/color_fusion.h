// One colour from many views (goes past the paper, which keeps one view; docs/method.md 6).
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fovea/base/image.h"

namespace fovea {

/// What is known of a point's colour; eight bits a channel are all that is kept.
struct FusedColor {
  Rgb color;
  std::uint8_t views = 0;    ///< 255: or more
  std::uint8_t spread = 0;   ///< RMS of the views' differences from the colour, grey values
  std::uint16_t weight = 0;  ///< sum of the views' weights
};

/// Weight of a view from this many metres: one over the distance, since a near view shows more
/// detail; as an integer of 1-100, so that sums are exact.
std::uint16_t view_weight(double distance);

/// Takes in one more view: weighted running mean and deviation (West 1979).
/// @param seen   colour in this view, 0-255 a channel
/// @param noise  random bits. Rounding up or down by chance lets steps below one grey value count,
///               which rounding to the nearest would lose
FusedColor fuse(const FusedColor& before, const Eigen::Vector3f& seen, std::uint16_t weight,
                std::uint64_t noise);

}  // namespace fovea
