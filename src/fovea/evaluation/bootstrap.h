// How far means could be off had other frames been held out: 95% intervals by the bootstrap.
#pragma once

#include <limits>
#include <vector>

#include "fovea/evaluation/metrics.h"

namespace fovea {

/// What one frame adds to the means.
struct FrameSums {
  std::size_t points = 0;
  double me = 0, te = 0, mtme = 0, te_cross = 0;
};
FrameSums frame_sums(const PointErrors& errors);

/// NaN where it is not known.
struct Interval {
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
};
struct MeanIntervals {
  Interval me, te, mtme, te_cross;
};

/// Percentile intervals, 2.5% to 97.5%, of the means over all points (Efron 1979, "Bootstrap
/// methods: another look at the jackknife", Annals of Statistics 7). Whole frames are drawn, with
/// replacement, because the points of one frame err together; points drawn one by one would promise
/// intervals many times too narrow. The seed is fixed: the same frames give the same intervals.
/// Unknown with fewer than two frames that have points.
MeanIntervals bootstrap_means(const std::vector<FrameSums>& frames);

}  // namespace fovea
