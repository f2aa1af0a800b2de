#include "python/bindings/point_choice.h"

#include <array>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace fovea::python {
namespace py = pybind11;
namespace {

/// In the order of docs/python.md. A map may lack intensity.
constexpr std::array kColumns = {"position", "color",     "camera",       "frame",
                                 "range",    "incidence", "interpolated", "views",
                                 "spread",   "weight",    "reason",       "intensity"};

[[noreturn]] void refuse_index(std::int64_t index, std::size_t count) {
  throw py::index_error("index " + std::to_string(index) + " is out of range of " +
                        std::to_string(count) + " points");
}

Points slice_of(const Points& points, const py::slice& slice) {
  py::ssize_t begin = 0, stop = 0, step = 0, count = 0;
  if (!slice.compute(static_cast<py::ssize_t>(points.rows.count), &begin, &stop, &step, &count)) {
    throw py::error_already_set();
  }
  Points chosen = points;
  chosen.rows.begin += begin * points.rows.step;
  chosen.rows.step *= step;
  chosen.rows.count = static_cast<std::size_t>(count);
  return chosen;
}

using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// The points at indices, which count from the end if they are negative.
Points points_at(const Points& points, const Indices& indices) {
  if (points.cloud->size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::length_error("too many points to choose from: read them by tile or by box");
  }
  const auto count = static_cast<std::int64_t>(points.rows.count);
  const std::int64_t* const begin = indices.data();
  const auto wanted = static_cast<std::size_t>(indices.size());
  const py::gil_scoped_release others_run;
  std::vector<std::uint32_t> chosen(wanted);
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::int64_t index = begin[i] < 0 ? begin[i] + count : begin[i];
    if (index < 0 || index >= count) refuse_index(begin[i], points.rows.count);
    chosen[i] = static_cast<std::uint32_t>(points.rows[static_cast<std::size_t>(index)]);
  }
  return {points.cloud->select(chosen), points.display};
}

Points array_choice(const Points& points, const py::array& key) {
  const char kind = key.dtype().kind();
  const bool is_empty = key.size() == 0;
  if (key.ndim() != 1 || (kind != 'b' && kind != 'i' && kind != 'u' && !is_empty)) {
    throw py::type_error("points are chosen by an index, a slice, a mask or an array of indices");
  }
  if (kind != 'b') return points_at(points, Indices(key));
  if (key.size() != static_cast<py::ssize_t>(points.rows.count)) {
    throw py::index_error("the mask has " + std::to_string(key.size()) + " entries for " +
                          std::to_string(points.rows.count) + " points");
  }
  return points_at(points, Indices(key.attr("nonzero")().attr("__getitem__")(0)));
}

py::object row_at(const py::object& points, const py::object& key) {
  const auto& all = py::cast<const Points&>(points);
  const auto count = static_cast<py::ssize_t>(all.rows.count);
  const py::ssize_t given = PyNumber_AsSsize_t(key.ptr(), PyExc_IndexError);
  if (given == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  const py::ssize_t index = given < 0 ? given + count : given;
  if (index < 0 || index >= count) refuse_index(given, all.rows.count);
  const py::object one = py::cast(slice_of(all, py::slice(index, index + 1, 1)));
  return structured_array(one).attr("__getitem__")(0);
}

}  // namespace

py::object choose_points(const py::object& points, const py::object& key) {
  const auto& all = py::cast<const Points&>(points);
  if (py::isinstance<py::slice>(key)) return py::cast(slice_of(all, py::cast<py::slice>(key)));
  if (PyIndex_Check(key.ptr()) != 0 && !PyBool_Check(key.ptr()) &&
      !py::isinstance<py::array>(key)) {
    return row_at(points, key);
  }
  if (!py::isinstance<py::array>(key) && !py::isinstance<py::list>(key)) {
    throw py::type_error("points are chosen by an index, a slice, a mask or an array of indices");
  }
  return py::cast(array_choice(all, py::module_::import("numpy").attr("asarray")(key)));
}

py::array structured_array(const py::object& points) {
  const auto count = py::len(points);
  py::list fields, columns;
  for (const char* name : kColumns) {
    const py::object column = points.attr(name);
    if (column.is_none()) continue;
    const auto array = py::cast<py::array>(column);
    const py::tuple shape = array.ndim() == 2 ? py::make_tuple(array.shape(1)) : py::tuple();
    fields.append(py::make_tuple(name, array.dtype(), shape));
    columns.append(py::make_tuple(name, array));
  }
  py::array table = py::module_::import("numpy").attr("empty")(count, fields);
  for (const py::handle column : columns) {
    table.attr("__setitem__")(column.attr("__getitem__")(0), column.attr("__getitem__")(1));
  }
  return table;
}

}  // namespace fovea::python
