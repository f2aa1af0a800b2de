#include "fovea/drive/drive_stamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/drive/scans/csv_rows.h"
#include "fovea/drive/stamp_units.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

CsvRows read_rows(const fs::path& file) {
  constexpr std::array<CsvColumn, 1> kColumns = {{{"index"}}};
  return read_csv(file, kColumns);
}

/// Warns of lines without a usable number.
NumberedTimes numbered(const CsvRows& rows, const fs::path& file, Messages& messages) {
  std::vector<int> unusable = rows.malformed;
  NumberedTimes times;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const double index = rows.at(row, 0);
    const bool number = index >= 0 && index < kMaxFileNumber && index == std::floor(index);
    if (!number || !times.emplace(static_cast<int>(index), rows.times[row]).second) {
      unusable.push_back(rows.lines[row]);
    }
  }
  if (!unusable.empty()) {
    messages.warn(fmt::format("{} lines of {} are no stamps (the first: {})", unusable.size(),
                              file.string(), *std::min_element(unusable.begin(), unusable.end())));
  }
  return times;
}

}  // namespace

NumberedTimes read_scan_stamps(const fs::path& file, Messages& messages) {
  CsvRows rows = read_rows(file);
  set_scan_time_unit(rows, file, messages.notes);
  return numbered(rows, file, messages);
}

NumberedTimes read_image_stamps(const fs::path& file, const NumberedTimes& scans,
                                Messages& messages) {
  CsvRows rows = read_rows(file);
  set_time_unit_by_scans(rows, {scans.begin()->second, scans.rbegin()->second}, file,
                         messages.notes);
  return numbered(rows, file, messages);
}

std::map<int, double> read_image_exposures(const fs::path& file, Messages& messages) {
  constexpr std::array<CsvColumn, 3> kColumns = {
      {{"index"}, {"exposure_s", /*required=*/false}, {"gain_db", /*required=*/false}}};
  constexpr double kDecibelsPerStop = 6.0206;
  const CsvRows rows = read_csv(file, kColumns);
  std::map<int, double> exposures;
  if (!rows.has[1] && !rows.has[2]) return exposures;
  std::size_t unusable = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const double index = rows.at(row, 0);
    const double time = rows.has[1] ? rows.at(row, 1) : 1;
    const double gain = rows.has[2] ? rows.at(row, 2) : 0;
    const double exposure = std::log2(time) + gain / kDecibelsPerStop;
    const bool is_index = index >= 0 && index < kMaxFileNumber && index == std::floor(index);
    if (is_index && std::isfinite(exposure)) {
      exposures.emplace(static_cast<int>(index), exposure);
    } else {
      ++unusable;
    }
  }
  if (unusable > 0) {
    messages.warn(fmt::format("{} lines of {} state no exposure", unusable, file.string()));
  }
  return exposures;
}

}  // namespace fovea
