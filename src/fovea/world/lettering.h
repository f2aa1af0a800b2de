// Letters made of strokes: readable on a sign at any resolution.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "fovea/platform.h"

namespace fovea {

/// Share of ink at a place of a board, averaged over `footprint` (m): `text` (A-Z, 0-9, space;
/// others are blank) in one line, centred, as large as fits.
/// @param place  from the board's lower left corner (m)
/// @param board  width and height (m)
float lettering_ink(std::string_view text, const Eigen::Vector2f& place,
                    const Eigen::Vector2f& board, float footprint);

}  // namespace fovea
