// Scans and images that Python programs give.
#pragma once

#include <cstdint>
#include <optional>

#include "fovea/image.h"
#include "fovea/point_cloud.h"
#include "python/bindings/arrays.h"

namespace fovea::python {

template <class Number>
using Numbers = pybind11::array_t<Number, pybind11::array::c_style | pybind11::array::forcecast>;
using Floats = Numbers<float>;
using Doubles = Numbers<double>;
using Rings = Numbers<std::int64_t>;

/// A scan of columns.
/// @param points  N x 3
/// @throws std::invalid_argument  for other shapes, and for rings out of range
PointCloud cloud_from(const Floats& points, const std::optional<Floats>& intensity,
                      const std::optional<Floats>& times, const std::optional<Rings>& rings);

/// An image of an array of uint8, height x width or height x width x 3.
/// @throws std::invalid_argument  for other arrays
Image image_from(const pybind11::object& pixels);

}  // namespace fovea::python
