// fovea.SweepMotion and fovea.SweepTiming, and the removal of the motion from a scan.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <stdexcept>

#include "fovea/deskew.h"
#include "python/bindings/bindings.h"
#include "python/bindings/stage_arrays.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

const std::vector<std::string> kDirections{"clockwise", "counterclockwise"};  // SweepDirection

SweepMotion make_motion(const Twist& velocity, const Twist& acceleration) {
  if (!velocity.allFinite() || !acceleration.allFinite()) {
    throw std::invalid_argument("a velocity or an acceleration is not finite");
  }
  return {velocity, acceleration, std::nullopt};
}

SweepTiming make_timing(double period, const std::string& direction, double start_azimuth,
                        double stamp_phase) {
  require_range("period", period, 1e-3, 60);
  require_range("start_azimuth", start_azimuth, -10, 10);
  require_range("stamp_phase", stamp_phase, 0, 1);
  return {period, static_cast<SweepDirection>(choice_of("direction", direction, kDirections)),
          start_azimuth, stamp_phase};
}

py::array compensate(const Floats& points, const SweepMotion& motion,
                     const std::optional<Floats>& times, const SweepTiming& sweep) {
  PointCloud cloud = checked_cloud(points);
  if (times) {
    if (times->ndim() != 1 || static_cast<std::size_t>(times->size()) != cloud.size()) {
      throw std::invalid_argument("times need one number for each point");
    }
    cloud.time.assign(times->data(), times->data() + times->size());
    for (const float t : cloud.time) require_range("a time", t, -3600, 3600);
  }
  {
    const py::gil_scoped_release others_run;
    compensate_sweep(cloud, motion, sweep);
  }
  return array_of(std::move(cloud.position));
}

}  // namespace

void bind_motion(py::module_& module) {
  py::class_<SweepMotion>(module, "SweepMotion",
                          "How a body moves about a moment: twists in its own frame, rotation "
                          "first.")
      .def(py::init(&make_motion), py::arg("velocity"),
           py::arg("acceleration") = Twist(Twist::Zero()),
           "velocity: 6, rad/s and m/s; acceleration: 6, rad/s^2 and m/s^2.")
      .def_property_readonly(
          "velocity",
          [](const SweepMotion& self) { return py::array_t<double>(6, self.velocity.data()); },
          "6 float64, rad/s and m/s.")
      .def_property_readonly(
          "acceleration",
          [](const SweepMotion& self) { return py::array_t<double>(6, self.acceleration.data()); },
          "6 float64, rad/s^2 and m/s^2.");
  py::class_<SweepTiming>(module, "SweepTiming",
                          "When the points of a sweep are measured, for scans without times.")
      .def(py::init(&make_timing), py::kw_only(), py::arg("period") = SweepTiming().period,
           py::arg("direction") = kDirections[0],
           py::arg("start_azimuth") = SweepTiming().start_azimuth,
           py::arg("stamp_phase") = SweepTiming().stamp_phase,
           "period: s; direction: 'clockwise' or 'counterclockwise', from above; start_azimuth: "
           "rad, atan2(y, x); stamp_phase: share of the sweep that is complete at the stamp.")
      .def_readonly("period", &SweepTiming::period, "s.")
      .def_property_readonly(
          "direction",
          [](const SweepTiming& self) {
            return kDirections[static_cast<std::size_t>(self.direction)];
          },
          "'clockwise' or 'counterclockwise', from above.")
      .def_readonly("start_azimuth", &SweepTiming::start_azimuth, "rad, atan2(y, x).")
      .def_readonly("stamp_phase", &SweepTiming::stamp_phase,
                    "Share of the sweep that is complete at the stamp.");
  module.def(
      "compensate_sweep", &compensate, py::arg("points"), py::arg("motion"), py::kw_only(),
      py::arg("times") = py::none(), py::arg("sweep") = SweepTiming(),
      "Deskews a scan: moves each point to where it was in the LiDAR frame at the scan's "
      "stamp.\n\n"
      "points: N x 3, m, LiDAR frame, as measured; motion: SweepMotion of the LiDAR at the "
      "stamp, as Frame.motion; times: N, s from the stamp, or None: by azimuth and `sweep`.\n"
      "Returns N x 3 float32, m. ValueError for other shapes, and for points that are not "
      "finite.");
}

}  // namespace fovea::python
