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

}  // namespace fovea
