#include "fovea/core/point_formats/pcd_rows.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "fovea/core/point_formats/column_names.h"
#include "fovea/core/point_formats/lzf.h"
#include "fovea/core/point_formats/pcd_header.h"
#include "fovea/core/read_file.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// Whether the field is four bytes of colour, which may be declared as a float.
bool is_packed_color(std::string_view name) { return name == "rgb" || name == "rgba"; }

class PcdFile {
 public:
  PcdFile(InputFile& file, CloudRows& rows)
      : name_(file.path().string()),
        lines_(file),
        rows_(rows),
        header_(read_pcd_header(lines_, name_, rows.description())),
        row_(rows.columns().size()) {
    resolve_columns();
  }

  void read() {
    // The count of a damaged header can be anything: checked before anything is allocated.
    const std::uintmax_t rest = lines_.rest();
    if (header_.encoding == PcdHeader::Encoding::kAscii) {
      require_length((rest + 1) /
                     (2 * header_.numbers));  // a digit and a blank each; no blank at the end
    } else if (header_.encoding == PcdHeader::Encoding::kBinary) {
      require_length(rest / header_.point_bytes);
    } else {
      require_length(rest * kLzfMaxRatio / header_.point_bytes);
    }
    rows_.begin(header_.points, types());
    switch (header_.encoding) {
      case PcdHeader::Encoding::kAscii:
        read_ascii();
        break;
      case PcdHeader::Encoding::kBinary:
        read_binary();
        break;
      case PcdHeader::Encoding::kCompressed:
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
    if (header_.points <= most) return;
    throw InputError("the file is too short for its " + std::to_string(header_.points) + " points",
                     name_, "write it anew");
  }

  void resolve_columns() {
    constexpr std::size_t kAxes = 3;
    std::vector<std::string> names;
    for (const PcdField& field : header_.fields) names.push_back(field.name);
    for (const char* wanted : rows_.columns()) {
      std::optional<PcdField>& column = columns_.emplace_back();
      if (const auto found = find_column(names, wanted)) {
        column = header_.fields[*found];
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
    rows_.describe(names, header_.organized);
  }

  /// Of the columns wanted.
  std::vector<std::optional<Scalar>> types() const {
    std::vector<std::optional<Scalar>> types;
    for (const std::optional<PcdField>& field : columns_) {
      types.push_back(field ? std::optional(field->type) : std::nullopt);
    }
    return types;
  }

  /// @param at  the first byte of a field's value for this point
  template <class At>
  void add_binary(At&& at, std::size_t number) {
    for (std::size_t column = 0; column < row_.size(); ++column) {
      if (const std::optional<PcdField>& field = columns_[column]) {
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
    std::string buffer(std::min(kBlock, header_.points) * header_.point_bytes, '\0');
    for (std::size_t begin = 0; begin < header_.points; begin += kBlock) {
      const std::size_t count = std::min(kBlock, header_.points - begin);
      if (!lines_.stream().read(buffer.data(), std::streamsize(count * header_.point_bytes))) {
        reject_data("the file cannot be read to its end",
                    begin_of_data + begin * header_.point_bytes);
      }
      for (std::size_t i = 0; i < count; ++i) {
        const char* point = buffer.data() + i * header_.point_bytes;
        add_binary([&](const PcdField& field) { return point + field.offset; }, begin + i);
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
    if (size != header_.points * header_.point_bytes || size > packed_size * kLzfMaxRatio) {
      reject_data("the compressed data is not of the size of the points", begin_of_data + 4);
    }
    std::string packed(packed_size, '\0');
    if (!stream.read(packed.data(), packed_size)) {
      reject_data("the file cannot be read to its end", begin_of_data + 8);
    }
    const std::optional<std::string> values = lzf_decompress(packed, size);
    if (!values) reject_data("the compressed data is damaged", begin_of_data + 8);
    for (std::size_t i = 0; i < header_.points; ++i) {
      add_binary(
          [&](const PcdField& field) {
            return values->data() + header_.points * field.offset +
                   i * field.count * size_of(field.type);
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
    for (std::size_t i = 0; i < header_.points; ++i) {
      const std::optional<std::string> line = lines_.next();
      if (!line) reject("the file ends before its last point");
      const std::optional<std::vector<double>> numbers = parse_numbers(*line);
      if (!numbers || numbers->size() != header_.numbers) {
        reject("a point is not " + std::to_string(header_.numbers) + " numbers");
      }
      for (std::size_t column = 0; column < row_.size(); ++column) {
        const std::optional<PcdField>& field = columns_[column];
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
  PcdHeader header_;
  std::vector<std::optional<PcdField>> columns_;  // in the order of rows_.columns()
  std::vector<double> row_;                       // of the point that is being read
};

}  // namespace

void read_pcd_rows(InputFile& file, CloudRows& rows) { PcdFile(file, rows).read(); }

}  // namespace fovea
