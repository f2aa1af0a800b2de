// The foveal region and the ray filter of a camera, as functions over arrays.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <stdexcept>

#include "fovea/foveal_region.h"
#include "fovea/ray_filter.h"
#include "python/bindings/bindings.h"
#include "python/bindings/stage_arrays.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

using Slice = std::array<double, 4>;
constexpr std::int8_t kOutside = -1;  // RayVerdict.OUTSIDE of _results.py

FovealRegion make_region(const Camera& camera, double near_range, double far_range,
                         double periphery_range, const std::vector<Slice>& slices,
                         const std::vector<Eigen::Vector3d>& lidar_origins) {
  require_range("near_range", near_range, 0, 1e5);
  require_range("far_range", far_range, 0, 1e5);
  require_range("periphery_range", periphery_range, 0, 1e5);
  FovealOptions options{near_range, far_range, periphery_range};
  for (const auto& [left, right, low, high] : slices) {
    for (const double angle : {left, right, low, high})
      require_range("a slice", angle, -1.57, 1.57);
    options.slices.push_back({left, right, low, high});
  }
  for (const Eigen::Vector3d& origin : lidar_origins) {
    if (!origin.allFinite()) throw std::invalid_argument("a LiDAR's origin is not finite");
  }
  if (lidar_origins.empty()) throw std::invalid_argument("lidar_origins is empty");
  return {options, camera, lidar_origins};
}

py::array points_inside(const FovealRegion& region, const Floats& points_cam) {
  const PointCloud cloud = checked_cloud(points_cam);
  std::vector<std::uint8_t> is_inside(cloud.size());
  {
    const py::gil_scoped_release others_run;
    Eigen::Vector2f pixel;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      is_inside[i] = region.contains(cloud.position[i], pixel);
    }
  }
  return bool_array(std::move(is_inside));
}

py::array points_of_region(const Floats& points, const FovealRegion& region) {
  PointCloud cloud = checked_cloud(points);
  {
    const py::gil_scoped_release others_run;
    cloud = foveal_points(cloud, region);
  }
  return array_of(std::move(cloud.position));
}

/// The rays of the points in view, and the numbers of these points.
std::pair<std::vector<Ray>, std::vector<std::size_t>> rays_of(const PointCloud& points_cam,
                                                              const Camera& camera) {
  std::pair<std::vector<Ray>, std::vector<std::size_t>> rays;
  for (std::size_t i = 0; i < points_cam.size(); ++i) {
    const Eigen::Vector3f& p = points_cam.position[i];
    const auto pixel = camera.project(p.cast<double>());
    if (!pixel || !camera.in_view(*pixel)) continue;
    rays.first.push_back({pixel->cast<float>(), p.norm()});
    rays.second.push_back(i);
  }
  return rays;
}

py::array verdicts_of(const Floats& points_cam, const Camera& camera,
                      const std::optional<Floats>& map_points_cam, int window,
                      double outlier_rate) {
  require_range("window", window, 1, 999);
  if (window % 2 == 0) throw std::invalid_argument("window is not odd");
  require_range("outlier_rate", outlier_rate, 0, 1e6);
  const PointCloud scan = checked_cloud(points_cam);
  const PointCloud map = map_points_cam ? checked_cloud(*map_points_cam) : PointCloud();
  std::vector<std::int8_t> verdicts(scan.size(), kOutside);
  {
    const py::gil_scoped_release others_run;
    const auto [rays, numbers] = rays_of(scan, camera);
    RayFilter filter;
    const std::vector<RayVerdict> judged =
        filter.filter(rays, rays_of(map, camera).first, camera, {window, outlier_rate});
    for (std::size_t k = 0; k < judged.size(); ++k) {
      verdicts[numbers[k]] = static_cast<std::int8_t>(judged[k]);
    }
  }
  return array_of(std::move(verdicts));
}

}  // namespace

void bind_view(py::module_& module) {
  const FovealOptions options;
  py::class_<FovealRegion>(module, "FovealRegion",
                           "The part of a camera's view that is mapped, at one moment.")
      .def(
          py::init(&make_region), py::arg("camera"), py::kw_only(),
          py::arg("near_range") = options.near_range, py::arg("far_range") = options.far_range,
          py::arg("periphery_range") = options.periphery_range,
          py::arg("slices") = std::vector<Slice>(), py::arg("lidar_origins") = kOneLidar,
          "near_range, far_range: m from the LiDAR; periphery_range: m, 0: there is none; slices: "
          "(azimuth_min, azimuth_max, elevation_min, elevation_max) in rad about the optical axis, "
          "right and up, their union counts, none: the whole view; lidar_origins: 3 numbers each, "
          "m, in the LiDAR frame.")
      .def(
          "contains", &points_inside, py::arg("points_cam"),
          "Which points lie in the region.\n\npoints_cam: N x 3, m, camera frame. Returns N bool.");
  module.def("foveal_points", &points_of_region, py::arg("points"), py::arg("region"),
             "The points of a scan that are in a region, in the frame of its camera.\n\n"
             "points: N x 3, m, LiDAR frame. Returns M x 3 float32, m, in their order.");
  module.def(
      "ray_filter", &verdicts_of, py::arg("points_cam"), py::arg("camera"), py::kw_only(),
      py::arg("map_points_cam") = py::none(), py::arg("window") = RayFilterOptions().window,
      py::arg("outlier_rate") = RayFilterOptions().outlier_rate,
      "Which points of a scan a camera sees.\n\n"
      "points_cam: N x 3, m, camera frame; map_points_cam: M x 3, the points that are in the map "
      "already, or None; window: pixels, odd; outlier_rate: deviations, smaller rejects more.\n"
      "Returns N int8, each a RayVerdict: OUTSIDE of the image, VISIBLE, OCCLUDING (it hides a "
      "point of the map), OCCLUDED, or SHARED (a nearer point has its pixel).");
}

}  // namespace fovea::python
