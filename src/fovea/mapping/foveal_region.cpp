#include "fovea/foveal_region.h"

#include <cmath>
#include <limits>

#include "fovea/core/parallel.h"
#include "fovea/core/quick_angle.h"
#include "fovea/geometry/transform_cloud.h"

namespace fovea {
namespace {
constexpr std::size_t kGrain = 8192;
}  // namespace

std::vector<AngularSlice> FovealOptions::slices_of(int camera) const {
  if (camera == kNoCamera) return {};
  const auto own = camera_slices.find(camera);
  return own != camera_slices.end() ? own->second : slices;
}

FovealRegion::FovealRegion(const FovealOptions& options, const Camera& camera,
                           const std::vector<Eigen::Vector3d>& lidar_origins)
    : options_(options),
      camera_(camera),
      reach_(options.reach()),
      near_range2_(static_cast<float>(options.near_range * options.near_range)),
      far_range2_(static_cast<float>(options.far_range * options.far_range)),
      reach2_(static_cast<float>(options.reach() * options.reach())) {
  for (const Eigen::Vector3d& origin : lidar_origins) {
    lidars_in_cam_.emplace_back((camera.T_cam_lidar * origin).cast<float>());
    reach_ = std::max(reach_, options.reach() + origin.norm());
  }
  for (const AngularSlice& s : options.slices_of(camera.index)) {
    slices_.push_back({float(std::tan(s.azimuth_min)), float(std::tan(s.azimuth_max)),
                       float(std::tan(s.elevation_min)), float(std::tan(s.elevation_max))});
  }
}

bool FovealRegion::is_in_zone(const Eigen::Vector3f& p_cam,
                              const Eigen::Vector3f& lidar_cam) const {
  const float range2 = (p_cam - lidar_cam).squaredNorm();
  return range2 > near_range2_ && range2 < reach2_;
}

bool FovealRegion::is_in_view(const Eigen::Vector3f& p_cam, Eigen::Vector2f& pixel) const {
  if (!(p_cam.z() > float(Camera::kMinDepth))) return false;
  const float inverse_depth = 1 / p_cam.z();
  pixel = {float(camera_.fx) * p_cam.x() * inverse_depth + float(camera_.cx),
           float(camera_.fy) * p_cam.y() * inverse_depth + float(camera_.cy)};
  if (!(pixel.x() >= 0 && pixel.x() <= float(camera_.width - 1) && pixel.y() >= 0 &&
        pixel.y() <= float(camera_.height - 1))) {
    return false;
  }
  return in_slices(p_cam);
}

bool FovealRegion::contains(const Eigen::Vector3f& p_cam, Eigen::Vector2f& pixel) const {
  const auto is_in_zone_of = [&](const Eigen::Vector3f& lidar_cam) {
    return is_in_zone(p_cam, lidar_cam);
  };
  return std::any_of(lidars_in_cam_.begin(), lidars_in_cam_.end(), is_in_zone_of) &&
         is_in_view(p_cam, pixel);
}

bool FovealRegion::contains_measured(const Eigen::Vector3f& p_cam, std::size_t sensor,
                                     Eigen::Vector2f& pixel) const {
  return is_in_zone(p_cam, lidars_in_cam_[sensor]) && is_in_view(p_cam, pixel);
}

bool FovealRegion::in_slices(const Eigen::Vector3f& p_cam) const {
  if (slices_.empty()) return true;
  const float right = p_cam.x() / p_cam.z();
  const float up = -p_cam.y() / std::hypot(p_cam.x(), p_cam.z());
  for (const SlopeBounds& s : slices_) {
    if (right >= s.right_min && right <= s.right_max && up >= s.up_min && up <= s.up_max) {
      return true;
    }
  }
  return false;
}

PointCloud foveal_points(const PointCloud& scan_lidar, const FovealRegion& region) {
  const RigidMotion& T_cam_lidar = region.camera().T_cam_lidar;
  const Eigen::Matrix3f R = T_cam_lidar.linear().cast<float>();
  const Eigen::Vector3f t = (T_cam_lidar * scan_lidar.origin).cast<float>();
  std::vector<std::uint8_t> is_inside(scan_lidar.size());
  parallel_for(is_inside.size(), kGrain, [&](std::size_t i) {
    Eigen::Vector2f pixel;
    is_inside[i] =
        region.contains_measured(R * scan_lidar.position[i] + t, scan_lidar.sensor_at(i), pixel);
  });
  std::vector<std::uint32_t> inside;
  for (std::uint32_t i = 0; i < is_inside.size(); ++i) {
    if (is_inside[i] != 0) inside.push_back(i);
  }
  return transform_cloud(scan_lidar.select(inside), T_cam_lidar);
}

std::size_t limit_incidence(PointCloud& points_cam, double max_incidence) {
  const std::size_t n = points_cam.size();
  points_cam.range.resize(n);
  points_cam.incidence.resize(n);
  parallel_for(n, kGrain, [&](std::size_t i) {
    const Eigen::Vector3f& p = points_cam.position[i];
    const Eigen::Vector3f& normal = points_cam.normal[i];
    const float squared = p.squaredNorm(), facing = -normal.dot(p);
    points_cam.range[i] = std::sqrt(squared);
    points_cam.incidence[i] =
        normal.squaredNorm() > 0.5f
            ? quick_atan2(std::sqrt(std::max(0.0f, squared - facing * facing)), facing)
            : std::numeric_limits<float>::quiet_NaN();
  });
  std::vector<std::uint32_t> kept;
  kept.reserve(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    if (!(points_cam.incidence[i] > float(max_incidence))) kept.push_back(i);
  }
  points_cam.keep(kept);
  return n - kept.size();
}

}  // namespace fovea
