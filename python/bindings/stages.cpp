// The stages of the method that work on one scan or one view, as functions over arrays.
#include <pybind11/stl.h>

#include <limits>
#include <stdexcept>

#include "fovea/ground.h"
#include "fovea/surface_samples.h"
#include "fovea/texture.h"
#include "fovea/upsample.h"
#include "python/bindings/bindings.h"
#include "python/bindings/stage_arrays.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

py::array ground_mask(const Floats& points, const std::string& method, double height,
                      double tolerance, int ransac_iterations, double ransac_max_tilt,
                      std::uint64_t seed) {
  const auto number = choice_of("method", method, {"height", "ransac"});
  require_range("sensor_height", height, -100, 100);
  require_range("tolerance", tolerance, 0, 100);
  require_range("ransac_iterations", ransac_iterations, 1, 1e6);
  require_range("ransac_max_tilt", ransac_max_tilt, 0, 80);
  const GroundOptions options{static_cast<GroundMethod>(number),
                              height,
                              tolerance,
                              ransac_iterations,
                              ransac_max_tilt,
                              seed};
  const PointCloud cloud = checked_cloud(points);
  std::vector<std::uint8_t> mask;
  {
    const py::gil_scoped_release others_run;
    mask = segment_ground(cloud.position, options);
  }
  return bool_array(std::move(mask));
}

std::optional<double> height_of(const Floats& points) {
  const PointCloud cloud = checked_cloud(points);
  const py::gil_scoped_release others_run;
  return sensor_height(cloud.position);
}

UpsampleOptions upsample_options(int rate, double max_edge) {
  require_range("rate", rate, 0, 5);
  require_range("max_edge", max_edge, 0, 1000);
  return {rate, max_edge};
}

py::object upsample_in_view(const Floats& points_cam, const Camera& camera, int rate,
                            double max_edge) {
  const UpsampleOptions options = upsample_options(rate, max_edge);
  PointCloud cloud = checked_cloud(points_cam);
  {
    const py::gil_scoped_release others_run;
    cloud = upsample(cloud, camera, options);
  }
  return result_class("Upsampled")(array_of(std::move(cloud.position)),
                                   array_of(std::move(cloud.normal)),
                                   bool_array(std::move(cloud.interpolated)));
}

py::array upsample_above_ground(const Floats& points, const Numbers<bool>& is_ground,
                                const std::vector<Camera>& cameras, int rate, double max_edge) {
  const UpsampleOptions options = upsample_options(rate, max_edge);
  const PointCloud cloud = checked_cloud(points);
  const std::vector<std::uint8_t> mask = mask_from(is_ground, cloud.size());
  std::vector<Eigen::Vector3f> result;
  {
    const py::gil_scoped_release others_run;
    result = upsample_non_ground(cloud, mask, cameras, options);
  }
  return array_of(std::move(result));
}

py::object surface_samples(const Floats& points_cam, const Camera& camera,
                           const SurfaceOptions& options,
                           const std::optional<Doubles>& T_grid_cam) {
  require_range("spacing", options.spacing, 1e-3, 10);
  require_range("max_edge", options.max_edge, 0, 100);
  require_range("planar_edge", options.planar_edge, 0, 100);
  require_range("planar_angle", options.planar_angle, 0, 4);
  require_range("max_per_pixel", options.max_per_pixel, 0, 1e6);
  require_range("full_density_range", options.full_density_range, 0,
                std::numeric_limits<double>::infinity());
  SampleGrid grid{RigidMotion::Identity(), options.spacing,
                  [](const Eigen::Vector3d&, int) { return false; }, 0};
  if (T_grid_cam) grid.T_grid_cam = motion_from(*T_grid_cam);
  PointCloud cloud = checked_cloud(points_cam);
  {
    const py::gil_scoped_release others_run;
    cloud = sample_surfaces(cloud, camera, options, grid);
  }
  return result_class("SurfaceSamples")(
      array_of(std::move(cloud.position)), array_of(std::move(cloud.normal)),
      array_of(std::move(cloud.sampling_level)), array_of(std::move(cloud.reason)));
}

/// An image as large as the camera's.
Image image_of(const Camera& camera, const py::object& pixels) {
  Image image = image_from(pixels);
  if (image.width != camera.width || image.height != camera.height) {
    throw std::invalid_argument("an image has another size than its camera");
  }
  return image;
}

/// Of bools, or of 8-bit values: the picture of a mask.
py::object picture_of(const py::object& mask) {
  const auto bools = py::isinstance<py::array_t<bool>>(mask);
  return bools ? mask.attr("astype")("uint8") * py::int_(255) : mask;
}

py::object colors_of(const Floats& points_cam, const py::object& image, const Camera& camera,
                     const py::object& mask, const std::string& sampling) {
  const auto how =
      static_cast<ImageSampling>(choice_of("sampling", sampling, {"bilinear", "nearest"}));
  PointCloud cloud = checked_cloud(points_cam);
  const Image pixels = image_of(camera, image);
  std::optional<ImageMask> image_mask;
  if (!mask.is_none()) image_mask.emplace(image_of(camera, picture_of(mask)));
  std::vector<std::uint8_t> is_seen(cloud.size());
  py::array_t<std::uint8_t> colors({py::ssize_t(cloud.size()), py::ssize_t{3}});
  std::uint8_t* const bytes = colors.mutable_data();
  {
    const py::gil_scoped_release others_run;
    Camera seeing = camera;
    seeing.index = 0;  // that of a camera of the caller may be kNoCamera
    color_points(cloud, {pixels, seeing, 0, image_mask ? &*image_mask : nullptr}, how);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      is_seen[i] = cloud.camera[i] != kNoCamera;
      const Rgb color = to_rgb(cloud.color[i]);
      bytes[3 * i] = color.r;
      bytes[3 * i + 1] = color.g;
      bytes[3 * i + 2] = color.b;
    }
  }
  return result_class("ColoredPoints")(colors, bool_array(std::move(is_seen)));
}

