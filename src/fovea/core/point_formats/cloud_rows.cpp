#include "fovea/core/point_formats/cloud_rows.h"

#include <algorithm>
#include <cstring>

#include "fovea/errors.h"

namespace fovea {
namespace {

template <class T>
double read_as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);  // little endian, like every machine this is built for
  return static_cast<double>(value);
}

}  // namespace

std::size_t size_of(Scalar type) {
  switch (type) {
    case Scalar::kInt8:
    case Scalar::kUint8:
      return 1;
    case Scalar::kInt16:
    case Scalar::kUint16:
      return 2;
    case Scalar::kInt32:
    case Scalar::kUint32:
    case Scalar::kFloat:
      return 4;
    case Scalar::kInt64:
    case Scalar::kUint64:
    case Scalar::kDouble:
      return 8;
  }
  return 0;
}

bool is_real(Scalar type) { return type == Scalar::kFloat || type == Scalar::kDouble; }

bool are_coordinates(std::span<const std::optional<Scalar>> types, const CloudRows& rows) {
  if (!types[0] || !types[1] || !types[2]) return false;
  const bool real = is_real(*types[0]);
  return real == is_real(*types[1]) && real == is_real(*types[2]) &&
         (real || rows.takes_whole_coordinates());
}

double decode(Scalar type, const char* bytes) {
  switch (type) {
    case Scalar::kInt8:
      return read_as<std::int8_t>(bytes);
    case Scalar::kUint8:
      return read_as<std::uint8_t>(bytes);
    case Scalar::kInt16:
      return read_as<std::int16_t>(bytes);
    case Scalar::kUint16:
      return read_as<std::uint16_t>(bytes);
    case Scalar::kInt32:
      return read_as<std::int32_t>(bytes);
    case Scalar::kUint32:
      return read_as<std::uint32_t>(bytes);
    case Scalar::kInt64:
      return read_as<std::int64_t>(bytes);
    case Scalar::kUint64:
      return read_as<std::uint64_t>(bytes);
    case Scalar::kFloat:
      return read_as<float>(bytes);
    case Scalar::kDouble:
      return read_as<double>(bytes);
  }
  return 0;
}

std::optional<std::string> LineReader::next() {
  stream().getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  const auto count = static_cast<std::size_t>(stream().gcount());
  if (count == 0 && !stream()) return std::nullopt;
  ++line_number_;
  if (stream().fail()) {
    throw InputError("a line is longer than 64 KiB",
                     file_.path().string() + ":" + std::to_string(line_number_),
                     "write the file anew");
  }
  // The line end counts among the characters read, but the end of the file does not.
  std::string line(buffer_.data(), stream().eof() ? count : count - 1);
  if (!line.empty() && line.back() == '\r') line.pop_back();
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // of UTF-8
  if (line_number_ == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
  return line;
}

std::uintmax_t LineReader::rest() {
  if (stream().eof()) return 0;
  const std::streamoff at = stream().tellg();
  return at < 0 ? 0 : file_.size() - std::min(file_.size(), static_cast<std::uintmax_t>(at));
}

}  // namespace fovea
