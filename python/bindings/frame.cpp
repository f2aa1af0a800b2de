// fovea.Frame: arrays over the memory of a frame.
#include <pybind11/stl.h>

#include "python/bindings/bindings.h"
#include "python/bindings/columns.h"
#include "python/bindings/drive.h"
#include "python/bindings/stage_arrays.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

/// The scan as a cloud that keeps its frame alive.
std::shared_ptr<const PointCloud> scan_of(const FrameOfDrive& self) {
  const auto owner = std::make_shared<const DriveFrame>(self.frame);
  return {owner, &owner->scan()};
}

/// fovea._results.Images: by number of the camera, height x width x channels.
py::object images_of(const FrameOfDrive& self) {
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
  std::vector<int> numbers;
  for (const Camera& camera : self.drive.cameras()) numbers.push_back(camera.index);
  return result_class("Images")(numbers, arrays);
}

/// The pose by navigation at the stamp.
std::optional<py::array_t<double>> pose_of(const FrameOfDrive& self) {
  const std::optional<Trajectory>& navigation = self.drive.navigation();
  const auto T_local_lidar = navigation ? navigation->at(self.frame.stamp()) : std::nullopt;
  if (!T_local_lidar) return std::nullopt;
  return motion_array(*T_local_lidar);
}

/// How the LiDAR moves at the stamp, as far as it is known by then.
std::optional<SweepMotion> motion_of(const FrameOfDrive& self) {
  const std::optional<Trajectory>& navigation = self.drive.navigation();
  return navigation ? navigation->motion(self.frame.stamp(), self.frame.stamp()) : std::nullopt;
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
          "N x 3 float32, m, LiDAR frame, as measured: not yet motion compensated.")
      .def_property_readonly(
          "dropped_points", [](const FrameOfDrive& self) { return self.frame.points_dropped(); },
          "Points of the scan that are not finite or out of reach, and not in `points`.")
      .def_property_readonly(
          "images", &images_of,
          "By number of the camera: height x width x channels uint8, RGB or gray. "
          "Images that are missing are left out.")
      .def_property_readonly("T_local_lidar", &pose_of,
                             "4x4, pose at the stamp by the drive's navigation; None without it.")
      .def_property_readonly(
          "motion", &motion_of,
          "SweepMotion of the LiDAR at the stamp by the drive's navigation; None "
          "without it.")
      .def_property_readonly(
          "missing_images", [](const FrameOfDrive& self) { return self.frame.missing_images(); },
          "Why images are missing, a line each.")
      .def("__repr__", [](const FrameOfDrive& self) {
        return "<fovea.Frame " + std::to_string(self.frame.index()) + ", " +
               std::to_string(self.frame.scan().size()) + " points, " +
               std::to_string(self.frame.images().size()) + " cameras>";
      });
  add_column("intensity", &PointCloud::intensity, "N float32, 0-1, or None.");
  add_column("time", &PointCloud::time, "N float32, s from the stamp, or None.");
  add_column("sensor", &PointCloud::sensor,
             "N uint16, number of the LiDAR, or None for a drive with one.");
}

}  // namespace fovea::python
