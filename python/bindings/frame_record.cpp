// What the map keeps of a frame.
#include "fovea/map/frame_record.h"

#include <pybind11/stl.h>

#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"

namespace fovea::python {
namespace py = pybind11;

namespace {

/// One of the twists that its sweep was compensated by.
std::optional<py::array_t<double>> twist_array(const FrameRecord& record,
                                               Twist SweepMotion::* twist) {
  if (!record.motion) return std::nullopt;
  return py::array_t<double>(6, ((*record.motion).*twist).data());
}

}  // namespace

void bind_frame_record(py::module_& module) {
  py::class_<ViewRecord>(module, "ViewRecord", "The image of one camera in a frame.")
      .def_readonly("camera", &ViewRecord::camera, "Number of the camera.")
      .def_readonly("stamp", &ViewRecord::stamp, "When the image was taken, ns, or None.")
      .def_property_readonly(
          "log2_gain",
          [](const ViewRecord& view) -> std::optional<py::array_t<double>> {
            if (!view.log2_gain) return std::nullopt;
            return py::array_t<double>(3, view.log2_gain->data());
          },
          "Base-2 logarithms of the gains for red, green and blue (image = map * gain), or None.");

  py::class_<FrameRecord>(module, "FrameRecord", "What a map keeps of a frame of its drive.")
      .def_readonly("index", &FrameRecord::index)
      .def_readonly("stamp", &FrameRecord::stamp, "ns, or None.")
      .def_property_readonly(
          "status", [](const FrameRecord& record) { return to_string(record.status); },
          "'mapped', 'held-out' or 'skipped'.")
      .def_readonly("note", &FrameRecord::note)
      .def_property_readonly(
          "T_local_lidar",
          [](const FrameRecord& record) { return motion_array(record.T_local_lidar); },
          "Refined pose, 4x4; of a skipped frame between its neighbours'.")
      .def_property_readonly(
          "T_local_lidar_navigation",
          [](const FrameRecord& record) -> std::optional<py::array_t<double>> {
            if (!record.T_local_lidar_navigation) return std::nullopt;
            return motion_array(*record.T_local_lidar_navigation);
          },
          "GPS/INS's pose, 4x4, or None.")
      .def_property_readonly(
          "T_odom_lidar",
          [](const FrameRecord& record) { return motion_array(record.T_odom_lidar); },
          "Pose in the frame that never jumps, 4x4.")
      .def_readonly("submap", &FrameRecord::submap, "Its number; -1 of a skipped frame.")
      .def_property_readonly(
          "velocity",
          [](const FrameRecord& record) { return twist_array(record, &SweepMotion::velocity); },
          "Twist of the LiDAR in its own frame, rotation first (rad/s, m/s), 6 numbers, or None.")
      .def_property_readonly(
          "acceleration",
          [](const FrameRecord& record) { return twist_array(record, &SweepMotion::acceleration); },
          "Change of the velocity (rad/s^2, m/s^2), 6 numbers, or None.")
      .def_readonly("views", &FrameRecord::views, "A ViewRecord an image, by camera.")
      .def_readonly("figures", &FrameRecord::figures, "Figures of the stages by name.")
      .def_readonly("milliseconds", &FrameRecord::milliseconds, "Wall time of the stages by name.")
      .def("__repr__", [](const FrameRecord& record) {
        return "<fovea.FrameRecord " + std::to_string(record.index) + " " +
               to_string(record.status) + ">";
      });
}

}  // namespace fovea::python
