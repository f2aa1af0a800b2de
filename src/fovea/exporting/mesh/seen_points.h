// Points of surfaces, with the side that was seen.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fovea/image.h"

namespace fovea {

/// Trivially copyable: these lie in scratch files.
struct SeenPoint {
  std::array<float, 3> position{};       ///< m, from its block's lowest corner
  std::array<std::int8_t, 3> towards{};  ///< direction to the sensor that saw it, times 127
  std::uint8_t colored = 0;              ///< whether a camera gave the colour
  Rgb color;                             ///< meaningful where colored is 1
};

/// Positions and directions as vectors; a point's direction is never zero.
Eigen::Vector3f position_of(const SeenPoint& point);
Eigen::Vector3f direction_of(const SeenPoint& point);
SeenPoint seen_point(const Eigen::Vector3f& position, const Eigen::Vector3f& towards);

/// The cell of a block (each coordinate from 0 to kBlockCells - 1) that a point lies in.
Eigen::Array3i cell_in_block(const SeenPoint& point, double cell);

/// One point for all in a cell that were seen from one side, in their middle and of their mean
/// colour: two sides of a thin wall stay apart. In the order in which cells first appear.
/// @param points  of one block
/// @param cell    m
std::vector<SeenPoint> thinned(const std::vector<SeenPoint>& points, double cell);

}  // namespace fovea
