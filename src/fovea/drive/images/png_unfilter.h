// The filters of PNG rows, undone (ISO/IEC 15948, section 9).
#pragma once

#include <cstddef>
#include <cstdint>

namespace fovea {

/// Undoes the filter of a row of 8-bit samples in place.
/// @param filter           the byte before the row: 0 None, 1 Sub, 2 Up, 3 Average, 4 Paeth
/// @param bytes_per_pixel  1 to 4
/// @param row, bytes       the row without its filter byte; whole pixels
/// @param above            the row above, its filter undone; zeros above the first
/// @return false, and the row as it was, if there is no such filter
bool unfilter_row(std::uint8_t filter, int bytes_per_pixel, std::uint8_t* row, std::size_t bytes,
                  const std::uint8_t* above);

}  // namespace fovea
