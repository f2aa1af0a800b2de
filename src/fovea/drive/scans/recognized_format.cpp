#include "fovea/drive/scans/recognized_format.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

#include "fovea/core/median.h"
#include "fovea/core/point_formats/column_names.h"
#include "fovea/drive/scans/point_times.h"
#include "fovea/drive/scans/scan_columns.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

using Notes = std::vector<FormatNote>;

/// Half of the points of half of the scans are nearer; 0 if no scan has a point.
double median_range(std::span<const ScanNumbers> scans) {
  std::vector<double> ranges;
  for (const ScanNumbers& scan : scans) {
    if (scan.median_range) ranges.push_back(*scan.median_range);
  }
  return ranges.empty() ? 0 : median_of(std::move(ranges));
}

double recognize_length_unit(std::span<const ScanNumbers> scans, std::optional<double> stated,
                             Notes& notes) {
  // Median ranges of drives in m and in mm; what lies between may be cm, or mm in a small room.
  constexpr double kMost = 300, kLeastInMillimeters = 3000;
  constexpr double kNearest = 0.05, kFarthest = 1000;  // m, of a right unit
  constexpr const char* kKey = "lidar.length_unit";
  constexpr const char* kRemedy = "state \"m\", \"cm\" or \"mm\", in the frame of the LiDAR";
  const double range = median_range(scans);
  if (range == 0) return stated.value_or(1);
  if (stated) {
    const double meters = range * *stated;
    if (meters >= kNearest && meters <= kFarthest) return *stated;
    throw ConfigError(fmt::format("half of the points are over {:.4g} m away by this unit", meters),
                      kKey, kRemedy);
  }
  const bool whole = scans.front().whole_coordinates;
  if (range <= kMost && !whole) return 1;
  if (range < kLeastInMillimeters || range > 1000 * kMost) {
    throw ConfigError(
        fmt::format("half of the points have coordinates over {:.4g}, which fit neither m nor mm",
                    range),
        kKey, kRemedy);
  }
  notes.push_back(
      {fmt::format("recognized: coordinates are in mm, since half of the points lie over {:.4g} "
                   "units away",
                   range),
       "length_unit"});
  return 1e-3;
}

double recognize_intensity_max(std::span<const ScanNumbers> scans, std::optional<double> stated,
                               Notes& notes) {
  IntensityScale scale;
  std::size_t beyond = 0;
  for (const ScanNumbers& scan : scans) {
    scale.add(scan.scale);
    if (stated && scan.median_intensity > *stated) ++beyond;
  }
  if (stated) {
    if (2 * beyond <= scans.size()) return *stated;
    throw ConfigError(fmt::format("most intensities exceed {}", *stated), "lidar.intensity_max",
                      fmt::format("state {}, or leave the key out", scale.max()));
  }
  if (scale.max() > 1) {
    notes.push_back({fmt::format("intensities exceed 1; assumed: {} stands for a reflectance of 1",
                                 scale.max()),
                     "intensity_max"});
  }
  return scale.max();
}

/// Notes the columns of unusual names, and those that may have been meant.
void note_columns(const ScanNumbers& scan, Notes& notes) {
  constexpr std::array kUsual = {"channel", "t", "timestamp", "offset_time"};
  std::vector<std::string> renamed, missing, others;
  std::set<std::string> read;
  for (std::size_t column = 0; column < kScanColumns.size(); ++column) {
    const std::string_view wanted = kScanColumns[column];
    const auto place = find_column(scan.columns, wanted);
    if (!place && column != kScanRing) missing.emplace_back(wanted);
    if (!place) continue;
    const std::string& name = scan.columns[*place];
    read.insert(name);
    if (name == wanted || std::find(kUsual.begin(), kUsual.end(), name) != kUsual.end()) continue;
    renamed.push_back(fmt::format("{} as {}", name, wanted));
  }
  std::copy_if(scan.columns.begin(), scan.columns.end(), std::back_inserter(others),
               [&](const std::string& name) { return !read.contains(name) && name != "_"; });
  if (!renamed.empty()) {
    notes.push_back({fmt::format("recognized: columns of the scans are read under other names: {}",
                                 list_columns(renamed)),
                     ""});
  }
  if (!missing.empty() && !others.empty()) {
    notes.push_back({fmt::format("no column of the scans is known as {}; not read: {}",
                                 fmt::join(missing, " or "), list_columns(others)),
                     ""});
  }
}

}  // namespace

RecognizedFormat recognize_format(std::span<const ScanNumbers> scans,
                                  const StatedScanFormat& stated) {
  RecognizedFormat result;
  ScanFormat& format = result.format;
  if (!scans.empty()) note_columns(scans.front(), result.notes);
  format.length_unit = recognize_length_unit(scans, stated.length_unit, result.notes);
  format.intensity_max = recognize_intensity_max(scans, stated.intensity_max, result.notes);
  PointTimes times = recognize_point_times(scans, stated);
  format.time_reference = times.reference;
  format.time_unit = times.unit;
  if (!times.note.empty()) {
    result.notes.push_back({std::move(times.note), "time_unit, time_reference"});
  }
  return result;
}

ScanFormat recognize_format_of_drive(std::span<const ScanNumbers> scans,
                                     const StatedScanFormat& stated,
                                     const std::filesystem::path& toml, const std::string& table,
                                     std::vector<std::string>& notes) {
  // recognize_format() names keys of [lidar].
  const auto key_of_table = [&](const std::string& key) {
    constexpr std::string_view kTable = "lidar";
    return key.starts_with(kTable) ? table + key.substr(kTable.size()) : key;
  };
  try {
    const RecognizedFormat recognized = recognize_format(scans, stated);
    for (const auto& [what, keys] : recognized.notes) {
      notes.push_back(keys.empty()
                          ? what
                          : fmt::format("{}; to change: [{}] {} in drive.toml", what, table, keys));
    }
    return recognized.format;
  } catch (const ConfigError& error) {
    throw ConfigError(error.problem(),
                      fmt::format("{}: {}", toml.string(), key_of_table(error.where())),
                      error.remedy());
  }
}

}  // namespace fovea
