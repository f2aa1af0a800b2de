#include "fovea/drive/stamp_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "fovea/errors.h"

namespace fovea {
namespace {

struct Unit {
  TimeNs ns;
  const char* name;
};
constexpr std::array<Unit, 4> kUnits = {
    {{1, "ns"}, {1'000, "us"}, {1'000'000, "ms"}, {kNsPerSecond, "s"}}};

const char* name_of(TimeNs unit) {
  return std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& u) { return u.ns == unit; })
      ->name;
}

/// Whether a time since 1970 (ns) is a date of 2000 to 2100.
bool is_date(double ns) {
  constexpr double kYear = 365.25 * 86'400e9;
  return ns >= 30 * kYear && ns <= 130 * kYear;
}

void set_recognized(CsvRows& rows, TimeNs unit, const std::filesystem::path& file,
                    std::vector<std::string>& notes) {
  rows.set_time_unit(unit);
  if (unit == 1) return;
  notes.push_back(
      fmt::format("recognized: the times of {} are in {}; to state it, name the column "
                  "time_{}",
                  file.string(), name_of(unit), name_of(unit)));
}

/// The unit of stamps with this step; empty if none fits.
std::optional<TimeNs> unit_of_steps(const CsvRows::RawTimes& raw, bool has_fractions) {
  // Ns, from scan to scan. The factor is 1000: one unit at most fits.
  constexpr double kShortest = 5e6, kLongest = 5e9;
  constexpr double kShortestInNs = 1e6;  // parts of a sweep may be stamped
  std::optional<TimeNs> fitting;
  for (const Unit& unit : kUnits) {
    const double step = raw.step * double(unit.ns);
    if (step >= kShortest && step < kLongest) fitting = unit.ns;
  }
  if (has_fractions || raw.step < kShortestInNs) return fitting;
  // Here nanoseconds are possible, which the usual name of the column says. Dates decide.
  const bool is_other = fitting && !is_date(raw.first) && is_date(raw.first * double(*fitting));
  return is_other ? *fitting : 1;
}

/// The unit of the only stamp, by its date.
TimeNs unit_of_date(const CsvRows::RawTimes& raw, bool has_fractions) {
  if (has_fractions) return kNsPerSecond;
  for (const Unit& unit : kUnits) {
    if (is_date(raw.first * double(unit.ns))) return unit.ns;
  }
  return 1;
}

/// Share of the time of both that both have in common, s.
double overlap(double first, double last, const ScanPeriod& scans) {
  constexpr double kMargin = 0.1;  // s, so that a single time has some
  const double scans_first = seconds(scans.first) - kMargin,
               scans_last = seconds(scans.last) + kMargin;
  const double common =
      std::min(last + kMargin, scans_last) - std::max(first - kMargin, scans_first);
  const double all = std::max(last + kMargin, scans_last) - std::min(first - kMargin, scans_first);
  return std::max(0.0, common / all);
}

}  // namespace

void set_scan_time_unit(CsvRows& rows, const std::filesystem::path& file,
                        std::vector<std::string>& notes) {
  constexpr double kShortest = 0.001, kLongest = 60;  // s, of steps in a stated unit
  constexpr const char* kRemedy =
      "name the column by its unit: time_ns, time_us, time_ms or time_s";
  const std::optional<CsvRows::RawTimes> raw = rows.raw_times();
  if (!raw) return;
  if (rows.stated_unit) {
    const double step = raw->step * seconds(*rows.stated_unit);
    if (raw->step == 0 || (step >= kShortest && step <= kLongest)) return;
    throw InputError(fmt::format("stamps of scans are {:.4g} s apart by the column time_{}", step,
                                 name_of(*rows.stated_unit)),
                     file.string(), kRemedy);
  }
  if (raw->step == 0) {
    set_recognized(rows, unit_of_date(*raw, rows.has_fractions()), file, notes);
    return;
  }
  const std::optional<TimeNs> unit = unit_of_steps(*raw, rows.has_fractions());
  if (!unit) {
    throw InputError(fmt::format("stamps of scans are {:.4g} apart, no step of a LiDAR in ns, us, "
                                 "ms or s",
                                 raw->step),
                     file.string(), kRemedy);
  }
  set_recognized(rows, *unit, file, notes);
}

void set_time_unit_by_scans(CsvRows& rows, const ScanPeriod& scans,
                            const std::filesystem::path& file, std::vector<std::string>& notes) {
  constexpr double kShortest = 2e-4, kLongest = 10;  // s, from line to line
  constexpr double kClear = 100;                     // times the overlap in ns, for another unit
  const std::optional<CsvRows::RawTimes> raw = rows.raw_times();
  if (!raw || rows.stated_unit) return;
  double best = 0, in_ns = 0;
  TimeNs chosen = 1;
  for (const Unit& unit : kUnits) {
    const double s = seconds(unit.ns), step = raw->step * s;
    if (raw->step > 0 && (step < kShortest || step > kLongest)) continue;
    if (unit.ns == 1 && rows.has_fractions()) continue;
    const double share = overlap(raw->first * s, raw->last * s, scans);
    if (unit.ns == 1) in_ns = share;
    if (share > best && (unit.ns == 1 || share > kClear * in_ns)) best = share, chosen = unit.ns;
  }
  if (chosen != 1) set_recognized(rows, chosen, file, notes);
}

std::optional<ScanPeriod> period_of(const TimeStamps& stamps) {
  std::optional<ScanPeriod> period;
  for (const std::optional<TimeNs>& time : stamps.times) {
    if (!time) continue;
    if (!period) period = {*time, *time};
    period->last = *time;
  }
  return period;
}

CsvRows read_timed_csv(const std::filesystem::path& file, std::span<const CsvColumn> columns,
                       const std::optional<ScanPeriod>& scans, std::vector<std::string>& notes) {
  CsvRows rows = read_csv(file, columns);
  if (scans) set_time_unit_by_scans(rows, *scans, file, notes);
  return rows;
}

}  // namespace fovea
