#include "python/bindings/arrays.h"

#include <stdexcept>

#include "fovea/geometry/pose_file.h"

namespace fovea::python {
namespace py = pybind11;

py::array shared_array(const py::dtype& type, std::vector<py::ssize_t> shape, const void* data,
                       std::shared_ptr<const void> owner) {
  using Owner = std::shared_ptr<const void>;
  auto held = std::make_unique<Owner>(std::move(owner));
  const py::capsule base(held.get(), [](void* kept) { delete static_cast<Owner*>(kept); });
  static_cast<void>(held.release());  // the capsule has it now
  py::array array(type, std::move(shape), data, base);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array_t<double> motion_array(const RigidMotion& T) { return matrix_array<4, 4>(T.matrix()); }

py::array_t<double> motion_arrays(const std::vector<RigidMotion>& motions) {
  py::array_t<double> array(
      {static_cast<py::ssize_t>(motions.size()), py::ssize_t{4}, py::ssize_t{4}});
  for (std::size_t i = 0; i < motions.size(); ++i) {
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) {
        array.mutable_at(i, row, column) = motions[i].matrix()(row, column);
      }
    }
  }
  return array;
}

RigidMotion motion_from(const py::array_t<double>& array) {
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4) {
    throw std::invalid_argument("a rigid motion is an array of shape (4, 4)");
  }
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) matrix(row, column) = array.at(row, column);
  }
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw std::invalid_argument("the last row of a rigid motion is 0 0 0 1");
  }
  return checked_pose(matrix.topRows<3>());
}

}  // namespace fovea::python
