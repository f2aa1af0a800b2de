#include "fovea/core/point_formats/pcd_rows.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstring>
#include <sstream>

#include "fovea/core/errors.h"
#include "fovea/core/point_formats/column_names.h"
#include "fovea/core/point_formats/lzf.h"
#include "fovea/core/read_file.h"

namespace fovea {
namespace {

constexpr std::size_t kMaxPointBytes = 1 << 16;

enum class Encoding { kAscii, kBinary, kCompressed };

struct Field {
  std::string name;
  Scalar type = Scalar::kFloat;
  std::size_t count = 1;   // numbers
  std::size_t offset = 0;  // in a point, bytes
  std::size_t first = 0;   // in a point, numbers
};

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

/// Whether the field is four bytes of colour, which may be declared as a float.
bool is_packed_color(std::string_view name) { return name == "rgb" || name == "rgba"; }

class PcdFile {
 public:
  PcdFile(InputFile& file, CloudRows& rows)
      : name_(file.path().string()), lines_(file), rows_(rows), row_(rows.columns().size()) {
    read_header();
    lay_out_fields();
    resolve_columns();
  }

  void read() {
    // The count of a damaged header can be anything: checked before anything is allocated.
    const std::uintmax_t rest = lines_.rest();
    if (encoding_ == Encoding::kAscii) {
      require_length((rest + 1) / (2 * numbers_));  // a digit and a blank each; no blank at the end
    } else if (encoding_ == Encoding::kBinary) {
      require_length(rest / point_bytes_);
    } else {
      require_length(rest * kLzfMaxRatio / point_bytes_);
    }
    rows_.begin(points_, types());
    switch (encoding_) {
      case Encoding::kAscii:
        read_ascii();
        break;
      case Encoding::kBinary:
        read_binary();
        break;
      case Encoding::kCompressed:
        read_compressed();
        break;
    }
  }

 private:
  [[noreturn]] void reject(const std::string& what) const {
    throw InputError(what, name_ + ":" + std::to_string(std::max(1, lines_.line_number())),
                     std::string("give a PCD file with ") + rows_.description());
  }
  [[noreturn]] void reject_data(const std::string& what, std::uintmax_t offset) const {
    throw InputError(what, name_ + ", byte " + std::to_string(offset), "write the file anew");
  }

  void require_length(std::uintmax_t most) const {
    if (points_ <= most) return;
    throw InputError("the file is too short for its " + std::to_string(points_) + " points", name_,
                     "write it anew");
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
      if (!line) reject(fields_.empty() ? "this is no PCD file" : "the PCD header has no DATA");
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
        for (const std::string& name : values) fields_.push_back({.name = name});
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
        reject(fields_.empty() ? "this is no PCD file"
                               : "\"" + keyword + "\" is no line of a PCD header");
      }
    }
    reject("the PCD header has no DATA");
  }

  void set_encoding(const std::string& name) {
    if (name == "ascii") {
      encoding_ = Encoding::kAscii;
    } else if (name == "binary") {
      encoding_ = Encoding::kBinary;
    } else if (name == "binary_compressed") {
      encoding_ = Encoding::kCompressed;
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
    points_ = *width * rows;
    organized_ = rows > 1;
  }

  void lay_out_fields() {
    if (fields_.empty()) reject("the header has no FIELDS");
    if (sizes_.size() != fields_.size() || types_.size() != fields_.size() ||
        (!counts_.empty() && counts_.size() != fields_.size())) {
      reject("SIZE, TYPE or COUNT are not one a field");
    }
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      Field& field = fields_[i];
      const std::optional<Scalar> type = parse_scalar(types_[i], count_of(sizes_[i]));
      if (!type) reject("a field of type " + types_[i] + " and size " + sizes_[i] + " is not read");
      field.type = *type;
      field.count = counts_.empty() ? 1 : count_of(counts_[i]);
      field.offset = point_bytes_;
      field.first = numbers_;
      if (field.count > kMaxPointBytes) reject("a field has too many numbers");
      point_bytes_ += field.count * size_of(field.type);
      numbers_ += field.count;
      if (point_bytes_ > kMaxPointBytes) reject("a point takes more than 64 KiB");
    }
  }

  void resolve_columns() {
    constexpr std::size_t kAxes = 3;
    std::vector<std::string> names;
    for (const Field& field : fields_) names.push_back(field.name);
    for (const char* wanted : rows_.columns()) {
      std::optional<Field>& column = columns_.emplace_back();
      if (const auto found = find_column(names, wanted)) {
        column = fields_[*found];
        if (column->count != 1) reject("the field " + column->name + " must have COUNT 1");
        column->name = wanted;
        if (is_packed_color(wanted) && size_of(column->type) != 4) {
          reject(std::string(wanted) + " must have four bytes");
        }
      } else if (columns_.size() <= kAxes) {
        reject(fmt::format("there is no field {} among {}", wanted, list_columns(names)));
      }
    }
    if (!are_coordinates(types(), rows_)) reject("x, y, z must be of type F");
    rows_.describe(names, organized_);
  }

