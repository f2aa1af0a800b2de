// Gains of the submaps of many maps that give each surface one color.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

/// A submap.
struct GainNode {
  bool continues = false;                ///< the map of the submap before
  std::optional<Eigen::Vector3d> fixed;  ///< its gain, if it stays
};

/// Colors of submap b = colors of submap a * 2^log2_gain, as their maps show them.
struct GainTie {
  std::size_t a = 0, b = 0;
  Eigen::Vector3d log2_gain = Eigen::Vector3d::Zero();
};

/// Finds the gain of each submap, so that color * 2^gain is the same in all: base-2 logarithms of
/// red, green and blue. Robust: ties may be wrong. Gains stay near zero, and consecutive submaps of
/// a map have similar ones.
std::vector<Eigen::Vector3d> city_gains(const std::vector<GainNode>& nodes,
                                        const std::vector<GainTie>& ties);

}  // namespace fovea
