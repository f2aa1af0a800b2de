// Noise for procedural textures: the same for the same place, band-limited to what a camera
// resolves.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fovea/platform.h"

namespace fovea {

/// A number in [0, 1) of a cell of a grid and a seed.
float cell_random(int x, int y, std::uint32_t seed);

/// Value noise in [-1, 1]: random numbers at whole coordinates, smoothly interpolated between.
float value_noise(const Eigen::Vector2f& p, std::uint32_t seed);

/// Octaves of value noise from `longest` to `shortest` wavelength (m), each with half the
/// wavelength and 0.6 of the amplitude of the one before, about [-1, 1]; octaves finer than
/// `footprint` resolves fade out.
float layered_noise(const Eigen::Vector2f& p, float longest, float shortest, float footprint,
                    std::uint32_t seed);

/// Share of the interval of width `footprint` around x that lies in [low, high].
float band(float x, float low, float high, float footprint);

/// The same for bands [0, width) that repeat every `period`.
float repeated_band(float x, float period, float width, float footprint);

/// 1 while `footprint` resolves detail of that size, falling to 0 where it does not.
float resolved(float size, float footprint);

}  // namespace fovea
