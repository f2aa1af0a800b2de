#include "python/bindings/sensor_arrays.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace fovea::python {
namespace py = pybind11;

PointCloud cloud_from(const Floats& points, const std::optional<Floats>& intensity,
                      const std::optional<Floats>& times, const std::optional<Rings>& rings) {
  if (points.ndim() != 2 || points.shape(1) != 3) {
    throw std::invalid_argument("points are not N x 3");
  }
  PointCloud cloud;
  for (py::ssize_t i = 0; i < points.shape(0); ++i) {
    cloud.position.emplace_back(points.at(i, 0), points.at(i, 1), points.at(i, 2));
  }
  const auto copy = [](const auto& from, auto& to) {
    if (!from) return;
    if (from->ndim() != 1) throw std::invalid_argument("a column is not of one dimension");
    to.assign(from->data(), from->data() + from->size());
  };
  copy(intensity, cloud.intensity);
  copy(times, cloud.time);
  std::vector<std::int64_t> numbers;
  copy(rings, numbers);
  cloud.ring.reserve(numbers.size());
  for (const std::int64_t number : numbers) {
    if (number < 0 || number > 0xffff) throw std::invalid_argument("a ring is not 0 to 65535");
    cloud.ring.push_back(static_cast<std::uint16_t>(number));
  }
  return cloud;
}

Image image_from(const py::object& image) {
  const auto pixels = py::array_t<std::uint8_t, py::array::c_style>::ensure(image);
  const bool is_gray = pixels && pixels.ndim() == 2;
  if (!pixels ||
      !(is_gray || (pixels.ndim() == 3 && (pixels.shape(2) == 1 || pixels.shape(2) == 3)))) {
    throw std::invalid_argument("an image is no uint8 array, height x width or height x width x 3");
  }
  Image result(int(pixels.shape(1)), int(pixels.shape(0)), is_gray ? 1 : int(pixels.shape(2)));
  std::copy_n(pixels.data(), result.data.size(), result.data.begin());
  return result;
}

}  // namespace fovea::python
