// Columns of points as NumPy arrays that share the C++ memory.
#include "python/bindings/points.h"

#include <pybind11/stl.h>

#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/columns.h"
#include "python/bindings/point_choice.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

/// The rows of an array over a whole column, not copied.
py::array rows_of(const py::array& column, const PointRows& rows) {
  if (rows.step == 1 && rows.count == static_cast<std::size_t>(column.shape(0))) return column;
  const py::ssize_t end = rows.begin + static_cast<py::ssize_t>(rows.count) * rows.step;
  // A slice that runs backwards to the first row has no number as its end.
  const auto stop = end < 0 ? std::nullopt : std::optional<py::ssize_t>(end);
  if (rows.count == 0) return column.attr("__getitem__")(py::slice(0, 0, 1));
  return column.attr("__getitem__")(py::slice(std::optional<py::ssize_t>(rows.begin), stop,
                                              std::optional<py::ssize_t>(rows.step)));
}

py::array color_array(const Points& points) {
  auto colors = std::make_shared<std::vector<Rgb>>();
  {
    const py::gil_scoped_release others_run;
    colors->reserve(points.rows.count);
    for (std::size_t i = 0; i < points.rows.count; ++i) {
      colors->push_back((*points.display)(points.cloud->color[points.rows[i]]));
    }
  }
  return shared_array(py::dtype::of<std::uint8_t>(), {py::ssize_t(colors->size()), 3},
                      colors->data(), colors);
}

py::array_t<double> xyz_array(const Points& points) {
  py::array_t<double> xyz({static_cast<py::ssize_t>(points.rows.count), py::ssize_t{3}});
  double* next = xyz.mutable_data();
  const py::gil_scoped_release others_run;
  for (std::size_t i = 0; i < points.rows.count; ++i) {
    const Eigen::Vector3d p =
        points.cloud->origin + points.cloud->position[points.rows[i]].cast<double>();
    next = std::copy_n(p.data(), 3, next);
  }
  return xyz;
}

py::object as_array(const py::object& points, const py::object& dtype, const py::object& copy) {
  if (!copy.is_none() && !py::cast<bool>(copy)) {
    throw py::value_error("an array of all columns is a copy; the columns themselves are not");
  }
  const py::array table = structured_array(points);
  return dtype.is_none() ? py::object(table) : table.attr("astype")(dtype);
}

void bind_choices(py::class_<Points>& points) {
  points.def("__len__", [](const Points& self) { return self.rows.count; })
      .def("__getitem__", &choose_points, py::arg("key"),
           "A slice gives Points that share the memory; a mask (N bool) or an array of indices "
           "gives copied Points; an index gives one row of to_structured().")
      .def("__repr__",
           [](const Points& self) {
             return "<fovea.Points: " + std::to_string(self.rows.count) + " points>";
           })
      .def("to_structured", &structured_array,
           "N rows with a field for each column, of the column's name and type: a copy. Positions "
           "are relative to origin, as in the column.")
      .def("__array__", &as_array, py::arg("dtype") = py::none(), py::arg("copy") = py::none(),
           "to_structured(), for np.asarray(points).");
}

}  // namespace

void bind_points(py::module_& module) {
  py::class_<Points> points(
      module, "Points",
      "N points of a map as columns: read-only arrays, which live on after this "
      "object and the map. None but color and xyz is a copy.");
  const auto add = [&](const char* name, auto column, const char* doc) {
    points.def_property_readonly(
        name,
        [column](const Points& self) {
          return rows_of(column_array(self.cloud, column), self.rows);
        },
        doc);
  };
  add("position", &PointCloud::position, "N x 3 float32, m, relative to origin.");
  add("camera", &PointCloud::camera, "N int8: the camera that colored the point, or -1.");
  add("frame", &PointCloud::frame, "N int32: index of the frame that the point comes from.");
  add("range", &PointCloud::range, "N float32, m, from the sensor that measured or saw the point.");
  add("incidence", &PointCloud::incidence,
      "N float32, rad, between view ray and normal; NaN where unknown.");
  add("interpolated", &PointCloud::interpolated, "N uint8: 1 if made by upsampling.");
  add("views", &PointCloud::views, "N uint8: images that gave the color; 255: or more.");
  add("spread", &PointCloud::spread, "N uint8: RMS of the images' differences, gray values.");
  add("weight", &PointCloud::weight, "N uint16: sum of the images' weights.");
  add("reason", &PointCloud::reason, "N uint8: why the point is in the map (docs/map-format.md).");
  points
      .def_property_readonly(
          "intensity",
          [](const Points& self) -> std::optional<py::array> {
            const auto column = optional_column(self.cloud, &PointCloud::intensity);
            if (!column) return std::nullopt;
            return rows_of(*column, self.rows);
          },
          "N float32, 0-1, or None in a map without.")
      .def_property_readonly("color", &color_array,
                             "N x 3 uint8, RGB in the exposure of exports; of meaning where camera "
                             "is not -1.")
      .def_property_readonly(
          "origin",
          [](const Points& self) { return py::array_t<double>(3, self.cloud->origin.data()); },
          "3 float64, m: what positions are relative to, in their frame.")
      .def_property_readonly("xyz", &xyz_array,
                             "N x 3 float64, m: origin + position, a copy that can be written.");
  bind_choices(points);
}

}  // namespace fovea::python
