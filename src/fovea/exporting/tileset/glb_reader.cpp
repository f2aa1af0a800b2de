#include "fovea/exporting/tileset/glb_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "fovea/core/angle.h"
#include "fovea/errors.h"
#include "fovea/exporting/gltf.h"
#include "fovea/exporting/tileset/glb.h"
#include "fovea/map/point_files/point_source.h"

namespace fovea {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kHeader = 20, kChunkHeader = 8;   // bytes
constexpr double kMostSteps = 65535 + 0.5;              // with rounding
constexpr double kMostDistance = 1e8, kMostStep = 1e4;  // m; no map is as large

template <class T>
T value_at(std::string_view bytes, std::size_t offset) {
  if (offset > bytes.size() || sizeof(T) > bytes.size() - offset) {
    throw std::invalid_argument("it ends too early");
  }
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

/// A number that is none, such as 1e30, has no conversion.
std::size_t count_of(const Json& json) {
  if (!json.is_number_unsigned()) throw std::invalid_argument(json.dump() + " is no count");
  return json.get<std::size_t>();
}

/// A file, or its bytes in memory.
struct GlbBytes {
  std::size_t size = 0;
  std::function<std::string(std::size_t offset, std::size_t count)> range;  ///< at most `count`
};

/// The head of a file: position = low + step * quantized position.
struct GlbHead {
  std::size_t points = 0;
  double step = 0;
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
  Json json;
  std::size_t binary = 0;  // offset of the binary chunk's content

  /// Offset of an attribute's first value; nothing if the file does not have the attribute.
  std::optional<std::size_t> offset_of(const char* attribute) const {
    const Json& attributes = json.at("meshes").at(0).at("primitives").at(0).at("attributes");
    if (!attributes.contains(attribute)) return std::nullopt;
    const Json& accessor = json.at("accessors").at(count_of(attributes.at(attribute)));
    if (count_of(accessor.at("count")) != points) {
      throw std::invalid_argument("its attributes differ in number");
    }
    const Json& view = json.at("bufferViews").at(count_of(accessor.at("bufferView")));
    return binary + (view.contains("byteOffset") ? count_of(view.at("byteOffset")) : 0);
  }
};

GlbHead head_of(std::string_view bytes) {
  if (!bytes.starts_with("glTF")) throw std::invalid_argument("it is no binary glTF");
  const std::size_t json_bytes = value_at<std::uint32_t>(bytes, 12);
  if (json_bytes > bytes.size() - std::min(bytes.size(), kHeader)) {
    throw std::invalid_argument("it ends too early");
  }
  GlbHead head;
  head.json = Json::parse(bytes.substr(kHeader, json_bytes));
  head.binary = kHeader + json_bytes + kChunkHeader;
  if (!head.json.contains("meshes")) return head;
  const Json& position = head.json.at("accessors").at(0);
  head.points = count_of(position.at("count"));
  const auto matrix = head.json.at("nodes").at(0).at("matrix").get<std::array<double, 16>>();
  head.step = matrix[0];
  head.low = {matrix[12], -matrix[14], matrix[13]};  // gltf_matrix()
  const auto high = position.at("max").get<std::array<double, 3>>();
  head.high = head.low + head.step * Eigen::Vector3d(high[0], high[1], high[2]);
  const Eigen::Array3d size = head.high - head.low;
  const bool is_plausible = head.step > 0 && head.step <= kMostStep &&
                            (head.low.array().abs() <= kMostDistance).all() && (size >= 0).all() &&
                            (size <= kMostSteps * head.step).all();
  if (!is_plausible) throw std::invalid_argument("its positions are impossible");
  return head;
}

/// Inverse of linear_light().
std::uint8_t channel_of_light(std::uint16_t light) {
  static const auto kLights = [] {
    std::array<std::uint16_t, 256> lights{};
    for (std::size_t i = 0; i < lights.size(); ++i) {
      lights[i] = linear_light(static_cast<std::uint8_t>(i));
    }
    return lights;
  }();
  const auto* const upper = std::lower_bound(kLights.begin(), kLights.end(), light);
  return static_cast<std::uint8_t>(std::min<std::ptrdiff_t>(upper - kLights.begin(), 255));
}

/// Inverse of steps_of(); NaN if it is unknown.
float value_of_steps(std::uint16_t steps, double steps_per_unit) {
  constexpr std::uint16_t kUnknown = 65535;
  if (steps == kUnknown) return std::numeric_limits<float>::quiet_NaN();
  return static_cast<float>(steps / steps_per_unit);
}

/// The first values of an attribute; empty if the file does not have the attribute.
std::string first_values(const GlbBytes& file, const GlbHead& head, const char* attribute,
                         std::size_t stride, std::size_t count) {
  const auto offset = head.offset_of(attribute);
  if (!offset) return "";
  if (*offset > file.size || count > (file.size - *offset) / stride) {
    throw std::invalid_argument("it ends too early");
  }
  std::string values = file.range(*offset, stride * count);
  if (values.size() != stride * count) throw std::invalid_argument("it ends too early");
  return values;
}

/// Frames are stored as float.
std::int32_t frame_of(float number) {
  constexpr float kEnd = 2147483648.0f;
  if (!(std::abs(number) < kEnd)) throw std::invalid_argument("a frame is impossible");
  return static_cast<std::int32_t>(number);
}

void read_sources(const GlbBytes& file, const GlbHead& head, std::vector<ExportPoint>& points) {
  constexpr std::size_t kStride = 4;
  const std::string frame = first_values(file, head, "_FRAME", kStride, points.size()),
                    sight = first_values(file, head, "_SIGHT", kStride, points.size()),
                    source = first_values(file, head, "_SOURCE", kStride, points.size());
  if (frame.empty() || sight.empty() || source.empty()) return;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ExportPoint& point = points[i];
    point.frame = frame_of(value_at<float>(frame, kStride * i));
    point.range = value_of_steps(value_at<std::uint16_t>(sight, kStride * i), 100);
    point.incidence =
        value_of_steps(value_at<std::uint16_t>(sight, kStride * i + 2), 100 / kDegree);
    const auto byte = [&](std::size_t k) {
      return value_at<std::uint8_t>(source, kStride * i + k);
    };
    point.camera = static_cast<std::int8_t>(byte(0));
    point.reason = byte(1) & 0x7f;
    point.interpolated = byte(1) >> 7;
    point.views = byte(2);
    point.spread = byte(3);
  }
}

/// The first points of a file.
std::vector<ExportPoint> first_points(const GlbBytes& file, const GlbHead& head,
                                      std::size_t count) {
  if (count == 0) return {};
  constexpr std::size_t kStride = 8;
  const std::string position = first_values(file, head, "POSITION", kStride, count),
                    color = first_values(file, head, "COLOR_0", kStride, count);
  if (position.empty() || color.empty()) {
    throw std::invalid_argument("it has no positions or no colors");
  }
  std::vector<ExportPoint> points(count);
  const auto three = [](const std::string& values, std::size_t i) {
    std::array<std::uint16_t, 3> of_point{};
    for (std::size_t k = 0; k < 3; ++k) {
      of_point[k] = value_at<std::uint16_t>(values, kStride * i + 2 * k);
    }
    return of_point;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto at = three(position, i), light = three(color, i);
    points[i].position = head.low + head.step * Eigen::Vector3d(at[0], at[1], at[2]);
    points[i].color = {channel_of_light(light[0]), channel_of_light(light[1]),
                       channel_of_light(light[2])};
    points[i].camera = 0;  // unless the file says otherwise
  }
  read_sources(file, head, points);
  return points;
}

/// How many of the first points are a level's.
std::size_t points_of_level(const GlbHead& head, std::size_t level) {
  if (head.points == 0) return 0;
  const Json& mesh = head.json.at("meshes").at(0);
  if (!mesh.contains("extras")) return head.points;
  std::vector<std::size_t> levels;
  for (const Json& count : mesh.at("extras").at(kGlbLevels)) levels.push_back(count_of(count));
  const std::size_t points =
      levels.empty() ? head.points : levels[std::min(level, levels.size() - 1)];
  if (points > head.points) throw std::invalid_argument("its levels have too many points");
  return points;
}

GlbBytes in_memory(std::string_view bytes) {
  return {bytes.size(), [bytes](std::size_t offset, std::size_t count) {
            return std::string(bytes.substr(std::min(offset, bytes.size()), count));
          }};
}

/// What `read` returns; its errors as InputError.
template <class Read>
auto checked(std::string_view where, Read&& read) {
  try {
    return read();
  } catch (const std::exception& error) {
    throw InputError(std::string("the points of the tile cannot be read: ") + error.what(), where,
                     "write the file again");
  }
}

}  // namespace

std::vector<ExportPoint> read_glb(std::string_view bytes, std::string_view where) {
  return checked(where, [&] {
    const GlbHead head = head_of(bytes);
    return first_points(in_memory(bytes), head, head.points);
  });
}

std::vector<ExportPoint> read_glb_level(std::string_view bytes, std::size_t level,
                                        std::string_view where) {
  return checked(where, [&] {
    const GlbHead head = head_of(bytes);
    return first_points(in_memory(bytes), head, points_of_level(head, level));
  });
}

std::vector<ExportPoint> read_glb_level(const InputFile& file, std::size_t level) {
  return checked(file.path().string(), [&] {
    const GlbHead head = head_of(file.beginning(kGlbHead));
    const auto range = [&](std::size_t offset, std::size_t count) {
      return file.range(offset, count);
    };
    return first_points({file.size(), range}, head, points_of_level(head, level));
  });
}

Eigen::AlignedBox3d glb_box(std::string_view bytes, std::string_view where) {
  return checked(where, [&] {
    const GlbHead head = head_of(bytes);
    return head.points == 0 ? Eigen::AlignedBox3d() : Eigen::AlignedBox3d(head.low, head.high);
  });
}

}  // namespace fovea
