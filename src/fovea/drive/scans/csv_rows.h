// Tables of numbers as text, one line a moment: stamps, poses, positions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "fovea/time.h"

namespace fovea {

struct CsvColumn {
  const char* name;
  bool required = true;
};

/// The lines of a file that could be read.
class CsvRows {
 public:
  /// @param columns  which the values of a row are
  explicit CsvRows(std::size_t columns) : has(columns), columns_(columns) {}

  std::size_t size() const { return times.size(); }
  double at(std::size_t row, std::size_t column) const { return values[row * columns_ + column]; }

  /// Ns, of each row. Without a stated unit the times in the file count as nanoseconds until
  /// set_time_unit() says otherwise.
  std::vector<TimeNs> times;
  std::vector<double> values;  ///< by rows, in the order asked for; NaN where a cell is empty
  std::vector<int> lines;      ///< of the rows, from 1
  std::vector<bool> has;       ///< which of the columns asked for the file has
  std::vector<int> malformed;  ///< lines that are no row, from 1

  /// The unit that the name of the column of times states (time_us, time_ms, time_s), ns. Absent
  /// for time_ns, which is also the name in files that have another unit.
  std::optional<TimeNs> stated_unit;
  /// Whether most times have a fraction: they are no nanoseconds.
  bool has_fractions() const;
  /// First and last time and median step between times, in the unit of the file.
  struct RawTimes {
    double first = 0, last = 0, step = 0;
  };
  /// Empty without rows; the step is 0 of a single time.
  std::optional<RawTimes> raw_times() const;
  /// Reads the times again in another unit. Rows whose time is none in this unit become malformed.
  /// @param unit  ns
  void set_time_unit(TimeNs unit);

  /// Takes out the fewest rows that leave strictly increasing times. Returns how many.
  std::size_t drop_out_of_order();

  /// A time as the file has it.
  struct FileTime {
    std::int64_t whole = 0;
    std::int32_t billionths = 0;
  };
  std::vector<FileTime> file_times;

 private:
  /// Keeps the rows that are marked.
  void keep(const std::vector<bool>& marks);

  std::size_t columns_;
};

/// Reads a file of comma-separated values. The first line that is neither blank nor begins with '#'
/// names the columns, in any case. One is time_ns: whole nanoseconds, 0 to 2^62 (the year 2116); or
/// time_us, time_ms, time_s, or time, timestamp or stamp, with decimals where there are any. Other
/// columns than those asked for are passed over. InputError with file and line if there is no such
/// line, or it lacks a column that is required or has one twice, or the file cannot be read.
/// @param columns  besides the time
CsvRows read_csv(const std::filesystem::path& file, std::span<const CsvColumn> columns);

}  // namespace fovea
