// What the map keeps of a frame.
#include <pybind11/stl.h>

#include "fovea/map.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"

namespace fovea::python {
namespace py = pybind11;

namespace {

/// One of the twists that its sweep was compensated by.
std::optional<py::array_t<double>> twist_array(const MappedFrame& record,
                                               Twist SweepMotion::* twist) {
  if (!record.motion) return std::nullopt;
  return py::array_t<double>(6, ((*record.motion).*twist).data());
}

}  // namespace

void bind_frame_record(py::module_& module) {
  py::class_<MappedView>(module, "ViewRecord", "The image of one camera in a frame.")
      .def_readonly("camera", &MappedView::camera, "Number of the camera.")
      .def_readonly("stamp", &MappedView::stamp, "When the image was taken, ns, or None.")
      .def_property_readonly(
          "log2_gain",
          [](const MappedView& view) -> std::optional<py::array_t<double>> {
            if (!view.log2_gain) return std::nullopt;
            return py::array_t<double>(3, view.log2_gain->data());
          },
          "Base-2 logarithms of the gains for red, green and blue (image = map * gain), or None.");

  py::class_<MappedFrame>(module, "FrameRecord", "What a map keeps of a frame of its drive.")
      .def_readonly("index", &MappedFrame::index)
      .def_readonly("stamp", &MappedFrame::stamp, "ns, or None.")
      .def_property_readonly(
          "status", [](const MappedFrame& record) { return to_string(record.status); },
          "'mapped', 'held-out' or 'skipped'.")
      .def_readonly("note", &MappedFrame::note)
      .def_property_readonly(
          "T_local_lidar",
          [](const MappedFrame& record) { return motion_array(record.T_local_lidar); },
          "Refined pose, 4x4; of a skipped frame between its neighbours'.")
      .def_property_readonly(
          "T_local_lidar_navigation",
          [](const MappedFrame& record) -> std::optional<py::array_t<double>> {
            if (!record.T_local_lidar_navigation) return std::nullopt;
            return motion_array(*record.T_local_lidar_navigation);
          },
          "GPS/INS's pose, 4x4, or None.")
      .def_property_readonly(
          "T_odom_lidar",
          [](const MappedFrame& record) { return motion_array(record.T_odom_lidar); },
          "Pose in the frame that never jumps, 4x4.")
      .def_readonly("submap", &MappedFrame::submap, "Its number; -1 of a skipped frame.")
      .def_property_readonly(
          "velocity",
          [](const MappedFrame& record) { return twist_array(record, &SweepMotion::velocity); },
          "Twist of the LiDAR in its own frame, rotation first (rad/s, m/s), 6 numbers, or None.")
      .def_property_readonly(
          "acceleration",
          [](const MappedFrame& record) { return twist_array(record, &SweepMotion::acceleration); },
          "Change of the velocity (rad/s^2, m/s^2), 6 numbers, or None.")
      .def_readonly("views", &MappedFrame::views, "A ViewRecord an image, by camera.")
      .def_readonly("figures", &MappedFrame::figures, "Figures of the stages by name.")
      .def_readonly("milliseconds", &MappedFrame::milliseconds, "Wall time of the stages by name.")
      .def("__repr__", [](const MappedFrame& record) {
        return "<fovea.FrameRecord " + std::to_string(record.index) + " " +
               to_string(record.status) + ">";
      });
}

}  // namespace fovea::python
