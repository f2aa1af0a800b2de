// What surfaces are made of: colour as a function of place, gloss, and how well a LiDAR sees them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>

#include "fovea/image.h"

namespace fovea {

/// How a material's colour varies over its texture coordinates (s, t, r), in metres.
enum class Pattern : std::uint8_t {
  kPlain,    ///< color everywhere
  kChecker,  ///< squares of `scale` in color and color_2 (tests)
  kGrain,    ///< color with grain down to 1 cm and stains: plaster, concrete, earth
  kAsphalt,  ///< grain, cracks, patches of another age
  kRoad,     ///< asphalt with markings: s across from the road's middle, t along it, `size` = (half
             ///< width, dash period)
  kSlabs,    ///< rectangular slabs of `size` with joints in color_2
  kBricks,   ///< courses of bricks of `size`, mortar color_2
  kBoards,   ///< boards along t, `scale` wide
  kFoliage,  ///< leaves: a colour of its own for every r
  kBark,     ///< streaks along t
  kGrass,    ///< blades and patches
  kLettering,  ///< `text` in color_2 on color, on a board of `size` from (0, 0)
  kFacade,     ///< windows painted on a distant wall, cells of `size`, glass color_2
};
/// Name of a pattern in a file ("bricks"), and back; std::invalid_argument for no such name.
std::string_view to_string(Pattern pattern);
Pattern parse_pattern(std::string_view name);

struct Material {
  std::string name;
  Pattern pattern = Pattern::kPlain;
  Eigen::Vector3f color = Eigen::Vector3f::Constant(0.5f);    ///< albedo, linear RGB 0-1
  Eigen::Vector3f color_2 = Eigen::Vector3f::Constant(0.5f);  ///< the pattern's other albedo
  float scale = 1;                                            ///< m, see Pattern
  Eigen::Vector2f size = Eigen::Vector2f::Ones();             ///< m, see Pattern
  float contrast = 1;        ///< of grain, stains and tints; 0: none
  std::uint32_t seed = 0;    ///< of the pattern's noise
  std::string text;          ///< of kLettering
  float gloss = 0;           ///< mirror reflection at normal incidence, 0-1; 0: matte
  float reflectance = 0.4f;  ///< for the LiDAR, 0-1
  bool glass = false;        ///< the LiDAR mostly sees nothing here
};

/// Albedo (linear RGB, 0-1) of a material at a place, averaged over about `footprint` (m): detail
/// finer than that fades out, so that what a camera samples does not alias.
Eigen::Vector3f albedo(const Material& material, const Eigen::Vector3f& texture, float footprint);

/// Linear RGB (0-1, clamped) -> 8-bit sRGB (IEC 61966-2-1), rounded to nearest; and back.
Rgb encode_srgb(const Eigen::Vector3f& linear);
Eigen::Vector3f decode_srgb(Rgb color);
/// The same without rounding or clamping above: 0-255 a channel.
Eigen::Vector3f encode_srgb_float(const Eigen::Vector3f& linear);

}  // namespace fovea
