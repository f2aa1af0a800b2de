#include "fovea/sensor/csv_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "fovea/base/errors.h"
#include "fovea/sensor/read_file.h"
#include "fovea/sensor/time_stamps.h"

namespace fovea {
namespace {

constexpr TimeNs kLatest = TimeNs{1} << 62;  // so that no difference of two times overflows
constexpr const char* kTime = "time_ns";

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    std::string_view cell = line.substr(0, comma);
    constexpr std::string_view kBlanks = " \t";
    cell.remove_prefix(std::min(cell.find_first_not_of(kBlanks), cell.size()));
    cell = cell.substr(0, cell.find_last_not_of(kBlanks) + 1);
    cells.push_back(cell);
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

bool is_comment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first == std::string_view::npos || line[first] == '#';
}

/// Empty unless all of the cell is a number.
template <class T>
std::optional<T> parse(std::string_view cell) {
  T value{};
  const char* end = cell.data() + cell.size();
  const auto [rest, error] = std::from_chars(cell.data(), end, value);
  if (cell.empty() || error != std::errc() || rest != end) return std::nullopt;
  return value;
}

/// Where in a line the columns are.
struct Layout {
  std::size_t cells = 0, time = 0;
  std::vector<std::optional<std::size_t>> columns;
};

Layout read_header(std::string_view line, std::span<const CsvColumn> columns,
                   const std::string& where) {
  const std::vector<std::string_view> names = cells_of(line);
  const auto find = [&](std::string_view name, bool required) -> std::optional<std::size_t> {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      if (!required) return std::nullopt;
      throw InputError(fmt::format("the table has no column {}", name), where,
                       "name the columns in its first line (docs/drives.md)");
    }
    if (std::find(found + 1, names.end(), name) != names.end()) {
      throw InputError(fmt::format("the table has the column {} twice", name), where,
                       "keep one of them");
    }
    return static_cast<std::size_t>(found - names.begin());
  };
  Layout layout;
  layout.cells = names.size();
  layout.time = *find(kTime, true);
  for (const CsvColumn& column : columns) {
    layout.columns.push_back(find(column.name, column.required));
  }
  return layout;
}

/// Adds a row; false if the line is none.
bool add_row(std::string_view line, const Layout& layout, CsvRows& rows) {
  const std::vector<std::string_view> cells = cells_of(line);
  if (cells.size() != layout.cells) return false;
  const auto time = parse<TimeNs>(cells[layout.time]);
  if (!time || *time < 0 || *time >= kLatest) return false;
  std::vector<double> values;
  for (const std::optional<std::size_t>& column : layout.columns) {
    values.push_back(std::numeric_limits<double>::quiet_NaN());
    if (!column || cells[*column].empty()) continue;
    const auto value = parse<double>(cells[*column]);
    if (!value) return false;
    values.back() = *value;
  }
  rows.times.push_back(*time);
  rows.values.insert(rows.values.end(), values.begin(), values.end());
  return true;
}

}  // namespace

std::size_t CsvRows::drop_out_of_order() {
  TimeStamps stamps;
  stamps.times.assign(times.begin(), times.end());
  remove_out_of_order(stamps);
  std::size_t kept = 0;
  for (std::size_t row = 0; row < times.size(); ++row) {
    if (!stamps.times[row]) continue;
    times[kept] = times[row];
    lines[kept] = lines[row];
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row * columns_), columns_,
                values.begin() + static_cast<std::ptrdiff_t>(kept * columns_));
    ++kept;
  }
  times.resize(kept);
  lines.resize(kept);
  values.resize(kept * columns_);
  return stamps.out_of_order.size();
}

CsvRows read_csv(const std::filesystem::path& file, std::span<const CsvColumn> columns) {
  CsvRows rows(columns.size());
  std::optional<Layout> layout;
  int number = 0;
  for (const std::string& line : read_lines(file)) {
    ++number;
    if (is_comment(line)) continue;
    if (!layout) {
      layout = read_header(line, columns, fmt::format("{}:{}", file.string(), number));
      for (std::size_t i = 0; i < columns.size(); ++i) rows.has[i] = layout->columns[i].has_value();
    } else if (add_row(line, *layout, rows)) {
      rows.lines.push_back(number);
    } else {
      rows.malformed.push_back(number);
    }
  }
  if (!layout) {
    throw InputError("the table is empty", file.string(),
                     "name the columns in its first line (docs/drives.md)");
  }
  return rows;
}

}  // namespace fovea
