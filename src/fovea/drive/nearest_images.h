// Which image belongs to which scan, by time.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fovea/time.h"

namespace fovea {

/// Stamps by the numbers of the files they are of.
using NumberedTimes = std::map<int, TimeNs>;

struct ImageMatches {
  std::map<int, int> image_of_scan;  ///< numbers of files
  double median_delay = 0;           ///< s, image after scan
  double min_delay = 0, max_delay = 0;
};

/// Gives each scan the image nearest in time to its sweep's middle, where that is at most
/// `tolerance` away; an image that is nearest to two scans goes to the nearer one (the earlier of
/// equals). Then once more round the median delay of these images, so that a camera that triggers
/// half-way between two sweeps does not belong now to the one before it and now to the one after
/// it.
/// @param sweep_middle  s after a scan's stamp
/// @param tolerance     s
ImageMatches match_nearest(const NumberedTimes& scans, const NumberedTimes& images,
                           double sweep_middle, double tolerance);

/// Gives each scan the other scan nearest to `delay` (s) after its stamp, at most `tolerance` (s)
/// from there. Each belongs to one scan only. Numbers of the others by numbers of the scans.
std::map<int, int> match_scans(const NumberedTimes& scans, const NumberedTimes& others,
                               double delay, double tolerance);

/// Why match_nearest() found no image: "they have different clocks, ...".
std::string why_none_matches(const NumberedTimes& scans, const NumberedTimes& images,
                             double tolerance);

}  // namespace fovea
