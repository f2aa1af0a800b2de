// fovea.Frame: arrays over the memory of a frame.
#include <pybind11/stl.h>

#include "python/bindings/bindings.h"
#include "python/bindings/columns.h"
#include "python/bindings/drive.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

/// The scan as a cloud that keeps its frame alive.
std::shared_ptr<const PointCloud> scan_of(const FrameOfDrive& self) {
  const auto owner = std::make_shared<const DriveFrame>(self.frame);
  return {owner, &owner->scan()};
}

/// Height x width x channels; nothing for an image that is missing.
std::vector<std::optional<py::array>> images_of(const FrameOfDrive& self) {
  const auto owner = std::make_shared<const DriveFrame>(self.frame);
  std::vector<std::optional<py::array>> arrays;
  for (const Image& image : owner->images()) {
    if (image.empty()) {
      arrays.emplace_back();
    } else {
      arrays.emplace_back(shared_array(py::dtype::of<std::uint8_t>(),
                                       {image.height, image.width, image.channels},
                                       image.data.data(), owner));
    }
  }
  return arrays;
}

}  // namespace

void bind_frame(py::module_& module) {
  py::class_<FrameOfDrive> frame(
      module, "Frame", "A LiDAR sweep with its images. Arrays are read-only and not copied.");
  const auto add_column = [&](const char* name, auto column, const char* doc) {
    frame.def_property_readonly(
        name, [column](const FrameOfDrive& self) { return optional_column(scan_of(self), column); },
        doc);
  };
  frame.def_property_readonly("index", [](const FrameOfDrive& self) { return self.frame.index(); })
      .def_property_readonly(
          "stamp", [](const FrameOfDrive& self) { return self.frame.stamp(); }, "ns.")
      .def_property_readonly(
          "points",
          [](const FrameOfDrive& self) {
            return column_array(scan_of(self), &PointCloud::position);
          },
          "N x 3 float32, m, LiDAR frame, as measured: not yet motion "
          "compensated.")
      .def_property_readonly(
          "dropped_points", [](const FrameOfDrive& self) { return self.frame.points_dropped(); },
          "Points of the scan that are not finite or out of reach, and not in "
          "`points`.")
      .def_property_readonly("images", &images_of,
                             "A height x width x channels uint8 array a camera of the drive, RGB "
                             "or grey, or None where it is missing.")
      .def_property_readonly(
          "missing_images", [](const FrameOfDrive& self) { return self.frame.missing_images(); },
          "Why images are None, a line each.");
  add_column("intensity", &PointCloud::intensity, "N float32, 0-1, or None.");
  add_column("time", &PointCloud::time, "N float32, s from the stamp, or None.");
  add_column("sensor", &PointCloud::sensor,
             "N uint16, number of the LiDAR, or None for a drive with one.");
}

}  // namespace fovea::python
