#include "fovea/evaluation/ply_reader.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include "fovea/base/errors.h"
#include "fovea/sensor/read_file.h"

namespace fovea {
namespace {

constexpr int kMaxHeaderLines = 1000;

enum class Scalar { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

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
    case Scalar::kDouble:
      return 8;
  }
  return 0;
}

template <class T>
double read_as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);  // little endian, like every machine this is built for
  return static_cast<double>(value);
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
    case Scalar::kFloat:
      return read_as<float>(bytes);
    case Scalar::kDouble:
      return read_as<double>(bytes);
  }
  return 0;
}

struct Property {
  std::string name;
  Scalar type;
  std::size_t offset;  // in a binary vertex
};

/// The columns that are read, in the order in which a vertex's values are handed on.
enum Column : std::size_t {
  kX,
  kY,
  kZ,
  kRed,
  kGreen,
  kBlue,
  kCamera,
  kFrame,
  kInterpolated,
  kColumns
};
constexpr std::array<const char*, kColumns> kColumnNames = {
    "x", "y", "z", "red", "green", "blue", "camera", "frame", "interpolated"};
using Vertex = std::array<double, kColumns>;

struct Header {
  bool ascii = false;
  std::size_t vertices = 0;
  std::vector<Property> properties;
  std::size_t vertex_bytes = 0;
  std::array<std::optional<std::size_t>, kColumns> columns;  // into properties

  bool has(Column column) const { return columns[column].has_value(); }
};

class PlyFile {
 public:
  PlyFile(const std::filesystem::path& file, const Eigen::Vector3d& origin)
      : name_(file.string()), stream_(file, std::ios::binary) {
    if (!stream_) throw InputError("the file cannot be read", name_, "check the path");
    cloud_.points.origin = origin;
    read_header();
    resolve_columns();
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    const std::uintmax_t rest =
        error ? 0 : bytes - std::min<std::uintmax_t>(bytes, stream_.tellg());
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

  PlyCloud read() {
    reserve();
    header_.ascii ? read_ascii() : read_binary();
    return std::move(cloud_);
  }

 private:
  [[noreturn]] void reject(const std::string& what) const {
    throw InputError(what, name_ + ":" + std::to_string(line_number_),
                     "give a PLY file with x y z and red green blue");
  }

  std::string next_line() {
    std::string line;
    if (!std::getline(stream_, line)) reject("the PLY file ends early");
    ++line_number_;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
  }

  void read_header() {
    char magic[3] = {};
    stream_.read(magic, sizeof magic);
    line_number_ = 1;
    if (std::string_view(magic, 3) != "ply") reject("this is no PLY file");
    line_number_ = 0;
    if (!next_line().empty()) reject("this is no PLY file");
    bool format_seen = false, vertices_seen = false, in_vertices = false;
    while (line_number_ < kMaxHeaderLines) {
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
    const auto& properties = header_.properties;
    for (std::size_t column = 0; column < kColumns; ++column) {
      const auto found = std::find_if(properties.begin(), properties.end(), [&](const Property& p) {
        return p.name == kColumnNames[column];
      });
      if (found == properties.end()) {
        if (column <= kZ) reject(std::string("the vertices have no ") + kColumnNames[column]);
        continue;
      }
      const bool real = found->type == Scalar::kFloat || found->type == Scalar::kDouble;
      if (column <= kZ && !real) reject("x, y, z must be float or double");
      if (column >= kRed && column <= kBlue && found->type != Scalar::kUint8) {
        reject("red, green, blue must be uchar");
      }
      header_.columns[column] = static_cast<std::size_t>(found - properties.begin());
    }
    if (header_.has(kRed) != header_.has(kGreen) || header_.has(kRed) != header_.has(kBlue)) {
      reject("red, green and blue are not all there");
    }
    cloud_.has_camera = header_.has(kCamera);
  }

  void reserve() {
    PointCloud& points = cloud_.points;
    points.position.reserve(header_.vertices);
    points.color.reserve(header_.vertices);
    points.camera.reserve(header_.vertices);
    if (header_.has(kFrame)) points.frame.reserve(header_.vertices);
    if (header_.has(kInterpolated)) points.interpolated.reserve(header_.vertices);
  }

  void add(const Vertex& vertex) {
    const auto refuse = [&](const char* what) {
      throw InputError(what, name_ + ", vertex " + std::to_string(cloud_.points.size()),
                       "write the file anew");
    };
    const Eigen::Vector3d p(vertex[kX], vertex[kY], vertex[kZ]);
    if (!p.allFinite()) refuse("a coordinate is not finite");
    const double camera = !header_.has(kRed) ? kNoCamera : vertex[kCamera];
    if (!(camera >= kNoCamera && camera <= 127)) refuse("a camera number is out of range");
    const double frame = vertex[kFrame];
    if (!(std::abs(frame) < 2e9)) refuse("a frame number is out of range");
    PointCloud& points = cloud_.points;
    points.position.push_back((p - points.origin).cast<float>());
    points.camera.push_back(static_cast<std::int8_t>(camera));
    points.color.push_back({static_cast<std::uint8_t>(vertex[kRed]),
                            static_cast<std::uint8_t>(vertex[kGreen]),
                            static_cast<std::uint8_t>(vertex[kBlue])});
    if (header_.has(kFrame)) points.frame.push_back(static_cast<std::int32_t>(frame));
    if (header_.has(kInterpolated)) points.interpolated.push_back(vertex[kInterpolated] != 0);
  }

  void read_binary() {
    constexpr std::size_t kBlock = 1 << 14;
    std::vector<char> buffer(kBlock * header_.vertex_bytes);
    for (std::size_t begin = 0; begin < header_.vertices; begin += kBlock) {
      const std::size_t count = std::min(kBlock, header_.vertices - begin);
      const auto bytes = static_cast<std::streamsize>(count * header_.vertex_bytes);
      if (!stream_.read(buffer.data(), bytes)) reject("the PLY file cannot be read to its end");
      for (std::size_t i = 0; i < count; ++i) {
        const char* row = buffer.data() + i * header_.vertex_bytes;
        Vertex vertex{};
        for (std::size_t column = 0; column < kColumns; ++column) {
          if (!header_.columns[column]) continue;
          const Property& property = header_.properties[*header_.columns[column]];
          vertex[column] = decode(property.type, row + property.offset);
        }
        add(vertex);
      }
    }
  }

  void read_ascii() {
    for (std::size_t i = 0; i < header_.vertices; ++i) {
      const std::optional<std::vector<double>> numbers = parse_numbers(next_line());
      if (!numbers || numbers->size() != header_.properties.size()) {
        reject("a vertex is not " + std::to_string(header_.properties.size()) + " numbers");
      }
      Vertex vertex{};
      for (std::size_t column = 0; column < kColumns; ++column) {
        if (header_.columns[column]) vertex[column] = (*numbers)[*header_.columns[column]];
      }
      for (const Column color : {kRed, kGreen, kBlue}) {
        if (!(vertex[color] >= 0 && vertex[color] <= 255)) reject("a colour is not in 0-255");
      }
      add(vertex);
    }
  }

  std::string name_;
  std::ifstream stream_;
  int line_number_ = 0;
  Header header_;
  PlyCloud cloud_;
};

}  // namespace

PlyCloud read_ply(const std::filesystem::path& file, const Eigen::Vector3d& origin) {
  return PlyFile(file, origin).read();
}

}  // namespace fovea
