#include "fovea/core/sqlite_database.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>
#include <new>
#include <string>

#include "../../../tests/file_content.h"
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

/// A file whose only row states a length of 2^32 - 1 bytes. SQLite then computes that the row has
/// no overflow pages, allocates 0 bytes for their numbers and reports SQLITE_NOMEM.
void write_row_of_impossible_length(const std::filesystem::path& file) {
  {
    sqlite::Database database(file, sqlite::Access::kCreate, file);
    database.execute("PRAGMA page_size=512; CREATE TABLE t(a BLOB NOT NULL)");
    database.execute("INSERT INTO t VALUES('aaaaaaaaaa' || zeroblob(5000))");
  }
  std::string bytes = content(file);
  const std::size_t at = bytes.find("aaaaaaaaaa");
  ASSERT_NE(at, std::string::npos);
  // In front of the text: length (2 bytes), row id, size of the header, type (2 bytes). The longer
  // length makes the first 'a' the size of the header: 97 bytes, more than the first page has.
  constexpr std::string_view kLength("\x8f\xff\xff\xff\x7f", 5);
  bytes.replace(at - 6, kLength.size(), kLength);
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST(Database, AnImpossibleLengthIsDamageAndNoLackOfMemory) {
  const TemporaryFolder folder;
  write_row_of_impossible_length(folder / "a.db");
  for (const sqlite::Access access : {sqlite::Access::kRead, sqlite::Access::kWrite}) {
    sqlite::Database database(folder / "a.db", access, folder / "a.db");
    sqlite::Statement row(database, "SELECT a FROM t");
    try {
      row.step();
      FAIL() << "the row was read";
    } catch (const sqlite::CorruptFile& error) {
      EXPECT_EQ(access, sqlite::Access::kRead);
      EXPECT_EQ(error.problem(), "the map is damaged (the length of a row is impossible)");
    } catch (const OutputError& error) {
      EXPECT_EQ(access, sqlite::Access::kWrite);
      EXPECT_EQ(error.problem(), "the map is damaged (the length of a row is impossible)");
    }
  }
}

TEST(Database, LackOfMemoryIsNoDamage) {
  const TemporaryFolder folder;
  sqlite::Database database(folder / "a.db", sqlite::Access::kCreate, folder / "a.db");
  database.execute("CREATE TABLE t(a BLOB NOT NULL); INSERT INTO t VALUES(zeroblob(20000000))");
  sqlite::Statement row(database, "SELECT a || 'a' FROM t");
  sqlite3_hard_heap_limit64(sqlite3_memory_used() + 10'000'000);
  EXPECT_THROW(row.step(), std::bad_alloc);
  sqlite3_hard_heap_limit64(0);
}

}  // namespace fovea::sqlite_database_test
