#include "fovea/city/json_values.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "fovea/core/input_file.h"
#include "fovea/core/nesting.h"
#include "fovea/core/output_file.h"
#include "fovea/errors.h"

namespace fovea {

Json json_of(const RigidMotion& T) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const RowMajor R = T.linear();
  return {{"translation", json_of<3>(T.translation())},
          {"rotation", std::vector<double>(R.data(), R.data() + R.size())}};
}

RigidMotion motion_of(const Json& json) {
  constexpr double kTolerance = 1e-9;
  RigidMotion T = RigidMotion::Identity();
  T.linear() = vector_of<9>(json.at("rotation")).reshaped<Eigen::RowMajor>(3, 3);
  if (!is_rotation(T.linear(), kTolerance)) throw std::invalid_argument("a pose has no rotation");
  T.translation() = vector_of<3>(json.at("translation"));
  return T;
}

Json json_of(const GeodeticPoint& point) {
  return {{"latitude_deg", point.latitude},
          {"longitude_deg", point.longitude},
          {"height_m", point.altitude}};
}

GeodeticPoint geodetic_point_of(const Json& json) {
  const GeodeticPoint point{json.at("latitude_deg").get<double>(),
                            json.at("longitude_deg").get<double>(),
                            json.at("height_m").get<double>()};
  const bool is_on_earth = std::abs(point.latitude) < 90 && std::abs(point.longitude) <= 180 &&
                           std::abs(point.altitude) < 1e5;
  if (!is_on_earth) throw std::invalid_argument("the origin is no place on the earth");
  return point;
}

std::size_t count_of(const Json& json) {
  if (!json.is_number_unsigned()) throw std::invalid_argument(json.dump() + " is no count");
  return json.get<std::size_t>();
}

const Json& list_at(const Json& json, const char* key) {
  const Json& list = json.at(key);
  if (!list.is_array()) throw std::invalid_argument(std::string(key) + " is no list");
  return list;
}

void read_json(const std::filesystem::path& path, const char* noun, const char* remedy,
               const std::function<void(const Json&)>& read) {
  const std::vector<std::uint8_t> bytes = InputFile(path, kDescriptionFile).bytes();
  if (nesting_depth({reinterpret_cast<const char*>(bytes.data()), bytes.size()}) > kMaxNesting) {
    throw InputError(fmt::format("the {} is nested too deep", noun), path.string(), remedy);
  }
  try {
    read(Json::parse(bytes));
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("the {} is damaged ({})", noun, error.what()), path.string(),
                     remedy);
  }
}

void write_json(const Json& json, const std::filesystem::path& path, bool force) {
  OutputFile output(path, force);
  output.stream() << json.dump(1, ' ', false, Json::error_handler_t::replace) << "\n";
  output.commit();
}

}  // namespace fovea
