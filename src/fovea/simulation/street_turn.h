// Crossings of streets at right angles: their size, and the turn of a path from street to street.
#pragma once

namespace fovea {

inline constexpr double kJunction = 9;  ///< half the side of a crossing's square (m)
/// A turn begins this far before the crossing's middle, and ends this far beyond it (m).
inline constexpr double kCorner = 11.5;

/// Heading (rad) along one turn to the left, against the direction in which it begins. The
/// curvature is a raised cosine.
/// @param u  share of the turn's length, 0 to 1
double turn_heading(double u);

/// Curvature (1/m) at that place of a turn to the left.
/// @param into    way since the turn's begin (m)
/// @param length  of the turn, turn_length()
double turn_curvature(double into, double length);

/// Length (m) of a turn that begins kCorner before the crossing's middle and ends kCorner beyond
/// it.
double turn_length();

}  // namespace fovea
