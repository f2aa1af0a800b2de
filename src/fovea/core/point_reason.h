// Why a point is in a map, and what its colour was made by: one byte a point.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace fovea {

/// The rule that let a point into the map: the lower four bits of its reason.
enum class PointRule : std::uint8_t {
  kMeasured = 0,    ///< a return of the LiDAR, where it was measured
  kShortEdges = 1,  ///< sample of a triangle of edges below surface.max_edge
  kPlanar = 2,      ///< sample of a larger one, where the surface goes on straight across its edges
  kCentroid = 3,    ///< centroid of a triangle: the paper's upsampling
};
inline constexpr std::size_t kPointRules = 4;
/// By the rule's number.
inline constexpr std::array<std::string_view, kPointRules> kPointRuleNames = {
    "measured", "short-edges", "planar", "centroid"};

/// Bit of a reason: the point's first colour comes from an image whose exposure was off and that
/// was matched to the map's (docs/method.md 6).
inline constexpr std::uint8_t kExposureMatched = 0x10;

constexpr std::uint8_t reason_of(PointRule rule) { return static_cast<std::uint8_t>(rule); }
/// The rule's number in a reason; one that is unknown here comes from a damaged map.
constexpr std::uint8_t rule_number(std::uint8_t reason) { return reason & 0x0f; }

}  // namespace fovea
