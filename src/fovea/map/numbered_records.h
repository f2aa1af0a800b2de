// Rows of a map whose numbers are 0, 1, 2, ...
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "fovea/errors.h"
#include "fovea/map/map_file.h"
#include "fovea/map/record_rows.h"

namespace fovea {

/// Records whose numbers are 0, 1, 2, ... If damage is reported, a missing one is reported and
/// becomes a default one; `missing` takes its number. Otherwise it is an InputError.
template <class Record, class Parse>
std::vector<Record> numbered_records(MapFile& file, const Table& table, Parse&& parse,
                                     std::set<std::size_t>& missing) {
  std::map<int, Record> records;
  file.for_each_row(table, [&](const Row& row) {
    const int id = RowCursor(table, row, file.where()).index();
    records.emplace(id, parse(RowCursor(table, row, file.where())));
  });
  std::vector<Record> in_order;
  for (auto& [id, record] : records) {
    // A forged number must not take memory.
    constexpr std::size_t kMostMissing = 1 << 16;
    const bool is_forged = std::size_t(id) > in_order.size() + kMostMissing;
    while (in_order.size() < std::size_t(id)) {
      missing.insert(in_order.size());
      file.read([&] {
        throw InputError(
            is_forged ? "all rows from here on are missing" : "a row is missing",
            fmt::format("{}, table '{}', id {}", file.where(), table.name, in_order.size()),
            kRestoreMap);
      });
      if (is_forged) return in_order;
      in_order.emplace_back();
    }
    in_order.push_back(std::move(record));
  }
  return in_order;
}
template <class Record, class Parse>
std::vector<Record> numbered_records(MapFile& file, const Table& table, Parse&& parse) {
  std::set<std::size_t> missing;
  return numbered_records<Record>(file, table, parse, missing);
}

}  // namespace fovea
