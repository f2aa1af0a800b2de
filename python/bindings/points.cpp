// Columns of points as NumPy arrays that share the C++ memory.
#include "python/bindings/points.h"

#include <pybind11/stl.h>

#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/columns.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

py::array color_array(const PointCloud& cloud, const ColorDisplay& display) {
  auto colors = std::make_shared<std::vector<Rgb>>();
  colors->reserve(cloud.size());
  for (const LogColor& color : cloud.color) colors->push_back(display(color));
  return shared_array(py::dtype::of<std::uint8_t>(), {py::ssize_t(colors->size()), 3},
                      colors->data(), colors);
}

}  // namespace

void bind_points(py::module_& module) {
  py::class_<Points> points(
      module, "Points",
      "N points of a map as columns: read-only arrays, which live on after this "
      "object and the map. None but color is a copy.");
  const auto add = [&](const char* name, auto column, const char* doc) {
    points.def_property_readonly(
        name, [column](const Points& self) { return column_array(self.cloud, column); }, doc);
  };
  add("position", &PointCloud::position, "N x 3 float32, m, relative to origin.");
  add("camera", &PointCloud::camera, "N int8: the camera that coloured the point, or -1.");
  add("frame", &PointCloud::frame, "N int32: index of the frame that the point comes from.");
  add("range", &PointCloud::range, "N float32, m, from the sensor that measured or saw the point.");
  add("incidence", &PointCloud::incidence,
      "N float32, rad, between view ray and normal; NaN where unknown.");
  add("interpolated", &PointCloud::interpolated, "N uint8: 1 if made by upsampling.");
  add("views", &PointCloud::views, "N uint8: images that gave the colour; 255: or more.");
  add("spread", &PointCloud::spread, "N uint8: RMS of the images' differences, grey values.");
  add("weight", &PointCloud::weight, "N uint16: sum of the images' weights.");
  add("reason", &PointCloud::reason, "N uint8: why the point is in the map (docs/map-format.md).");
  points
      .def_property_readonly(
          "intensity",
          [](const Points& self) { return optional_column(self.cloud, &PointCloud::intensity); },
          "N float32, 0-1, or None in a map without.")
      .def_property_readonly(
          "color", [](const Points& self) { return color_array(*self.cloud, *self.display); },
          "N x 3 uint8, RGB in the exposure of exports; of meaning where camera is not -1.")
      .def_property_readonly(
          "origin",
          [](const Points& self) { return py::array_t<double>(3, self.cloud->origin.data()); },
          "3 float64, m: what positions are relative to, in their frame.")
      .def("__len__", [](const Points& self) { return self.cloud->size(); });
}

}  // namespace fovea::python
