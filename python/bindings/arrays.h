// C++ memory and matrices as NumPy arrays.
#pragma once

#include <pybind11/numpy.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fovea/rigid_motion.h"

namespace fovea::python {

/// An array over `data`, which `owner` keeps alive for as long as the array or a view of it lives.
/// Read-only: others may look at the same memory.
pybind11::array shared_array(const pybind11::dtype& type, std::vector<pybind11::ssize_t> shape,
                             const void* data, std::shared_ptr<const void> owner);

/// A copy, which may be written to.
template <int Rows, int Columns>
pybind11::array_t<double> matrix_array(const Eigen::Matrix<double, Rows, Columns>& matrix) {
  pybind11::array_t<double> array({Rows, Columns});
  for (int row = 0; row < Rows; ++row) {
    for (int column = 0; column < Columns; ++column) {
      array.mutable_at(row, column) = matrix(row, column);
    }
  }
  return array;
}

/// 4x4.
pybind11::array_t<double> motion_array(const RigidMotion& T);
/// N x 4 x 4.
pybind11::array_t<double> motion_arrays(const std::vector<RigidMotion>& motions);
/// std::invalid_argument unless 4x4, with the last row 0 0 0 1, and a pose (checked_pose()).
RigidMotion motion_from(const pybind11::array_t<double>& array);

}  // namespace fovea::python
