// Tables of numbers as text, one line a moment: stamps, poses, positions.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "fovea/base/time.h"

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

  std::vector<TimeNs> times;   ///< column time_ns
  std::vector<double> values;  ///< by rows, in the order asked for; NaN where a cell is empty
  std::vector<int> lines;      ///< of the rows, from 1
  std::vector<bool> has;       ///< which of the columns asked for the file has
  std::vector<int> malformed;  ///< lines that are no row, from 1

  /// Takes out the fewest rows that leave strictly increasing times. Returns how many.
  std::size_t drop_out_of_order();

 private:
  std::size_t columns_;
};

/// Reads a file of comma-separated values. The first line that is neither blank nor begins with '#'
/// names the columns, of which one is time_ns: whole nanoseconds, 0 to 2^62 (the year 2116). Other
/// columns than those asked for are passed over. InputError with file and line if there is no such
/// line, or it lacks a column that is required or has one twice, or the file cannot be read.
/// @param columns  besides time_ns
CsvRows read_csv(const std::filesystem::path& file, std::span<const CsvColumn> columns);

}  // namespace fovea
