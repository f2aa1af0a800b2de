// SQLite with the library's errors. Private: no public header includes it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/errors.h"

struct sqlite3;
struct sqlite3_stmt;

namespace fovea::sqlite {

enum class Access {
  kRead,           ///< failures are InputError
  kReadImmutable,  ///< no locks, no side files: for folders where SQLite can make none
  kWrite,          ///< an existing file; failures are OutputError
  kCreate,         ///< a file that need not exist; failures are OutputError
};

/// What errors call a file that is read.
struct FileWords {
  const char* noun = "map";
  const char* not_one = "not a Fovea map";
  const char* what_to_give = "give a file that 'fovea map' wrote";
  const char* if_damaged = "restore the map from a copy, or save what is whole with 'fovea repair'";
};

/// A file has no header of SQLite.
class NoDatabase : public InputError {
 public:
  using InputError::InputError;
};

/// A file that is read is damaged, or lacks a table or column.
class CorruptFile : public InputError {
 public:
  using InputError::InputError;
};

enum class Outcome { kDone, kBusy, kFailed };

/// A connection. Errors name `shown_path`, the file the user knows of.
class Database {
 public:
  Database(const std::filesystem::path& path, Access access,
           const std::filesystem::path& shown_path, const FileWords& words = {});
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// Runs statements whose results do not matter.
  void execute(const char* sql);
  /// As execute(), where a failure is no error of the user: says how it went.
  Outcome attempt(const char* sql) noexcept;
  /// Copies the write-ahead log into the file, so that the file alone has the latest commit.
  /// Waits so long for readers of earlier states.
  Outcome merge_log(std::chrono::milliseconds timeout) noexcept;
  /// First column of the first row, as an integer.
  std::int64_t integer(const char* sql);
  /// Why the latest call failed: the operating system's words, or SQLite's.
  std::string reason() const;

  /// Throws the InputError or OutputError of a failed call with this result code.
  [[noreturn]] void fail(int code) const;
  /// Throws the OutputError of a file that another program has locked.
  [[noreturn]] void throw_busy() const;

  /// Name of the file, for errors.
  std::string where() const { return shown_path_.string(); }
  sqlite3* handle() const { return handle_; }

 private:
  /// errno of a failed call with this result code; 0 if the operating system did not fail.
  int system_error(int code) const;

  Access access_;
  std::filesystem::path shown_path_;
  FileWords words_;
  sqlite3* handle_ = nullptr;
};

enum class ValueType { kNull, kInteger, kReal, kText, kBlob };

/// A prepared statement. Parameters and columns are counted from 1 and from 0, as in SQLite.
class Statement {
 public:
  Statement(Database& database, std::string_view sql);
  ~Statement();
  Statement(Statement&& other) noexcept;
  Statement& operator=(Statement&&) = delete;

  /// Bound text and blobs must live until the statement is reset or run().
  void bind(int parameter, std::int64_t value);
  void bind(int parameter, double value);
  void bind(int parameter, std::string_view text);
  void bind(int parameter, std::span<const std::byte> blob);
  void bind_null(int parameter);

  /// Goes to the next row; false where there is none.
  bool step();
  /// Runs a statement without result to its end and makes it ready for the next use.
  void run();
  /// Makes it ready for the next use, wherever it stands.
  void reset() noexcept;

  ValueType type(int column) const;
  bool is_null(int column) const { return type(column) == ValueType::kNull; }
  std::int64_t integer(int column) const;
  double real(int column) const;
  /// Valid until the next step().
  std::string_view text(int column) const;
  std::span<const std::byte> blob(int column) const;

 private:
  void check(int code) const;

  Database* database_;
  sqlite3_stmt* handle_ = nullptr;
};

/// What SQLite finds wrong with the structure of a file or of one of its tables, a line each.
std::vector<std::string> find_faults(Database& database, const std::string& table = "");

}  // namespace fovea::sqlite
