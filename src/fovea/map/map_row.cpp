#include "fovea/map/map_row.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "fovea/errors.h"
#include "fovea/geometry/position_limit.h"
#include "fovea/map/map_store.h"
#include "fovea/map/number_text.h"

namespace fovea {
namespace {

/// Calls the function of the list that takes the cell's type.
template <class... Functions>
struct Visitor : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Visitor(Functions...) -> Visitor<Functions...>;

Cell stored_cell(const sqlite::Statement& statement, int column) {
  switch (statement.type(column)) {
    case sqlite::ValueType::kNull:
      return {};
    case sqlite::ValueType::kInteger:
      return statement.integer(column);
    case sqlite::ValueType::kReal:
      return statement.real(column);
    case sqlite::ValueType::kText:
      return std::string(statement.text(column));
    case sqlite::ValueType::kBlob:
      return statement.blob(column);
  }
  return {};
}

}  // namespace

void add_cell(const Cell& cell, ValueHash& hash) {
  std::visit(
      Visitor{[&](std::monostate) { hash.null(); }, [&](const auto& value) { hash.value(value); },
              [&](const std::string& text) { hash.value(std::string_view(text)); }},
      cell);
}

std::uint64_t row_checksum(const Table& table, const Row& row) {
  ValueHash hash;
  hash.section(table.name);
  for (const Cell& cell : row) add_cell(cell, hash);
  return hash.hash64();
}

void insert_row(sqlite::Statement& statement, const Row& row, std::uint64_t checksum) {
  int parameter = 0;
  for (const Cell& cell : row) {
    ++parameter;
    std::visit(Visitor{[&](std::monostate) { statement.bind_null(parameter); },
                       [&](const auto& value) { statement.bind(parameter, value); },
                       [&](const std::string& text) {
                         statement.bind(parameter, std::string_view(text));
                       }},
               cell);
  }
  statement.bind(parameter + 1, static_cast<std::int64_t>(checksum));
  statement.run();
}

StoredRow stored_row(const sqlite::Statement& statement, const Table& table) {
  StoredRow stored;
  stored.row.reserve(table.column_count());
  const auto count = static_cast<int>(table.column_count());
  for (int i = 0; i < count; ++i) stored.row.push_back(stored_cell(statement, i));
  const Cell checksum = stored_cell(statement, count);
  if (const auto* number = std::get_if<std::int64_t>(&checksum)) {
    stored.checksum = static_cast<std::uint64_t>(*number);
  }
  return stored;
}

std::string row_name(const Table& table, const Row& row, const std::string& map_path) {
  std::string name = fmt::format("{}, table '{}'", map_path, table.name);
  const std::string_view key = table.key;
  const auto key_columns = std::size_t(1 + std::count(key.begin(), key.end(), ','));
  for (std::size_t i = 0; i < key_columns && i < row.size(); ++i) {
    std::visit(Visitor{[&](const auto&) { name += fmt::format(", {} ?", table.columns[i].name); },
                       [&](std::int64_t number) {
                         name += fmt::format(", {} {}", table.columns[i].name, number);
                       },
                       [&](const std::string& text) {
                         name += fmt::format(", {} '{}'", table.columns[i].name, text);
                       }},
               row[i]);
  }
  return name;
}

void require_whole(const Table& table, const StoredRow& stored, const std::string& map_path) {
  if (stored.checksum == row_checksum(table, stored.row)) return;
  throw InputError("the checksum of a row is wrong", row_name(table, stored.row, map_path),
                   kRestoreMap);
}

const Cell& RowCursor::next() { return row_.at(read_++); }

void RowCursor::fail() const {
  const char* column = read_ > 0 ? table_.columns[read_ - 1].name : "";
  throw InputError(
      fmt::format("the column '{}' of the table '{}' cannot be read", column, table_.name),
      row_name(table_, row_, map_path_), kRestoreMap);
}

std::int64_t RowCursor::integer() {
  const auto* number = std::get_if<std::int64_t>(&next());
  if (number == nullptr) fail();
  return *number;
}

double RowCursor::real() {
  const auto* number = std::get_if<double>(&next());
  if (number == nullptr || !std::isfinite(*number)) fail();
  return *number;
}

std::string RowCursor::text() {
  const auto* text = std::get_if<std::string>(&next());
  if (text == nullptr) fail();
  return *text;
}

std::span<const std::byte> RowCursor::blob() {
  const auto* blob = std::get_if<std::span<const std::byte>>(&next());
  if (blob == nullptr) fail();
  return *blob;
}

int RowCursor::index(int least) {
  const std::int64_t number = integer();
  if (number < least || !std::in_range<int>(number)) fail();
  return static_cast<int>(number);
}

RigidMotion RowCursor::pose() {
  constexpr double kRotationTolerance = 1e-3;
  const std::string text = this->text();
  const RigidMotion pose = require(motion_from_text(text));
  if (!is_possible_position(pose.translation())) fail();
  if (!is_rotation(pose.linear(), kRotationTolerance)) fail();
  return pose;
}

std::vector<double> RowCursor::numbers() {
  const std::string text = this->text();
  return require(numbers_from_text(text));
}

bool RowCursor::skip_null() {
  if (!std::holds_alternative<std::monostate>(row_.at(read_))) return false;
  ++read_;
  return true;
}

}  // namespace fovea
