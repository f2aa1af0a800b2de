// Recognizes the unit of times in tables. The column "time_ns" may hold other units.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/drive/scans/csv_rows.h"
#include "fovea/drive/time_stamps.h"
#include "fovea/time.h"

namespace fovea {

/// From the first to the last scan of a drive.
struct ScanPeriod {
  TimeNs first = 0, last = 0;
};

/// Sets the unit of the stamps of scans by their steps, since a LiDAR takes 5 ms to 5 s from scan
/// to scan; notes a unit that the file does not state. InputError if the steps fit no unit, or not
/// the stated one.
void set_scan_time_unit(CsvRows& rows, const std::filesystem::path& file,
                        std::vector<std::string>& notes);

/// Sets the unit of another table by the scans: the unit by which both cover the same time. Leaves
/// nanoseconds where no unit fits.
void set_time_unit_by_scans(CsvRows& rows, const ScanPeriod& scans,
                            const std::filesystem::path& file, std::vector<std::string>& notes);

/// From the first to the last stamp; empty if there is none.
std::optional<ScanPeriod> period_of(const TimeStamps& stamps);

/// read_csv(), with the unit by the scans where their time is known.
CsvRows read_timed_csv(const std::filesystem::path& file, std::span<const CsvColumn> columns,
                       const std::optional<ScanPeriod>& scans, std::vector<std::string>& notes);

}  // namespace fovea
