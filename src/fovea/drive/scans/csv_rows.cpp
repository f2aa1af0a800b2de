#include "fovea/drive/scans/csv_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "fovea/core/median.h"
#include "fovea/core/point_formats/column_names.h"
#include "fovea/core/read_file.h"
#include "fovea/drive/time_stamps.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr TimeNs kLatest = TimeNs{1} << 62;  // so that no difference of two times overflows

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

/// The unit in the name of a column of times, ns; 0 if it states none, empty if it is no such name.
std::optional<TimeNs> unit_in_name(std::string_view name) {
  struct Unit {
    std::string_view name;
    TimeNs unit;
  };
  constexpr std::array<Unit, 9> kUnits = {{{"", 0},
                                           {"ns", 1},
                                           {"nsec", 1},
                                           {"us", 1'000},
                                           {"usec", 1'000},
                                           {"ms", 1'000'000},
                                           {"msec", 1'000'000},
                                           {"s", kNsPerSecond},
                                           {"sec", kNsPerSecond}}};
  for (const std::string_view base : {"timestamp", "time", "stamp"}) {
    if (!name.starts_with(base)) continue;
    for (const Unit& unit : kUnits) {
      if (name.substr(base.size()) == unit.name) return unit.unit;
    }
  }
  return std::nullopt;
}

/// The first column of times, time_ns if there is one.
std::size_t find_time(const std::vector<std::string>& names, const std::string& where) {
  const auto exact = std::find(names.begin(), names.end(), plain_column_name("time_ns"));
  const auto found = exact != names.end()
                         ? exact
                         : std::find_if(names.begin(), names.end(), [](const std::string& name) {
                             return unit_in_name(name).has_value();
                           });
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  throw InputError("the table has no column time_ns", where,
                   "name the columns in its first line (docs/drives.md)");
}

Layout read_header(std::string_view line, std::span<const CsvColumn> columns,
                   const std::string& where, CsvRows& rows) {
  std::vector<std::string> names;
  for (const std::string_view cell : cells_of(line)) names.push_back(plain_column_name(cell));
  const auto find = [&](const char* name, bool required) -> std::optional<std::size_t> {
    const auto found = std::find(names.begin(), names.end(), plain_column_name(name));
    if (found == names.end()) {
      if (!required) return std::nullopt;
      throw InputError(fmt::format("the table has no column {}", name), where,
                       "name the columns in its first line (docs/drives.md)");
    }
    if (std::find(found + 1, names.end(), *found) != names.end()) {
      throw InputError(fmt::format("the table has the column {} twice", name), where,
                       "keep one of them");
    }
    return static_cast<std::size_t>(found - names.begin());
  };
  Layout layout;
  layout.cells = names.size();
  layout.time = find_time(names, where);
  if (const TimeNs unit = *unit_in_name(names[layout.time]); unit > 1) rows.stated_unit = unit;
  for (const CsvColumn& column : columns) {
    layout.columns.push_back(find(column.name, column.required));
  }
  return layout;
}

/// "1700000000.25" or "1.7e18"; empty if that is no time.
std::optional<CsvRows::FileTime> parse_time(std::string_view cell) {
  constexpr double kBillion = 1e9;
  if (cell.find_first_of("eE") != std::string_view::npos) {
    const auto value = parse<double>(cell);
    if (!value || !(*value >= 0 && *value < double(kLatest))) return std::nullopt;
    const double whole = std::floor(*value);
    return CsvRows::FileTime{static_cast<std::int64_t>(whole),
                             static_cast<std::int32_t>((*value - whole) * kBillion)};
  }
  const std::size_t point = std::min(cell.find('.'), cell.size());
  const auto whole = parse<TimeNs>(cell.substr(0, point));
  if (!whole || *whole < 0 || *whole >= kLatest) return std::nullopt;
  CsvRows::FileTime time{*whole, 0};
  if (point == cell.size()) return time;
  int unit = 1'000'000'000;
  for (const char c : cell.substr(point + 1)) {
    if (c < '0' || c > '9') return std::nullopt;
    unit /= 10;  // 0 beyond billionths
    time.billionths += unit * (c - '0');
  }
  return time;
}

/// Adds a row; false if the line is none.
bool add_row(std::string_view line, const Layout& layout, CsvRows& rows) {
  const std::vector<std::string_view> cells = cells_of(line);
  if (cells.size() != layout.cells) return false;
  const auto time = parse_time(cells[layout.time]);
  if (!time) return false;
  std::vector<double> values;
  for (const std::optional<std::size_t>& column : layout.columns) {
    values.push_back(std::numeric_limits<double>::quiet_NaN());
    if (!column || cells[*column].empty()) continue;
    const auto value = parse<double>(cells[*column]);
    if (!value) return false;
    values.back() = *value;
  }
  rows.file_times.push_back(*time);
  rows.times.push_back(time->whole);
  rows.values.insert(rows.values.end(), values.begin(), values.end());
  return true;
}

}  // namespace

std::size_t CsvRows::drop_out_of_order() {
  TimeStamps stamps;
  stamps.times.assign(times.begin(), times.end());
  remove_out_of_order(stamps);
  std::vector<bool> marks;
  for (const auto& time : stamps.times) marks.push_back(time.has_value());
  keep(marks);
  return stamps.out_of_order.size();
}

void CsvRows::keep(const std::vector<bool>& marks) {
  std::size_t kept = 0;
  for (std::size_t row = 0; row < times.size(); ++row) {
    if (!marks[row]) continue;
    times[kept] = times[row];
    file_times[kept] = file_times[row];
    lines[kept] = lines[row];
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row * columns_), columns_,
                values.begin() + static_cast<std::ptrdiff_t>(kept * columns_));
    ++kept;
  }
  times.resize(kept);
  file_times.resize(kept);
  lines.resize(kept);
  values.resize(kept * columns_);
}

