#include "fovea/core/point_formats/pcd_header.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <sstream>

#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr std::size_t kMaxPointBytes = 1 << 16;

std::optional<Scalar> parse_scalar(std::string_view type, std::size_t size) {
  if (type == "F") {
    if (size == 4) return Scalar::kFloat;
    if (size == 8) return Scalar::kDouble;
    return std::nullopt;
  }
  if (type != "I" && type != "U") return std::nullopt;
  const bool sign = type == "I";
  switch (size) {
    case 1:
      return sign ? Scalar::kInt8 : Scalar::kUint8;
    case 2:
      return sign ? Scalar::kInt16 : Scalar::kUint16;
    case 4:
      return sign ? Scalar::kInt32 : Scalar::kUint32;
    case 8:
      return sign ? Scalar::kInt64 : Scalar::kUint64;
    default:
      return std::nullopt;
  }
}

class HeaderReader {
 public:
  HeaderReader(LineReader& lines, const std::string& name, const std::string& description)
      : lines_(lines), name_(name), description_(description) {}

  PcdHeader read() {
    read_header();
    lay_out_fields();
    return std::move(header_);
  }

 private:
  [[noreturn]] void reject(const std::string& what) const {
    throw InputError(what, name_ + ":" + std::to_string(std::max(1, lines_.line_number())),
                     "give a PCD file with " + description_);
  }

  /// A count of the header; a sign, a fraction or anything behind it is an error.
  std::size_t count_of(const std::string& word) const {
    std::size_t value = 0;
    const char* end = word.data() + word.size();
    const auto [rest, error] = std::from_chars(word.data(), end, value);
    if (word.empty() || error != std::errc() || rest != end) {
      reject("\"" + word + "\" is no count");
    }
    return value;
  }

  void read_header() {
    std::optional<std::size_t> width, height, points;
    while (lines_.line_number() < kMaxHeaderLines) {
      const std::optional<std::string> line = lines_.next();
      if (!line)
        reject(header_.fields.empty() ? "this is no PCD file" : "the PCD header has no DATA");
      std::istringstream words(*line);
      std::string keyword, word;
      if (!(words >> keyword) || keyword.starts_with('#')) continue;
      std::vector<std::string> values;
      while (words >> word) values.push_back(word);
      const auto only = [&]() -> const std::string& {
        if (values.size() != 1) reject(keyword + " needs one value");
        return values[0];
      };
      if (keyword == "FIELDS" || keyword == "COLUMNS") {
        for (const std::string& name : values) header_.fields.push_back({.name = name});
      } else if (keyword == "SIZE") {
        sizes_ = values;
      } else if (keyword == "TYPE") {
        types_ = values;
      } else if (keyword == "COUNT") {
        counts_ = values;
      } else if (keyword == "WIDTH") {
        width = count_of(only());
      } else if (keyword == "HEIGHT") {
        height = count_of(only());
      } else if (keyword == "POINTS") {
        points = count_of(only());
      } else if (keyword == "DATA") {
        set_encoding(only());
        set_points(width, height, points);
        return;
      } else if (keyword != "VERSION" && keyword != "VIEWPOINT") {
        reject(header_.fields.empty() ? "this is no PCD file"
                                      : "\"" + keyword + "\" is no line of a PCD header");
      }
    }
    reject("the PCD header has no DATA");
  }

  void set_encoding(const std::string& name) {
    if (name == "ascii") {
      header_.encoding = PcdHeader::Encoding::kAscii;
    } else if (name == "binary") {
      header_.encoding = PcdHeader::Encoding::kBinary;
    } else if (name == "binary_compressed") {
      header_.encoding = PcdHeader::Encoding::kCompressed;
    } else {
      reject("PCD data of the form \"" + name + "\" is not read");
    }
  }

  void set_points(std::optional<std::size_t> width, std::optional<std::size_t> height,
                  std::optional<std::size_t> points) {
    if (!points && !width) reject("the header has neither POINTS nor WIDTH");
    if (!width) width = points, height = 1;
    const std::size_t rows = height.value_or(1);
    if (rows != 0 && *width > std::numeric_limits<std::size_t>::max() / rows) {
      reject("WIDTH x HEIGHT is too large");
    }
    if (points && *points != *width * rows) reject("POINTS is not WIDTH x HEIGHT");
    header_.points = *width * rows;
    header_.organized = rows > 1;
  }

  void lay_out_fields() {
    if (header_.fields.empty()) reject("the header has no FIELDS");
    if (sizes_.size() != header_.fields.size() || types_.size() != header_.fields.size() ||
        (!counts_.empty() && counts_.size() != header_.fields.size())) {
      reject("SIZE, TYPE or COUNT are not one a field");
    }
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      PcdField& field = header_.fields[i];
      const std::optional<Scalar> type = parse_scalar(types_[i], count_of(sizes_[i]));
      if (!type) reject("a field of type " + types_[i] + " and size " + sizes_[i] + " is not read");
      field.type = *type;
      field.count = counts_.empty() ? 1 : count_of(counts_[i]);
      field.offset = header_.point_bytes;
      field.first = header_.numbers;
      if (field.count > kMaxPointBytes) reject("a field has too many numbers");
      header_.point_bytes += field.count * size_of(field.type);
      header_.numbers += field.count;
      if (header_.point_bytes > kMaxPointBytes) reject("a point takes more than 64 KiB");
    }
  }

  LineReader& lines_;
  const std::string &name_, &description_;
  PcdHeader header_;
  std::vector<std::string> sizes_, types_, counts_;  // as the file has them
};

}  // namespace

PcdHeader read_pcd_header(LineReader& lines, const std::string& name,
                          const std::string& description) {
  return HeaderReader(lines, name, description).read();
}

}  // namespace fovea
