#include "fovea/drive/scans/point_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fovea/core/median.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr const char *kUnitKey = "lidar.time_unit", *kReferenceKey = "lidar.time_reference";

struct Unit {
  double seconds;
  const char* name;
};
constexpr std::array<Unit, 4> kUnits = {{{1, "s"}, {1e-3, "ms"}, {1e-6, "us"}, {1e-9, "ns"}}};

// s, of a sweep. The factor is not above 1000: of several units, one fits at most.
constexpr double kShortest = 0.002, kLongest = 2;
constexpr double kShortestStated = 0.0005;  // s
constexpr double kFarthest = 1;             // s from the stamp; ScanBuilder drops points beyond
constexpr double kTolerance = 0.001;        // s, of stamps

/// The times of the first scans.
class SweepTimes {
 public:
  explicit SweepTimes(std::span<const ScanNumbers> scans) {
    for (const ScanNumbers& scan : scans) {
      if (!scan.times || scan.times->count < 2) continue;
      stamps_.push_back(seconds(scan.stamp));
      middles_.push_back(scan.times->middle);
      spans_.push_back(scan.times->span);
      whole_ = scan.times->whole;
      split_ += scan.times->split;
    }
  }

  std::size_t size() const { return spans_.size(); }
  bool whole() const { return whole_; }
  /// Whether the times of most scans lie in two groups.
  bool split() const { return 2 * split_ > size(); }
  /// Of a sweep, in the unit of the file.
  double span() const { return median_of(spans_); }

  /// The longest that a sweep can take, s: sweeps overlap by a few steps of the stamps at most.
  double longest() const {
    constexpr double kMostSteps = 6;
    std::vector<double> steps;
    for (std::size_t i = 1; i < size(); ++i) steps.push_back(stamps_[i] - stamps_[i - 1]);
    const double step = median_of(std::move(steps));
    return step > 0 ? std::min(kLongest, kMostSteps * step) : kLongest;
  }
  /// Middles of the sweeps, s from the stamps.
  std::vector<double> middles(double unit, TimeReference reference) const {
    std::vector<double> middles;
    for (std::size_t i = 0; i < size(); ++i) {
      const double epoch = reference == TimeReference::kAbsolute ? stamps_[i] : 0;
      middles.push_back((middles_[i] - epoch / unit) * unit);
    }
    return middles;
  }

 private:
  std::vector<double> stamps_;           // s
  std::vector<double> middles_, spans_;  // in the unit of the file
  bool whole_ = false;
  std::size_t split_ = 0;  // scans
};

double spread(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most - *least;
}

double unit_of(const SweepTimes& times, std::optional<double> stated) {
  const double span = times.span();
  if (stated) {
    const double duration = span * *stated;
    if (times.split() || (duration >= kShortestStated && duration <= kLongest)) return *stated;
    throw ConfigError(
        fmt::format("a sweep takes {:.4g} s by this unit of its points' times", duration), kUnitKey,
        "state the right unit, or \"auto\"");
  }
  if (times.split()) {
    throw ConfigError(
        fmt::format("the times of the points of a scan lie in two groups, {:.4g} apart",
                    0.5 * span),
        kUnitKey, "state time_unit and time_reference (\"none\": read the points without times)");
  }
  constexpr double kFewest = 10;  // different whole times of a sweep; fewer are no times
  for (const Unit& unit : kUnits) {
    const double duration = span * unit.seconds;
    if (times.whole() && span < kFewest) break;
    if (duration >= kShortest && duration <= times.longest()) return unit.seconds;
  }
  if (span < kShortest && !times.whole()) return 1;
  throw ConfigError(
      fmt::format("the times of the points of a sweep span {:.6g}, no sweep's duration in s, ms, "
                  "us or ns",
                  span),
      kUnitKey, "state time_unit, or time_reference = \"none\" to read the points without times");
}

[[noreturn]] void throw_other_clock(double distance) {
  throw ConfigError(
      fmt::format("the points' times are {:.6g} s off the stamps of their scans", distance),
      kReferenceKey,
      "give stamps of the points' clock in stamps.csv, state \"first_point\" if the stamps are "
      "those "
      "of the first points, or \"none\" to read the points without times");
}

