// Which image belongs to which scan, by time.
#pragma once

#include <map>
#include <vector>

#include "fovea/base/time.h"

namespace fovea {

/// Stamps by the numbers of the files they are of.
using NumberedTimes = std::map<int, TimeNs>;

struct ImageMatches {
  std::map<int, int> image_of_scan;  ///< numbers of files
  double median_delay = 0;           ///< s, image after scan
  double min_delay = 0, max_delay = 0;
};

/// Gives each scan the image nearest to it in time, where that is at most `tolerance` away; an
/// image that is nearest to two scans goes to the nearer one (the earlier of equals).
/// @param tolerance  s
ImageMatches match_nearest(const NumberedTimes& scans, const NumberedTimes& images,
                           double tolerance);

}  // namespace fovea
