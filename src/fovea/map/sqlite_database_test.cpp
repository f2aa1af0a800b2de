#include "fovea/map/sqlite_database.h"

#include <gtest/gtest.h>

#include "../../../tests/temporary_folder.h"

namespace fovea::sqlite_database_test {

TEST(Statement, EmptyValuesAreNotNull) {
  const TemporaryFolder folder;
  sqlite::Database database(folder / "a.db", sqlite::Access::kCreate, folder / "a.db");
  database.execute("CREATE TABLE t(words TEXT NOT NULL, bytes BLOB NOT NULL)");
  sqlite::Statement insert(database, "INSERT INTO t VALUES(?1, ?2)");
  insert.bind(1, std::string_view());
  insert.bind(2, std::span<const std::byte>());
  EXPECT_NO_THROW(insert.run());
  sqlite::Statement count(
      database, "SELECT count(*) FROM t WHERE typeof(bytes)='blob' AND typeof(words)='text'");
  ASSERT_TRUE(count.step());
  EXPECT_EQ(count.integer(0), 1);
}

}  // namespace fovea::sqlite_database_test
