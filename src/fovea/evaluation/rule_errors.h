// Errors by what let the nearest map point into the map (core/point_reason.h): which kind of point
// costs how much.
#pragma once

#include <array>
#include <vector>

#include "fovea/evaluation/metrics.h"
#include "fovea/point_cloud.h"

namespace fovea {

/// Sums over evaluated points.
struct RuleErrors {
  std::size_t points = 0;
  double position = 0;            ///< ME, m
  double color = 0;               ///< TE
  double mean(double sum) const;  ///< NaN without points
};

/// By PointRule.
using ErrorsByRule = std::array<RuleErrors, kPointRules>;

/// @param nearest  index of the nearest map point of each point of `errors`
/// @param reason   of the map's points; empty where they are not known: all sums are zero
ErrorsByRule errors_by_rule(const PointErrors& errors, const std::vector<std::uint32_t>& nearest,
                            const std::vector<std::uint8_t>& reason);

void append(ErrorsByRule& to, const ErrorsByRule& other);

}  // namespace fovea