/// The reference of a single scan, or of scans of one stamp.
TimeReference reference_of_one(double from_stamp, double from_epoch, double duration) {
  const auto contains_stamp = [&](double middle) {
    constexpr double kGap = 0.01;  // s
    return std::abs(middle) <= 0.5 * duration + kGap;
  };
  const bool near_stamp = std::abs(from_stamp) <= kFarthest,
             near_epoch = std::abs(from_epoch) <= kFarthest;
  if (!near_stamp && !near_epoch) {
    throw_other_clock(std::min(std::abs(from_stamp), std::abs(from_epoch)));
  }
  if (near_stamp != near_epoch) {
    return near_stamp ? TimeReference::kStamp : TimeReference::kAbsolute;
  }
  if (std::abs(from_stamp - from_epoch) <= kTolerance) return TimeReference::kStamp;
  if (contains_stamp(from_stamp) != contains_stamp(from_epoch)) {
    return contains_stamp(from_stamp) ? TimeReference::kStamp : TimeReference::kAbsolute;
  }
  throw ConfigError(
      "the points' times may count from the scan's stamp or from the epoch of the stamps",
      kReferenceKey, "state \"stamp\" or \"absolute\"");
}

TimeReference reference_of(const SweepTimes& times, double unit,
                           std::optional<TimeReference> stated) {
  const std::vector<double> from_stamp = times.middles(unit, TimeReference::kStamp),
                            from_epoch = times.middles(unit, TimeReference::kAbsolute);
  const auto distance = [&](TimeReference reference) {
    return std::abs(median_of(reference == TimeReference::kStamp ? from_stamp : from_epoch));
  };
  if (stated) {
    const bool is_near = *stated == TimeReference::kFirstPoint || distance(*stated) <= kFarthest;
    if (is_near) return *stated;
    throw ConfigError(fmt::format("the points' times are {:.6g} s off the stamps of their scans by "
                                  "this reference",
                                  distance(*stated)),
                      kReferenceKey, "state what they count from, or \"auto\"");
  }
  const double difference = spread(from_stamp) - spread(from_epoch);
  if (std::abs(difference) <= kTolerance) {
    return reference_of_one(median_of(from_stamp), median_of(from_epoch), times.span() * unit);
  }
  // Absolute times advance with the stamps.
  const TimeReference reference = difference > 0 ? TimeReference::kAbsolute : TimeReference::kStamp;
  if (distance(reference) > kFarthest) throw_other_clock(distance(reference));
  return reference;
}

std::string note_of(double unit, TimeReference reference) {
  const auto* named =
      std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& u) { return u.seconds == unit; });
  const char* from = reference == TimeReference::kStamp      ? "scan's stamp"
                     : reference == TimeReference::kAbsolute ? "epoch of the stamps"
                                                             : "first point of the scan";
  return fmt::format("recognized: the points' times are in {} and count from the {}", named->name,
                     from);
}

}  // namespace

PointTimes recognize_point_times(std::span<const ScanNumbers> scans,
                                 const StatedScanFormat& stated) {
  if (stated.time_reference == TimeReference::kNone) return {TimeReference::kNone, {}, ""};
  const SweepTimes times(scans);
  const TimeReference usual = stated.time_reference.value_or(TimeReference::kStamp);
  if (times.size() == 0) return {usual, stated.time_unit, ""};
  if (times.span() == 0) {
    if (stated.time_reference) return {usual, stated.time_unit, ""};
    return {TimeReference::kNone,
            {},
            "recognized: the points have no times, since all times of a scan are equal"};
  }
  const double unit = unit_of(times, stated.time_unit);
  const TimeReference reference = reference_of(times, unit, stated.time_reference);
  const bool as_usual = reference == TimeReference::kStamp && unit == (times.whole() ? 1e-9 : 1),
             as_stated = stated.time_unit && stated.time_reference;
  return {reference, unit, as_usual || as_stated ? "" : note_of(unit, reference)};
}

}  // namespace fovea
