#include "fovea/core/gps_time.h"

#include <algorithm>
#include <array>
#include <chrono>

namespace fovea {
namespace {

using std::chrono::January;
using std::chrono::July;
using std::chrono::sys_days;
using std::chrono::year;

constexpr TimeNs at(sys_days day) {
  return std::chrono::seconds(day.time_since_epoch()).count() * kNsPerSecond;
}

constexpr TimeNs kGpsEpoch = at(year(1980) / January / 6);
constexpr TimeNs kLastDate = at(year(2115) / January / 1);
constexpr TimeNs kAdjustment = 1'000'000'000 * kNsPerSecond;

/// From these days on there is one more (IERS Bulletin C).
constexpr std::array<TimeNs, 18> kLeaps = {
    at(year(1981) / July / 1),    at(year(1982) / July / 1),    at(year(1983) / July / 1),
    at(year(1985) / July / 1),    at(year(1988) / January / 1), at(year(1990) / January / 1),
    at(year(1991) / January / 1), at(year(1992) / July / 1),    at(year(1993) / July / 1),
    at(year(1994) / July / 1),    at(year(1996) / January / 1), at(year(1997) / July / 1),
    at(year(1999) / January / 1), at(year(2006) / January / 1), at(year(2009) / January / 1),
    at(year(2012) / July / 1),    at(year(2015) / July / 1),    at(year(2017) / January / 1)};

}  // namespace

int gps_leap_seconds(TimeNs utc) {
  return static_cast<int>(std::upper_bound(kLeaps.begin(), kLeaps.end(), utc) - kLeaps.begin());
}

std::optional<double> adjusted_gps_seconds(TimeNs utc) {
  if (utc < kGpsEpoch || utc > kLastDate) return std::nullopt;
  return seconds(utc - kGpsEpoch + gps_leap_seconds(utc) * kNsPerSecond - kAdjustment);
}

}  // namespace fovea
