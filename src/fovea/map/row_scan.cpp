#include "fovea/map/row_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "fovea/errors.h"
#include "fovea/map/map_store.h"
#include "fovea/map/meta_keys.h"

namespace fovea {
namespace {

using sqlite::Statement;

/// If the last page of a table cannot be read, a gap of more numbers than this counts as its end.
constexpr std::int64_t kLongestGap = 4096;

/// Runs a query to its end, or to a page that cannot be read.
/// @return whether it came to the end
template <class F>
bool read_rows(Statement& rows, F&& row) {
  bool is_at_end = false;
  try {
    while (rows.step()) row(rows);
    is_at_end = true;
  } catch (const sqlite::CorruptFile&) {
    // The caller reads around the page.
  }
  rows.reset();
  return is_at_end;
}

/// Rows with whole numbers: from both ends, then those between damaged pages by trying numbers.
class NumberedScan {
 public:
  static constexpr const char* kRowId = "rowid";

  NumberedScan(sqlite::Database& database, const Table& table, std::string select,
               const char* number)
      : name_(table.columns[0].name), number_column_(static_cast<int>(table.column_count()) + 1) {
    // Only the key of one whole number is the number of the row.
    if (number == kRowId && std::string_view(table.key) != name_) name_ = "row";
    select.insert(select.rfind(" FROM "), fmt::format(", {}", number));
    const std::string between = fmt::format(
        "{0} NOT INDEXED WHERE {1} >= ?1 AND {1} < ?2 ORDER BY "
        "{1}",
        select, number);
    forward_.emplace(database, between);
    backward_.emplace(database, between + " DESC");
  }

  void run(const std::function<void(const Statement&)>& row,
           const std::function<void(const std::string&)>& damage) {
    constexpr auto kLeast = std::numeric_limits<std::int64_t>::min(),
                   kMost = std::numeric_limits<std::int64_t>::max();
    std::optional<std::int64_t> last, first_at_end;
    if (read(*forward_, kLeast, kMost, last, row)) return;
    read(*backward_, last ? *last + 1 : kLeast, kMost, first_at_end, row);
    const std::int64_t begin = last ? *last + 1 : 0;
    const std::int64_t end = first_at_end.value_or(begin + kLongestGap);
    std::int64_t gap = begin;
    for (std::int64_t next = begin + 1; next < end; ++next) {
      std::optional<std::int64_t> first, latest;
      read(*forward_, next, end, latest, [&](const Statement& found) {
        if (!first) first = found.integer(number_column_);
        row(found);
      });
      if (!first) continue;
      damage(describe(gap, *first));
      gap = std::max(next, *latest) + 1;
      next = gap;
    }
    if (gap < end) damage(describe(gap, first_at_end));
  }

 private:
  /// Reads the rows of [begin, end) until one cannot be read.
  /// @param last  becomes the number of the last row that was read
  /// @return whether all could be read
  template <class F>
  bool read(Statement& rows, std::int64_t begin, std::int64_t end,
            std::optional<std::int64_t>& last, F&& row) {
    rows.bind(1, begin);
    rows.bind(2, end);
    return read_rows(rows, [&](const Statement& found) {
      last = found.integer(number_column_);
      row(found);
    });
  }
  std::string describe(std::int64_t begin, std::optional<std::int64_t> end) const {
    const std::string to = end ? fmt::format("to {}", *end - 1) : "on";
    return fmt::format("rows from {} {} {} cannot be read", name_, begin, to);
  }

  std::string name_;
  int number_column_;
  std::optional<Statement> forward_, backward_;
};

/// The keys that a row of `meta` or `counts` may have.
std::vector<std::string> known_keys(const Table& table) {
  std::vector<std::string> keys;
  if (&table == &kCountsTable) {
    for (const Table* counted : kTables) keys.emplace_back(counted->name);
    return keys;
  }
  for (const std::string_view key : meta_key::kAll) keys.emplace_back(key);
  constexpr int kMostCameras = 100;
  for (int camera = 0; camera < kMostCameras; ++camera) {
    for (const char* ending :
         {meta_key::kRotationEnding, meta_key::kTranslationEnding, meta_key::kDelayEnding}) {
      keys.push_back(fmt::format("{}{}{}", meta_key::kCalibrationPrefix, camera, ending));
    }
  }
  constexpr int kMostDrives = 100, kCamerasOfDrive = 10;
  for (int number = 0; number < kMostDrives * kCamerasOfDrive; ++number) {
    keys.push_back(fmt::format("{}{}.{}", meta_key::kCameraModelPrefix, number / kCamerasOfDrive,
                               number % kCamerasOfDrive));
  }
  return keys;
}

void scan_by_text(sqlite::Database& database, const Table& table, const std::string& select,
                  const std::function<void(const Statement&)>& row,
                  const std::function<void(const std::string&)>& damage) {
  const char* key = table.columns[0].name;
  Statement forward(database, fmt::format("{} ORDER BY {}", select, key));
  if (read_rows(forward, row)) return;
  damage("rows cannot be read");
  Statement backward(database, fmt::format("{} ORDER BY {} DESC", select, key));
  read_rows(backward, row);
  Statement single(database, fmt::format("{} WHERE {} = ?1", select, key));
  for (const std::string& known : known_keys(table)) {
    single.bind(1, std::string_view(known));
    read_rows(single, row);
  }
}

}  // namespace

RowLimit::RowLimit(const std::filesystem::path& map, const Table& table)
    : map_(map.string()), table_(table) {
  // A row is read twice at most: from either end of the table.
  constexpr std::uintmax_t kLeastRow = 16;  // bytes
  std::error_code ignored;
  left_ = 2 * (std::filesystem::file_size(map, ignored) / kLeastRow);
}

void RowLimit::count() {
  if (left_-- > 0) return;
  throw InputError("more rows than the file can hold: its pages refer to each other",
                   fmt::format("{}, table '{}'", map_, table_.name), kRestoreMap);
}

void scan_rows(sqlite::Database& database, const Table& table, const std::string& select,
               const std::function<void(const Statement&)>& row,
               const std::function<void(const std::string&)>& damage) {
  if (!table.has_rowid && &table != &kViewsTable) {
    return scan_by_text(database, table, select, row, damage);
  }
  const char* number = table.has_rowid ? NumberedScan::kRowId : "frame";
  NumberedScan(database, table, select, number).run(row, damage);
}

}  // namespace fovea
