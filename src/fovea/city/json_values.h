// Values of the JSON files of a city: of fovea align, of fovea adjust, and the manifest.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "fovea/geometry/geodesy.h"
#include "fovea/rigid_motion.h"

namespace fovea {

using Json = nlohmann::ordered_json;

/// {"translation": [x, y, z] (m), "rotation": [9 numbers, row by row]}; reads back to the bit, so
/// that fixed poses stay what they are.
Json json_of(const RigidMotion& T);
/// std::invalid_argument if it is no rigid motion.
RigidMotion motion_of(const Json& json);

/// {"latitude_deg", "longitude_deg", "height_m"}.
Json json_of(const GeodeticPoint& point);
/// std::invalid_argument if the point is not on the earth.
GeodeticPoint geodetic_point_of(const Json& json);

template <int N>
Json json_of(const Eigen::Matrix<double, N, 1>& vector) {
  return std::vector<double>(vector.data(), vector.data() + N);
}
/// std::invalid_argument unless it is N finite numbers.
template <int N>
Eigen::Matrix<double, N, 1> vector_of(const Json& json) {
  const auto numbers = json.get<std::vector<double>>();
  if (numbers.size() == N) {
    const Eigen::Matrix<double, N, 1> vector(numbers.data());
    if (vector.allFinite()) return vector;
  }
  throw std::invalid_argument(std::to_string(N) + " numbers expected");
}

/// std::invalid_argument unless it is a whole number, zero or more.
std::size_t count_of(const Json& json);
/// The list under a key. std::invalid_argument if it is something else.
const Json& list_at(const Json& json, const char* key);

/// Parses a file and hands it to `read`.
/// @param noun    what it is: "pair of maps"
/// @param remedy  what to do if it is damaged
/// @throws InputError  if the file cannot be read, or `read` throws
void read_json(const std::filesystem::path& path, const char* noun, const char* remedy,
               const std::function<void(const Json&)>& read);
/// @throws OutputError  as OutputFile
void write_json(const Json& json, const std::filesystem::path& path, bool force);

}  // namespace fovea
