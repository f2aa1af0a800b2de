#include "fovea/simulation/option_checks.h"

#include <fmt/format.h>

#include "fovea/core/angle.h"
#include "fovea/errors.h"

namespace fovea {

void reject(std::string_view what, std::string_view key, std::string_view remedy) {
  throw ConfigError(what, key, remedy);
}

void check_range(std::string_view key, double value, double low, double high,
                 std::string_view unit) {
  if (value >= low && value <= high) return;
  const std::string_view space = unit.empty() ? "" : " ";
  reject(fmt::format("{:.6g}{}{} is out of range", value, space, unit), key,
         fmt::format("give {:g} to {:g}{}{}", low, high, space, unit));
}

void check_degrees(std::string_view key, double radians, double low, double high) {
  check_range(key, radians / kDegree, low, high, "degrees");
}

}  // namespace fovea
