// fovea.Camera: a camera of a drive.
#include "fovea/camera.h"

#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"

namespace fovea::python {
namespace py = pybind11;

void bind_camera(py::module_& module) {
  py::class_<Camera>(module, "Camera", "A pinhole camera; pixel centres at integers.")
      .def_readonly("index", &Camera::index, "The drive's number for it.")
      .def_readonly("width", &Camera::width)
      .def_readonly("height", &Camera::height)
      .def_readonly("image_delay", &Camera::image_delay,
                    "s, from a scan's stamp to its image; the drive's median.")
      .def_property_readonly(
          "K",
          [](const Camera& c) {
            Eigen::Matrix3d K;
            K << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1;
            return matrix_array<3, 3>(K);
          },
          "3x3, pixels.")
      .def_property_readonly(
          "T_cam_lidar", [](const Camera& camera) { return motion_array(camera.T_cam_lidar); },
          "4x4.");
}

}  // namespace fovea::python
