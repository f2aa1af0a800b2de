#include "fovea/core/sqlite_database.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include "fovea/core/input_file.h"
#include "fovea/core/machine_error.h"
#include "fovea/core/output_file.h"
#include "fovea/errors.h"

namespace fovea::sqlite {
namespace {

constexpr int kBusyTimeoutMs = 1000;

/// URI of a file that SQLite shall take as never changing.
std::string immutable_uri(const std::filesystem::path& path) {
  std::string uri = "file://";
  for (const char c : path.string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '/' || c == '.' || c == '-' || c == '_';
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri + "?immutable=1";
}

/// SQLite would wait for a pipe without end.
void require_regular_files(const std::filesystem::path& path) {
  for (const char* ending : {"", "-wal", "-shm", "-journal"}) {
    std::filesystem::path file = path;
    require_regular_if_present(file += ending, kStreamedFile);
  }
}

int open_flags(Access access) {
  switch (access) {
    case Access::kRead:
      return SQLITE_OPEN_READONLY;
    case Access::kReadImmutable:
      return SQLITE_OPEN_READONLY | SQLITE_OPEN_URI;
    case Access::kWrite:
      return SQLITE_OPEN_READWRITE;
    case Access::kCreate:
      return SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  }
  return 0;
}

/// Whether the machine can give SQLite more memory than any row of a file needs. If it can, a
/// SQLITE_NOMEM means damage: a row of almost 2^32 bytes makes SQLite allocate 0 bytes.
bool has_memory_for_rows(sqlite3* database) {
  constexpr std::uintmax_t kLongestRow = 1'000'000'000, kForPages = 16'000'000;
  std::error_code error;
  const std::uintmax_t size =
      std::filesystem::file_size(sqlite3_db_filename(database, "main"), error);
  void* memory = sqlite3_malloc64(std::min(error ? kLongestRow : size, kLongestRow) + kForPages);
  sqlite3_free(memory);
  return memory != nullptr;
}

bool is_reading(Access access) {
  return access == Access::kRead || access == Access::kReadImmutable;
}

}  // namespace

Database::Database(const std::filesystem::path& path, Access access,
                   const std::filesystem::path& shown_path, const FileWords& words)
    : access_(access), shown_path_(shown_path), words_(words) {
  // Absolute, because SQLite gives names such as ":memory:" a meaning of their own.
  const std::filesystem::path absolute = std::filesystem::absolute(path);
  require_regular_files(absolute);
  const std::string name =
      access == Access::kReadImmutable ? immutable_uri(absolute) : absolute.string();
  const int code = sqlite3_open_v2(name.c_str(), &handle_, open_flags(access), nullptr);
  try {
    if (code != SQLITE_OK) fail(code);
    sqlite3_extended_result_codes(handle_, 1);
    sqlite3_busy_timeout(handle_, kBusyTimeoutMs);
    // A file may come from anybody: nothing in its schema gets to run code.
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    // Nor to be a query without end under a table's name.
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  } catch (...) {
    sqlite3_close(handle_);
    throw;
  }
}

Database::~Database() { sqlite3_close(handle_); }

void Database::execute(const char* sql) {
  errno = 0;
  const int code = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code);
}

Outcome Database::attempt(const char* sql) noexcept {
  const int code = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
  if (code == SQLITE_OK) return Outcome::kDone;
  return (code & 0xff) == SQLITE_BUSY ? Outcome::kBusy : Outcome::kFailed;
}

Outcome Database::merge_log(std::chrono::milliseconds timeout) noexcept {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (true) {
    int in_log = -1, merged = -1;
    const int code =
        sqlite3_wal_checkpoint_v2(handle_, nullptr, SQLITE_CHECKPOINT_FULL, &in_log, &merged);
    if (code == SQLITE_OK) return Outcome::kDone;
    if ((code & 0xff) != SQLITE_BUSY) return Outcome::kFailed;
    // A reader of the latest state keeps the log, but the file has all of it.
    if (in_log >= 0 && merged == in_log) return Outcome::kDone;
    if (std::chrono::steady_clock::now() >= end) return Outcome::kBusy;
    // SQLite does not wait for a program that merges the log at the same time.
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

int Database::system_error(int code) const {
  const int primary = code & 0xff;
  if (primary == SQLITE_FULL) return ENOSPC;
  if (handle_ == nullptr || (primary != SQLITE_IOERR && primary != SQLITE_CANTOPEN)) return 0;
  const int error = sqlite3_system_errno(handle_);
  return error != 0 ? error : errno;  // SQLite keeps none of a failed COMMIT
}

std::string Database::reason() const {
  const int error = system_error(sqlite3_extended_errcode(handle_));
  return error != 0 ? std::generic_category().message(error) : sqlite3_errmsg(handle_);
}

std::int64_t Database::integer(const char* sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.integer(0) : 0;
}

void Database::throw_busy() const {
  throw OutputError("another program is using the map", where(),
                    "wait until it has ended or write to another file");
}

void Database::fail(int code) const {
  int primary = code & 0xff;
  std::string message = handle_ != nullptr ? sqlite3_errmsg(handle_) : sqlite3_errstr(code);
  if (primary == SQLITE_NOMEM) {
    if (handle_ == nullptr || !has_memory_for_rows(handle_)) throw std::bad_alloc();
    primary = SQLITE_CORRUPT;
    message = "the length of a row is impossible";
  }
  if (is_reading(access_)) {
    if (primary == SQLITE_NOTADB) {
      throw NoDatabase(words_.not_one, where(), words_.what_to_give);
    }
    if (primary == SQLITE_CORRUPT) {
      throw CorruptFile(fmt::format("the {} is damaged ({})", words_.noun, message), where(),
                        words_.if_damaged);
    }
    if (primary == SQLITE_ERROR) {  // as "no such table"
      throw CorruptFile(fmt::format("the {} cannot be read ({})", words_.noun, message), where(),
                        words_.if_damaged);
    }
    throw_error<InputError>(is_machine_error(system_error(code)),
                            fmt::format("the {} cannot be read ({})", words_.noun, message),
                            where(),
                            "check the file, its permissions and that no program is replacing it");
  }
  if (const int error = system_error(code); error != 0) throw_output_error(shown_path_, error);
  if (primary == SQLITE_BUSY || primary == SQLITE_LOCKED) throw_busy();
  if (primary == SQLITE_NOTADB || primary == SQLITE_CORRUPT) {
    throw OutputError(fmt::format("the map is damaged ({})", message), where(), words_.if_damaged);
  }
  throw OutputError(fmt::format("the map cannot be written ({})", message), where(),
                    "check the file and its permissions");
}

Statement::Statement(Database& database, std::string_view sql) : database_(&database) {
  check(sqlite3_prepare_v2(database.handle(), sql.data(), static_cast<int>(sql.size()), &handle_,
                           nullptr));
}

Statement::~Statement() { sqlite3_finalize(handle_); }

Statement::Statement(Statement&& other) noexcept
    : database_(other.database_), handle_(std::exchange(other.handle_, nullptr)) {}

void Statement::check(int code) const {
  if (code != SQLITE_OK) database_->fail(code);
}

void Statement::bind(int parameter, std::int64_t value) {
  check(sqlite3_bind_int64(handle_, parameter, value));
}

void Statement::bind(int parameter, double value) {
  check(sqlite3_bind_double(handle_, parameter, value));
}

void Statement::bind(int parameter, std::string_view text) {
  // A null pointer would bind NULL instead of an empty text.
  const char* data = text.empty() ? "" : text.data();
  check(sqlite3_bind_text64(handle_, parameter, data, text.size(), SQLITE_STATIC, SQLITE_UTF8));
}

void Statement::bind(int parameter, std::span<const std::byte> blob) {
  // A null pointer would bind NULL instead of an empty blob.
  if (blob.empty()) return check(sqlite3_bind_zeroblob(handle_, parameter, 0));
  check(sqlite3_bind_blob64(handle_, parameter, blob.data(), blob.size(), SQLITE_STATIC));
}

void Statement::bind_null(int parameter) { check(sqlite3_bind_null(handle_, parameter)); }

bool Statement::step() {
  errno = 0;
  const int code = sqlite3_step(handle_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) {
    // Before reset(), which would end the statement's own transaction and its message.
    try {
      database_->fail(code);
    } catch (...) {
      sqlite3_reset(handle_);
      throw;
    }
  }
  return false;
}

void Statement::run() {
  while (step()) {
  }
  check(sqlite3_reset(handle_));
}

void Statement::reset() noexcept { sqlite3_reset(handle_); }

ValueType Statement::type(int column) const {
  switch (sqlite3_column_type(handle_, column)) {
    case SQLITE_INTEGER:
      return ValueType::kInteger;
    case SQLITE_FLOAT:
      return ValueType::kReal;
    case SQLITE_TEXT:
      return ValueType::kText;
    case SQLITE_BLOB:
      return ValueType::kBlob;
    default:
      return ValueType::kNull;
  }
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(handle_, column); }

double Statement::real(int column) const { return sqlite3_column_double(handle_, column); }

std::string_view Statement::text(int column) const {
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(handle_, column));
  return {data == nullptr ? "" : data,
          static_cast<std::size_t>(sqlite3_column_bytes(handle_, column))};
}

std::span<const std::byte> Statement::blob(int column) const {
  const auto* data = static_cast<const std::byte*>(sqlite3_column_blob(handle_, column));
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(handle_, column))};
}

std::vector<std::string> find_faults(Database& database, const std::string& table) {
  std::vector<std::string> faults;
  try {
    Statement rows(database, table.empty() ? "PRAGMA integrity_check"
                                           : fmt::format("PRAGMA integrity_check({})", table));
    while (rows.step()) {
      std::istringstream lines{std::string(rows.text(0))};
      for (std::string line; std::getline(lines, line);) {
        if (line != "ok" && !line.starts_with("***")) faults.push_back(line);
      }
    }
  } catch (const CorruptFile&) {
    faults.emplace_back("SQLite cannot read the pages");
  }
  return faults;
}

}  // namespace fovea::sqlite
