#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea {
namespace {

void require(bool holds, std::string_view option, double value, std::string_view range) {
  if (holds) return;
  throw std::invalid_argument(
      fmt::format("register_scans: {} is {}, it must be {}", option, value, range));
}

void check(const RegistrationOptions& options) {
  const auto is_length = [](double value) { return std::isfinite(value) && value >= 0; };
  require(is_length(options.max_distance) && options.max_distance > 0, "max_distance",
          options.max_distance, "above 0 m");
  require(is_length(options.voxel), "voxel", options.voxel, "0 m or more");
  require(is_length(options.robust_width), "robust_width", options.robust_width, "0 m or more");
  require(options.max_iterations >= 0, "max_iterations", options.max_iterations, "0 or more");
  require(options.max_points >= 0, "max_points", options.max_points, "0 or more");
  require(options.neighbors >= 3, "neighbors", options.neighbors, "3 or more");
}

RegistrationCloud prepared(const PointCloud& scan, std::string_view name,
                           const RegistrationOptions& options) {
  if (!scan.origin.isZero()) {
    throw std::invalid_argument(fmt::format(
        "register_scans: the origin of {} is not 0; move its points to the sensor's frame", name));
  }
  return prepare_cloud(voxel_thinned(scan.position, static_cast<float>(options.voxel)), options,
                       options.voxel);
}

}  // namespace

RegistrationResult register_scans(const PointCloud& target, const PointCloud& source,
                                  const RigidMotion& guess, const RegistrationOptions& options,
                                  const std::optional<PosePrior>& prior) {
  check(options);
  if (!is_rotation(guess.linear()) || !guess.translation().allFinite()) {
    throw std::invalid_argument("register_scans: the guess is no rigid motion");
  }
  const RegistrationCloud target_cloud = prepared(target, "the target", options);
  const PointIndex index(target_cloud.points, options.voxel);
  return register_clouds(target_cloud, index, prepared(source, "the source", options), guess,
                         options, prior);
}

}  // namespace fovea
