#include "python/bindings/stage_arrays.h"

#include <cmath>
#include <stdexcept>

namespace fovea::python {
namespace py = pybind11;
namespace {

constexpr float kMaxCoordinate = 1e5f;  // m; cells of grids are counted by int

}  // namespace

PointCloud checked_cloud(const Floats& points) {
  PointCloud cloud = cloud_from(points, std::nullopt, std::nullopt, std::nullopt);
  for (const Eigen::Vector3f& p : cloud.position) {
    if (!(p.array().abs() <= kMaxCoordinate).all()) {
      throw std::invalid_argument("a point is not finite, or beyond 100 km");
    }
  }
  return cloud;
}

std::vector<std::uint8_t> mask_from(const Numbers<bool>& mask, std::size_t points) {
  if (mask.ndim() != 1 || static_cast<std::size_t>(mask.size()) != points) {
    throw std::invalid_argument("a mask needs one bool for each point");
  }
  return {mask.data(), mask.data() + mask.size()};
}

void require_range(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  const auto text = [](double number) { return py::str(py::float_(number)).cast<std::string>(); };
  throw std::invalid_argument(std::string(name) + " is " + text(value) + ", not " + text(low) +
                              " to " + text(high));
}

std::size_t choice_of(const char* name, const std::string& word,
                      const std::vector<std::string>& choices) {
  const auto found = std::find(choices.begin(), choices.end(), word);
  if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  std::string text;
  for (const std::string& choice : choices) text += (text.empty() ? "'" : ", '") + choice + "'";
  throw std::invalid_argument(std::string(name) + " is '" + word + "', not one of " + text);
}

}  // namespace fovea::python
