// Choices of points and tables of them, as arrays of NumPy have them.
#pragma once

#include <pybind11/numpy.h>

#include "python/bindings/points.h"

namespace fovea::python {

/// `points[key]`: a slice shares the memory, a mask or an array of indices copies the points, and
/// an index gives one row of structured_array(). IndexError and TypeError as of arrays.
pybind11::object choose_points(const pybind11::object& points, const pybind11::object& key);

/// A copy of all columns as fields of one array.
pybind11::array structured_array(const pybind11::object& points);

}  // namespace fovea::python