void bind_ground(py::module_& module) {
  const GroundOptions options;
  module.def("segment_ground", &ground_mask, py::arg("points"), py::kw_only(),
             py::arg("method") = "height", py::arg("sensor_height") = options.sensor_height,
             py::arg("tolerance") = options.tolerance,
             py::arg("ransac_iterations") = options.ransac_iterations,
             py::arg("ransac_max_tilt") = options.ransac_max_tilt, py::arg("seed") = options.seed,
             "Which points of a scan are ground.\n\n"
             "points: N x 3, m, LiDAR frame; method: 'height' (a threshold) or 'ransac' (a plane); "
             "sensor_height: m above the road; tolerance: m, above the plane; ransac_max_tilt: "
             "degrees.\nReturns N bool. ValueError for other shapes and ranges.");
  module.def("sensor_height", &height_of, py::arg("points"),
             "Height of the LiDAR above the plane below it with the most points, m; or None.\n\n"
             "points: N x 3, m, LiDAR frame.");
}

void bind_upsampling(py::module_& module) {
  const UpsampleOptions options;
  module.def(
      "upsample", &upsample_in_view, py::arg("points_cam"), py::arg("camera"), py::kw_only(),
      py::arg("rate") = options.rate, py::arg("max_edge") = options.max_edge,
      "Adds centroids of the triangles of a cloud's Delaunay triangulation in the image.\n\n"
      "points_cam: N x 3, m, camera frame, all more than 0.1 m in front of the camera; rate: "
      "how often centroids are inserted, 0 to 5; max_edge: m, longest edge of a filled "
      "triangle.\nReturns Upsampled(position, normal, interpolated): the N points in their "
      "order, then the new ones. ValueError for points behind the camera.");
  module.def("upsample_non_ground", &upsample_above_ground, py::arg("points"), py::arg("is_ground"),
             py::arg("cameras"), py::kw_only(), py::arg("rate") = options.rate,
             py::arg("max_edge") = options.max_edge,
             "Densifies the points in view of cameras except ground points, for registration.\n\n"
             "points: N x 3, m, LiDAR frame; is_ground: N bool; cameras: Camera of each view.\n"
             "Returns M x 3 float32, m, LiDAR frame. Points outside all views are left out.");
}

void bind_surfaces(py::module_& module) {
  const SurfaceOptions options;
  module.def(
      "sample_surfaces",
      [](const Floats& points_cam, const Camera& camera, double spacing, double max_edge,
         double planar_edge, double planar_angle, double max_per_pixel, double full_density_range,
         const std::optional<Doubles>& T_grid_cam) {
        return surface_samples(
            points_cam, camera,
            {spacing, max_edge, planar_edge, planar_angle, max_per_pixel, full_density_range},
            T_grid_cam);
      },
      py::arg("points_cam"), py::arg("camera"), py::kw_only(), py::arg("spacing") = options.spacing,
      py::arg("max_edge") = options.max_edge, py::arg("planar_edge") = options.planar_edge,
      py::arg("planar_angle") = options.planar_angle,
      py::arg("max_per_pixel") = options.max_per_pixel,
      py::arg("full_density_range") = options.full_density_range,
      py::arg("T_grid_cam") = py::none(),
      "Samples the surfaces in a camera's view on a regular grid.\n\n"
      "points_cam: N x 3, m, camera frame, all more than 0.1 m in front of the camera; spacing: m, "
      "of the samples; max_edge: m, triangles with shorter edges are surface; planar_edge: m, the "
      "same where the surface is flat up to planar_angle (rad); max_per_pixel: samples, 0: no "
      "limit; full_density_range: m; T_grid_cam: 4x4, pose of the grid, or None: that of the "
      "camera.\nReturns SurfaceSamples(position, normal, level, reason): kept points first. "
      "ValueError for points behind the camera.");
}

}  // namespace

void bind_stages(py::module_& module) {
  bind_ground(module);
  bind_upsampling(module);
  bind_surfaces(module);
  module.def("color_points", &colors_of, py::arg("points_cam"), py::arg("image"), py::arg("camera"),
             py::kw_only(), py::arg("mask") = py::none(), py::arg("sampling") = "bilinear",
             "Colors of points from the image at their projections.\n\n"
             "points_cam: N x 3, m, camera frame; image: height x width x 3 or height x width "
             "uint8, of the camera's size; mask: height x width bool, False where the image does "
             "not show the scene, or a uint8 picture, dark there; sampling: 'bilinear' or "
             "'nearest'.\nReturns ColoredPoints(color, is_seen). Whether another point hides a "
             "point is the question of ray_filter(). ValueError for other shapes.");
}

}  // namespace fovea::python
