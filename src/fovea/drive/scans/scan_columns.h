// The columns of a scan that are read.
#pragma once

#include <array>
#include <cstddef>

namespace fovea {

enum ScanColumn : std::size_t { kScanX, kScanY, kScanZ, kScanIntensity, kScanRing, kScanTime };

/// Names for find_column(), by ScanColumn.
inline constexpr std::array<const char*, 6> kScanColumns = {"x",         "y",    "z",
                                                            "intensity", "ring", "time"};

inline constexpr const char* kScanDescription = "x y z, intensity, ring and time";

}  // namespace fovea
