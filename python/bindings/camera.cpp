// fovea.Camera: a camera of a drive, or one of the caller.
#include "fovea/camera.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <limits>
#include <stdexcept>

#include "python/bindings/bindings.h"
#include "python/bindings/stage_arrays.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

constexpr double kMaxPixels = 1 << 27;  // stages make grids of the size of the image

Camera make_pinhole(int width, int height, const Eigen::Matrix3d& K,
                    const std::optional<Doubles>& T_cam_lidar, int index) {
  require_range("width", width, 1, 65535);
  require_range("height", height, 1, 65535);
  require_range("width x height", double(width) * height, 1, kMaxPixels);
  require_range("index", index, 0, 127);
  Camera camera{index, width, height, K(0, 0), K(1, 1), K(0, 2), K(1, 2)};
  Eigen::Matrix3d pinhole;
  pinhole << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  if (!K.allFinite() || K != pinhole || !(camera.fx > 0) || !(camera.fy > 0)) {
    throw std::invalid_argument("K is not fx 0 cx, 0 fy cy, 0 0 1 with fx and fy above 0");
  }
  if (T_cam_lidar) camera.T_cam_lidar = motion_from(*T_cam_lidar);
  return camera;
}

py::array_t<double> pixels_of(const Camera& camera, const Floats& points_cam) {
  const PointCloud cloud = checked_cloud(points_cam);
  py::array_t<double> pixels({py::ssize_t(cloud.size()), py::ssize_t{2}});
  double* at = pixels.mutable_data();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector3f& p : cloud.position) {
    const Eigen::Vector2d pixel =
        camera.project(p.cast<double>()).value_or(Eigen::Vector2d(kNone, kNone));
    *at++ = pixel.x();
    *at++ = pixel.y();
  }
  return pixels;
}

}  // namespace

void bind_camera(py::module_& module) {
  py::class_<Camera>(module, "Camera", "A pinhole camera; pixel centers at integers.")
      .def(py::init(&make_pinhole), py::arg("width"), py::arg("height"), py::arg("K"),
           py::arg("T_cam_lidar") = py::none(), py::arg("index") = 0,
           "width, height: pixels; K: 3x3, pixels; T_cam_lidar: 4x4, optical frame (z ahead), or "
           "None: the identity. ValueError for numbers that are no camera.")
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
          "4x4.")
      .def("at_image", &Camera::at_image, py::arg("motion"),
           "The camera where it took the image, against the LiDAR at the scan's stamp.\n\n"
           "motion: SweepMotion of the LiDAR, or None: it stood.")
      .def("project", &pixels_of, py::arg("points_cam"),
           "Pixels of points, N x 2 float64; NaN where a point is not in front of the camera.\n\n"
           "points_cam: N x 3, m, camera frame.")
      .def("__repr__", [](const Camera& camera) {
        return "<fovea.Camera " + std::to_string(camera.index) + ", " +
               std::to_string(camera.width) + " x " + std::to_string(camera.height) + ">";
      });
}

}  // namespace fovea::python
