#include "fovea/core/point_formats/ply_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <string>

#include "fovea/core/point_formats/column_names.h"
#include "fovea/core/read_file.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

std::optional<Scalar> parse_scalar(std::string_view name) {
  if (name == "char" || name == "int8") return Scalar::kInt8;
  if (name == "uchar" || name == "uint8") return Scalar::kUint8;
  if (name == "short" || name == "int16") return Scalar::kInt16;
  if (name == "ushort" || name == "uint16") return Scalar::kUint16;
  if (name == "int" || name == "int32") return Scalar::kInt32;
  if (name == "uint" || name == "uint32") return Scalar::kUint32;
  if (name == "float" || name == "float32") return Scalar::kFloat;
  if (name == "double" || name == "float64") return Scalar::kDouble;
  return std::nullopt;
}

struct Property {
  std::string name;
  Scalar type;
  std::size_t offset;  // in a binary vertex
};

struct Header {
  bool ascii = false;
  std::size_t vertices = 0;
  std::vector<Property> properties;
  std::size_t vertex_bytes = 0;
  std::vector<std::optional<std::size_t>> columns;  // into properties, in the order wanted
};

class PlyFile {
 public:
  PlyFile(InputFile& file, CloudRows& rows)
      : name_(file.path().string()), lines_(file), rows_(rows), row_(rows.columns().size()) {
    read_header();
    resolve_columns();
    const std::uintmax_t rest = lines_.rest();
    // A vertex takes at least two characters a property as text. Checked before anything is
    // allocated: the count of a damaged header can be anything.
    const std::size_t least = header_.ascii ? 2 * header_.properties.size() : header_.vertex_bytes;
    // The last line of a text may lack its line end.
    if (header_.vertices > (rest + (header_.ascii ? 1 : 0)) / least) {
      throw InputError(
          "the file is too short for its " + std::to_string(header_.vertices) + " vertices", name_,
          "write it anew");
    }
  }

  void read() {
    rows_.begin(header_.vertices, types());
    header_.ascii ? read_ascii() : read_binary();
  }

 private:
  [[noreturn]] void reject(const std::string& what) const {
    throw InputError(what, name_ + ":" + std::to_string(std::max(1, lines_.line_number())),
                     std::string("give a PLY file with ") + rows_.description());
  }

  std::string next_line() {
    std::optional<std::string> line = lines_.next();
    if (!line) reject("the PLY file ends early");
    return *std::move(line);
  }

  void read_header() {
    std::string first = lines_.next().value_or("");
    first.erase(first.find_last_not_of(" \t") + 1);
    if (first != "ply") reject("this is no PLY file");
    bool format_seen = false, vertices_seen = false, in_vertices = false;
    while (lines_.line_number() < kMaxHeaderLines) {
      std::istringstream words(next_line());
      std::string keyword, name;
      words >> keyword;
      if (keyword == "end_header") {
        if (!format_seen || !vertices_seen) reject("the header lacks format or vertices");
        return;
      }
      if (keyword == "format") {
        words >> name;
        if (name != "ascii" && name != "binary_little_endian") {
          reject("the PLY format \"" + name + "\" is not read");
        }
        header_.ascii = name == "ascii";
        format_seen = true;
      } else if (keyword == "element") {
        words >> name;
        in_vertices = name == "vertex" && !vertices_seen;
        if (!in_vertices && !vertices_seen) reject("the first element is not \"vertex\"");
        if (in_vertices && !(words >> header_.vertices)) reject("the vertices have no count");
        vertices_seen = true;
      } else if (keyword == "property" && in_vertices) {
        add_property(words);
      }
    }
    reject("the header has no end");
  }

  void add_property(std::istringstream& words) {
    std::string type, name;
    words >> type >> name;
    const std::optional<Scalar> scalar = parse_scalar(type);
    if (!scalar || name.empty()) reject("a vertex property of type \"" + type + "\" is not read");
    header_.properties.push_back({name, *scalar, header_.vertex_bytes});
    header_.vertex_bytes += size_of(*scalar);
  }

  void resolve_columns() {
    constexpr std::size_t kAxes = 3;
    std::vector<std::string> names;
    for (const Property& property : header_.properties) names.push_back(property.name);
    for (const char* wanted : rows_.columns()) {
      header_.columns.push_back(find_column(names, wanted));
      if (header_.columns.size() <= kAxes && !header_.columns.back()) {
        reject(fmt::format("the vertices have no {}, only {}", wanted, list_columns(names)));
      }
    }
    if (!are_coordinates(types(), rows_)) reject("x, y, z must be float or double");
    rows_.describe(names, /*organized=*/false);
  }

  /// Of the columns wanted.
  std::vector<std::optional<Scalar>> types() const {
    std::vector<std::optional<Scalar>> types;
    for (const std::optional<std::size_t>& column : header_.columns) {
      types.push_back(column ? std::optional(header_.properties[*column].type) : std::nullopt);
    }
    return types;
  }

  void read_binary() {
    constexpr std::size_t kBlock = 1 << 14;
    // No larger than the file needs: a header may give a vertex thousands of properties.
    std::vector<char> buffer(std::min(kBlock, header_.vertices) * header_.vertex_bytes);
    for (std::size_t begin = 0; begin < header_.vertices; begin += kBlock) {
      const std::size_t count = std::min(kBlock, header_.vertices - begin);
      const auto bytes = static_cast<std::streamsize>(count * header_.vertex_bytes);
      if (!lines_.stream().read(buffer.data(), bytes))
        reject("the PLY file cannot be read to its end");
      for (std::size_t i = 0; i < count; ++i) {
        const char* vertex = buffer.data() + i * header_.vertex_bytes;
        for (std::size_t column = 0; column < row_.size(); ++column) {
          if (!header_.columns[column]) continue;
          const Property& property = header_.properties[*header_.columns[column]];
          row_[column] = decode(property.type, vertex + property.offset);
        }
        rows_.add(row_, begin + i);
      }
    }
  }

  void read_ascii() {
    for (std::size_t i = 0; i < header_.vertices; ++i) {
      const std::optional<std::vector<double>> numbers = parse_numbers(next_line());
      if (!numbers || numbers->size() != header_.properties.size()) {
        reject("a vertex is not " + std::to_string(header_.properties.size()) + " numbers");
      }
      for (std::size_t column = 0; column < row_.size(); ++column) {
        if (header_.columns[column]) row_[column] = (*numbers)[*header_.columns[column]];
      }
      rows_.add(row_, i);
    }
  }

  std::string name_;
  LineReader lines_;
  Header header_;
  CloudRows& rows_;
  std::vector<double> row_;  // of the vertex that is being read
};

}  // namespace

void read_ply_rows(InputFile& file, CloudRows& rows) { PlyFile(file, rows).read(); }

}  // namespace fovea
