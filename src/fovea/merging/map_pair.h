// How two maps of one place lie to each other, submap by submap: the result of fovea align.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "fovea/merging/submap_match.h"

namespace fovea {

/// A map as files name it that refer to it.
struct MapName {
  std::string identity;  ///< MapReader::identity()
  std::string drive;     ///< for people: name of the drive
  std::size_t submaps = 0;
};
MapName name_of(const MapReader& map, const MapContent& content);

enum class PairVerdict {
  kFits,
  kNoOverlap,  ///< no submaps have common space
  kNoFit,      ///< they have, but too few of them fit at one place
};
const char* to_string(PairVerdict verdict);

struct MapPair {
  MapName a, b;
  PairVerdict verdict = PairVerdict::kNoOverlap;
  std::size_t tried = 0;             ///< pairs of submaps with common space
  std::vector<SubmapMatch> matches;  ///< empty unless the maps fit
  /// m, how far the matches move B from where the georeferences place it: median.
  double moved = 0;
};

/// Finds the relative poses and gains of the submaps of two maps. Georeferences may be off by 5 m,
/// and by up to 25 m if both maps show enough walls to tell where they fit.
/// @throws InputError  if a map is damaged, or nothing says how the maps lie to each other: both
///                     need a georeference or a common drive
MapPair align_pair(const MapReader& a, const MapReader& b);

}  // namespace fovea
