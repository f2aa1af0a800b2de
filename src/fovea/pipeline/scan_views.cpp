#include "fovea/pipeline/scan_views.h"

#include "fovea/base/parallel.h"
#include "fovea/mapping/blank_image.h"
#include "fovea/mapping/foveal_region.h"
#include "fovea/mapping/scan_projection.h"
#include "fovea/mapping/upsample.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 1024;  // points

PointCloud foveal_part(const PointCloud& scan_lidar, const Camera& camera,
                       const MapperOptions& options, ScanViews& views) {
  PointCloud foveal_cam = views.clock.time("fovea", [&] {
    return foveal_points(scan_lidar,
                         FovealRegion(foveal_options_of(options, camera.index), camera));
  });
  views.figures["points_foveal"] += as_figure(foveal_cam.size());
  if (options.ray_filter.mode != RayFilterMode::kScan) return foveal_cam;
  views.clock.time("filter", [&] {
    const ScanProjection projection(scan_lidar, camera);
    std::vector<std::uint8_t> hidden(foveal_cam.size());
    parallel_for(hidden.size(), kGrain, [&](std::size_t i) {
      const Eigen::Vector3d p = foveal_cam.position[i].cast<double>();
      hidden[i] = projection.hidden(camera.project(p).value(), p.norm());
    });
    views.figures["filter_hidden"] += as_figure(foveal_cam.drop(hidden));
  });
  return foveal_cam;
}

}  // namespace

bool shows_something(const Image& image, std::map<std::string, double>& figures) {
  if (image.empty()) return false;
  if (!is_blank(image)) return true;
  ++figures["images_blank"];
  return false;
}

ScanViews view_scan(const PointCloud& scan_lidar, const Frame& frame,
                    const std::vector<Camera>& cameras, const MapperOptions& options) {
  ScanViews views;
  if (options.moving.remove) {
    views.clock.time("filter",
                     [&] { views.ranges.emplace(scan_lidar.position, options.moving.row_height); });
  }
  if (!options.foveal_enabled) return views;
  views.of_camera.resize(cameras.size());
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    const Image* image = frame.images.empty() ? nullptr : &frame.images[k];
    if (image != nullptr && !shows_something(*image, views.figures)) continue;
    ScanView& view = views.of_camera[k].emplace();
    view.camera = cameras[k];
    view.foveal_cam = foveal_part(scan_lidar, view.camera, options, views);
    views.clock.time("upsample", [&] {
      if (options.surface.spacing > 0) {
        view.surface.emplace(find_surface(view.foveal_cam, view.camera, options.surface));
      } else {
        view.upsampled = upsample(view.foveal_cam, view.camera, options.upsample);
      }
    });
    if (image != nullptr && options.texture.views == TextureViews::kMean) {
      views.clock.time("texture", [&] { view.pyramid.emplace(*image); });
    }
  }
  return views;
}

}  // namespace fovea
