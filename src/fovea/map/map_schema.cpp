#include "fovea/map/map_schema.h"

#include <fmt/format.h>

namespace fovea {

std::string create_sql(const Table& table) {
  std::string sql = fmt::format("CREATE TABLE {}(\n", table.name);
  for (const Column& column : table.columns) {
    sql += fmt::format("  {} {},\n", column.name, column.type);
  }
  return sql + fmt::format("  checksum INTEGER NOT NULL,\n  PRIMARY KEY({})){};\n", table.key,
                           table.has_rowid ? "" : " WITHOUT ROWID");
}

std::string select_sql(const Table& table) {
  std::string sql = "SELECT ";
  for (const Column& column : table.columns) sql += fmt::format("{}, ", column.name);
  return sql + fmt::format("checksum FROM {}", table.name);
}

std::string insert_sql(const Table& table) {
  std::string sql = fmt::format("INSERT OR REPLACE INTO {} VALUES(", table.name);
  for (std::size_t i = 1; i <= table.column_count(); ++i) sql += fmt::format("?{}, ", i);
  return sql + fmt::format("?{})", table.column_count() + 1);
}

}  // namespace fovea
