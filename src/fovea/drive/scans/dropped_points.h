// Points of scans that are not used, by reason.
#pragma once

#include <cstddef>
#include <string>

namespace fovea {

struct DroppedPoints {
  /// At the origin, or NaN in a cloud of rows and columns: nothing came back. No fault.
  std::size_t no_return = 0;
  std::size_t not_finite = 0;
  std::size_t out_of_reach = 0;  ///< a coordinate beyond 1 km
  std::size_t off_time = 0;      ///< over a second off the stamp

  /// Those that were measured.
  std::size_t faulty() const { return not_finite + out_of_reach + off_time; }
  std::size_t total() const { return no_return + faulty(); }
  DroppedPoints& operator+=(const DroppedPoints& other);
  bool operator==(const DroppedPoints&) const = default;
};

/// Counts and reasons: "12 not finite, 3 beyond 1 km".
std::string reasons_of(const DroppedPoints& dropped);

/// What a user can do about the most frequent fault.
std::string remedy_for(const DroppedPoints& dropped);

/// Whether over 10 % of the points are faulty.
/// @param kept  points that are used
bool are_too_many(const DroppedPoints& dropped, std::size_t kept);

/// InputError that names count, reasons and remedy if over 10 % of the points are faulty.
/// @param kept   points that are used
/// @param where  file or folder of the scans
void require_few_dropped(const DroppedPoints& dropped, std::size_t kept, const std::string& where);

}  // namespace fovea