bool CsvRows::has_fractions() const {
  const auto count = std::count_if(file_times.begin(), file_times.end(),
                                   [](const FileTime& time) { return time.billionths != 0; });
  return 2 * static_cast<std::size_t>(count) > file_times.size();
}

std::optional<CsvRows::RawTimes> CsvRows::raw_times() const {
  if (file_times.empty()) return std::nullopt;
  std::vector<FileTime> sorted = file_times;
  const auto key = [](const FileTime& time) { return std::pair(time.whole, time.billionths); };
  const auto value = [](const FileTime& time) {
    return double(time.whole) + 1e-9 * time.billionths;
  };
  std::sort(sorted.begin(), sorted.end(),
            [&](const FileTime& a, const FileTime& b) { return key(a) < key(b); });
  std::vector<double> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double step = double(sorted[i].whole - sorted[i - 1].whole) +
                        1e-9 * (sorted[i].billionths - sorted[i - 1].billionths);
    if (step > 0) steps.push_back(step);
  }
  return RawTimes{value(sorted.front()), value(sorted.back()), median_of(std::move(steps))};
}

void CsvRows::set_time_unit(TimeNs unit) {
  std::vector<bool> marks;
  for (std::size_t row = 0; row < size(); ++row) {
    const FileTime& time = file_times[row];
    const bool is_time = time.whole < kLatest / unit && (unit > 1 || time.billionths == 0);
    if (is_time)
      times[row] = time.whole * unit + std::llround(1e-9 * time.billionths * double(unit));
    if (!is_time) malformed.push_back(lines[row]);
    marks.push_back(is_time);
  }
  keep(marks);
  std::sort(malformed.begin(), malformed.end());
}

CsvRows read_csv(const std::filesystem::path& file, std::span<const CsvColumn> columns) {
  CsvRows rows(columns.size());
  std::optional<Layout> layout;
  int number = 0;
  for (const std::string& line : read_lines(file)) {
    ++number;
    if (is_comment(line)) continue;
    if (!layout) {
      layout = read_header(line, columns, fmt::format("{}:{}", file.string(), number), rows);
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
  if (rows.stated_unit || !rows.has_fractions()) rows.set_time_unit(rows.stated_unit.value_or(1));
  return rows;
}

}  // namespace fovea
