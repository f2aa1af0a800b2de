// Two maps of one place as one map.
#pragma once

#include <cstddef>
#include <filesystem>

#include "fovea/mapping/radiometry.h"
#include "fovea/merging/alignment.h"
#include "fovea/merging/point_merge.h"

namespace fovea {

struct MergeJob {
  std::filesystem::path output;
  /// Overwrite `output`, and merge also maps that nothing says of how they lie to each other, or
  /// that meet nowhere: as their georeference says, or with one local frame.
  bool force = false;
  double spacing = 0.02;                      ///< of A's points, m
  std::size_t memory = std::size_t{1} << 30;  ///< as MapJob::memory
};

struct MergeFigures {
  std::size_t drives_added = 0;  ///< 0: A has them all already
  bool georeferenced = false;    ///< the guess came from both maps' georeference, or one drive
  MapAlignment alignment;
  LogGain gain_of_b = LogGain::Zero();  ///< taken out of B's colors: B = A * 2^gain
  PointMergeFigures merged;
  std::size_t points = 0;  ///< of the result
};

/// Writes a map of all that A and B show. A's frame, points and poses stay; B's submaps are
/// registered to it; where both have a surface A's points stay, with the colours of both. A drive
/// that A has already is left out: merging it again changes nothing. The frames of B are numbered
/// on from A's (merged_drives() tells). The output appears when it is whole.
/// @throws InputError   if a map cannot be read, if their tiles differ in size, and unless `force`
///                      if they do not overlap or nothing says how they lie to each other
/// @throws OutputError  as MapWriter
MergeFigures merge_maps(const MapReader& a, const MapReader& b, const MergeJob& job);

}  // namespace fovea