  /// Of the columns wanted.
  std::vector<std::optional<Scalar>> types() const {
    std::vector<std::optional<Scalar>> types;
    for (const std::optional<Field>& field : columns_) {
      types.push_back(field ? std::optional(field->type) : std::nullopt);
    }
    return types;
  }

  /// @param at  the first byte of a field's value for this point
  template <class At>
  void add_binary(At&& at, std::size_t number) {
    for (std::size_t column = 0; column < row_.size(); ++column) {
      if (const std::optional<Field>& field = columns_[column]) {
        row_[column] =
            decode(is_packed_color(field->name) ? Scalar::kUint32 : field->type, at(*field));
      }
    }
    rows_.add(row_, number);
  }

  void read_binary() {
    constexpr std::size_t kBlock = 1 << 10;  // points
    const std::uintmax_t begin_of_data = static_cast<std::uintmax_t>(lines_.stream().tellg());
    // No larger than the file needs: a header may give a point 64 KiB.
    std::string buffer(std::min(kBlock, points_) * point_bytes_, '\0');
    for (std::size_t begin = 0; begin < points_; begin += kBlock) {
      const std::size_t count = std::min(kBlock, points_ - begin);
      if (!lines_.stream().read(buffer.data(), std::streamsize(count * point_bytes_))) {
        reject_data("the file cannot be read to its end", begin_of_data + begin * point_bytes_);
      }
      for (std::size_t i = 0; i < count; ++i) {
        const char* point = buffer.data() + i * point_bytes_;
        add_binary([&](const Field& field) { return point + field.offset; }, begin + i);
      }
    }
  }

  /// One LZF stream of all values of the first field, then all of the second, ...
  void read_compressed() {
    std::istream& stream = lines_.stream();
    const std::uintmax_t begin_of_data = static_cast<std::uintmax_t>(stream.tellg());
    std::array<char, 8> sizes;
    if (!stream.read(sizes.data(), sizes.size())) {
      reject_data("the compressed data has no sizes", begin_of_data);
    }
    std::uint32_t packed_size = 0, size = 0;
    std::memcpy(&packed_size, sizes.data(), 4);
    std::memcpy(&size, sizes.data() + 4, 4);
    if (packed_size > lines_.rest()) {
      reject_data("the file is too short for its compressed data", begin_of_data);
    }
    if (size != points_ * point_bytes_ || size > packed_size * kLzfMaxRatio) {
      reject_data("the compressed data is not of the size of the points", begin_of_data + 4);
    }
    std::string packed(packed_size, '\0');
    if (!stream.read(packed.data(), packed_size)) {
      reject_data("the file cannot be read to its end", begin_of_data + 8);
    }
    const std::optional<std::string> values = lzf_decompress(packed, size);
    if (!values) reject_data("the compressed data is damaged", begin_of_data + 8);
    for (std::size_t i = 0; i < points_; ++i) {
      add_binary(
          [&](const Field& field) {
            return values->data() + points_ * field.offset + i * field.count * size_of(field.type);
          },
          i);
    }
  }

  /// The bits of a packed colour given as text: of a float, or a whole number.
  std::uint32_t packed_of(Scalar type, double value) const {
    if (!is_real(type) || (value >= 1 && value == std::floor(value))) {
      if (value < 0) value += 0x1p32;  // of type I
      if (!(value >= 0 && value < 0x1p32 && value == std::floor(value))) {
        reject("a packed colour is no whole number of 32 bits");
      }
      return static_cast<std::uint32_t>(value);
    }
    if (std::isnan(value)) reject("a packed colour is not a number");
    return std::bit_cast<std::uint32_t>(static_cast<float>(value));
  }

  void read_ascii() {
    for (std::size_t i = 0; i < points_; ++i) {
      const std::optional<std::string> line = lines_.next();
      if (!line) reject("the file ends before its last point");
      const std::optional<std::vector<double>> numbers = parse_numbers(*line);
      if (!numbers || numbers->size() != numbers_) {
        reject("a point is not " + std::to_string(numbers_) + " numbers");
      }
      for (std::size_t column = 0; column < row_.size(); ++column) {
        const std::optional<Field>& field = columns_[column];
        if (!field) continue;
        const double number = (*numbers)[field->first];
        row_[column] = is_packed_color(field->name) ? packed_of(field->type, number) : number;
      }
      rows_.add(row_, i);
    }
  }

  std::string name_;
  LineReader lines_;
  CloudRows& rows_;
  Encoding encoding_ = Encoding::kAscii;
  std::vector<std::string> sizes_, types_, counts_;  // of the header, as they stand there
  std::vector<Field> fields_;
  std::size_t points_ = 0, point_bytes_ = 0, numbers_ = 0;
  bool organized_ = false;
  std::vector<std::optional<Field>> columns_;  // in the order of rows_.columns()
  std::vector<double> row_;                    // of the point that is being read
};

}  // namespace

void read_pcd_rows(InputFile& file, CloudRows& rows) { PcdFile(file, rows).read(); }

}  // namespace fovea
