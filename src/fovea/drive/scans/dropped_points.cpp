#include "fovea/drive/scans/dropped_points.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "fovea/errors.h"

namespace fovea {

DroppedPoints& DroppedPoints::operator+=(const DroppedPoints& other) {
  no_return += other.no_return;
  not_finite += other.not_finite;
  out_of_reach += other.out_of_reach;
  off_time += other.off_time;
  return *this;
}

std::string reasons_of(const DroppedPoints& dropped) {
  std::vector<std::string> reasons;
  const auto add = [&](std::size_t count, const char* reason) {
    if (count > 0) reasons.push_back(fmt::format("{} {}", count, reason));
  };
  add(dropped.not_finite, "not finite");
  add(dropped.out_of_reach, "beyond 1 km");
  add(dropped.off_time, "over 1 s off the stamp");
  add(dropped.no_return, "without a return");
  return fmt::format("{}", fmt::join(reasons, ", "));
}

std::string remedy_for(const DroppedPoints& dropped) {
  if (dropped.off_time > dropped.not_finite && dropped.off_time > dropped.out_of_reach) {
    return "state time_unit and time_reference in drive.toml, or correct the times";
  }
  if (dropped.out_of_reach > dropped.not_finite) {
    return "state length_unit in drive.toml, or give the points in the frame of the LiDAR";
  }
  return "restore the scans from a copy";
}

bool are_too_many(const DroppedPoints& dropped, std::size_t kept) {
  constexpr double kMostShare = 0.1;
  return double(dropped.faulty()) > kMostShare * double(kept + dropped.faulty());
}

void require_few_dropped(const DroppedPoints& dropped, std::size_t kept, const std::string& where) {
  if (!are_too_many(dropped, kept)) return;
  const std::size_t faulty = dropped.faulty(), all = kept + faulty;
  throw InputError(fmt::format("{} of {} points ({:.3g} %) cannot be used: {}", faulty, all,
                               100 * double(faulty) / double(all), reasons_of(dropped)),
                   where, remedy_for(dropped) + "; --allow-dropped uses the others");
}

}  // namespace fovea
