// Shared by the readers of point clouds: the rows that they pass on, types of numbers, and lines.
#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "fovea/core/input_file.h"

namespace fovea {

/// Types of binary numbers in a file.
enum class Scalar {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat,
  kDouble
};
std::size_t size_of(Scalar type);
bool is_real(Scalar type);
/// The number at `bytes`, little endian.
double decode(Scalar type, const char* bytes);

class CloudRows;
/// Whether x, y, z may be of these types: all real, or all whole where the rows take that.
bool are_coordinates(std::span<const std::optional<Scalar>> types, const CloudRows& rows);

/// Who wants the points of a file: which columns, and what becomes of each point.
class CloudRows {
 public:
  virtual ~CloudRows() = default;

  /// Names of the columns wanted, the same at every call; find_column() finds them in a file. The
  /// first three are "x", "y", "z", which a file must have, of one kind of type.
  virtual std::span<const char* const> columns() const = 0;
  /// Whether x, y, z may be whole numbers: they cannot be meters then.
  virtual bool takes_whole_coordinates() const { return false; }
  /// What a right file has ("x y z and rgb"), for errors.
  virtual const char* description() const = 0;

  /// Called once, before begin().
  /// @param names      of all columns, as the file has them
  /// @param organized  whether the points form a grid, in which NaN marks a missing return
  virtual void describe(std::span<const std::string> /*names*/, bool /*organized*/) {}
  /// Called once, before any point. InputError if the file's columns are not as they should be.
  /// @param points  as many at most; the file is long enough for them
  /// @param types   of the columns, in their order; empty where the file has none of that name
  virtual void begin(std::size_t points, std::span<const std::optional<Scalar>> types) = 0;
  /// Called for each point, those with NaN included.
  /// @param row     its values in the columns' order, 0 where the file has none
  /// @param number  of the point in the file, from 0
  virtual void add(std::span<const double> row, std::size_t number) = 0;
};

/// A header of more lines is none.
inline constexpr int kMaxHeaderLines = 1000;

/// Lines of a file that may be anything: none is longer than 64 KiB.
class LineReader {
 public:
  /// @param file  must outlive the reader
  explicit LineReader(InputFile& file) : file_(file), buffer_(kMaxLine, '\0') {}

  /// The next line without its end (LF or CRLF); empty at the end of the file. InputError for a
  /// line that is too long.
  std::optional<std::string> next();
  int line_number() const { return line_number_; }   ///< of the last line, from 1
  std::istream& stream() { return file_.stream(); }  ///< after the last line
  /// Bytes after the last line.
  std::uintmax_t rest();

 private:
  static constexpr std::size_t kMaxLine = 1 << 16;

  InputFile& file_;
  int line_number_ = 0;
  std::string buffer_;
};

}  // namespace fovea
