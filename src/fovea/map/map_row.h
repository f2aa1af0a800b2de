// A row of a map file as values, with its checksum (docs/map-format.md). Private to map/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fovea/core/sqlite_database.h"
#include "fovea/map/map_schema.h"
#include "fovea/map/value_hash.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// NULL, integer, real, text or blob. The memory of a blob belongs to another object.
using Cell =
    std::variant<std::monostate, std::int64_t, double, std::string, std::span<const std::byte>>;
/// The values of a table's columns in order, without the checksum.
using Row = std::vector<Cell>;

/// A cell of a number. Adding zero turns -0, which SQLite cannot keep, into 0.
inline Cell cell(double number) { return number + 0.0; }
inline Cell cell(std::int64_t number) { return number; }
inline Cell cell(std::string text) { return text; }
/// NULL without a value.
template <class Value>
Cell cell(const std::optional<Value>& value) {
  return value ? cell(*value) : Cell();
}

void add_cell(const Cell& cell, ValueHash& hash);
/// XXH3, 64 bits, of the table's name and the row's values.
std::uint64_t row_checksum(const Table& table, const Row& row);

/// Binds a row and its checksum to a statement of insert_sql() and runs it.
void insert_row(sqlite::Statement& statement, const Row& row, std::uint64_t checksum);

/// A row of a statement of select_sql(). Blobs are valid until its next step.
struct StoredRow {
  Row row;
  std::optional<std::uint64_t> checksum;  ///< absent where it is no integer
};
StoredRow stored_row(const sqlite::Statement& statement, const Table& table);

/// Names a row in an error: "MAP, table 'frames', frame 8".
std::string row_name(const Table& table, const Row& row, const std::string& map_path);

/// InputError if the checksum of a row is wrong.
void require_whole(const Table& table, const StoredRow& stored, const std::string& map_path);

/// Reads the values of a row in order. InputError that names row and column if a value has another
/// type or cannot be read.
class RowCursor {
 public:
  RowCursor(const Table& table, const Row& row, std::string map_path)
      : table_(table), row_(row), map_path_(std::move(map_path)) {}

  std::int64_t integer();
  double real();  ///< finite
  std::string text();
  std::span<const std::byte> blob();
  int index(int least = 0);       ///< an integer of at least `least` that an int can hold
  RigidMotion pose();             ///< from text; fail() without a rotation, or far off any drive
  std::vector<double> numbers();  ///< from text

  /// Whether the next value is NULL, which is then skipped.
  bool skip_null();
  /// InputError that names the latest column.
  [[noreturn]] void fail() const;
  /// The value of an optional; fail() without one.
  template <class Value>
  Value require(std::optional<Value> value) const {
    if (!value) fail();
    return std::move(*value);
  }

 private:
  const Cell& next();

  const Table& table_;
  const Row& row_;
  std::string map_path_;
  std::size_t read_ = 0;
};

}  // namespace fovea
