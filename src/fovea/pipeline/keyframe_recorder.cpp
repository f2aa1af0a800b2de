#include "fovea/pipeline/keyframe_recorder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "fovea/core/angle.h"
#include "fovea/drive/scans/sensor_scans.h"

namespace fovea {
namespace {

constexpr std::size_t kColumns = 1440;
constexpr double kColumnStep = 2 * std::numbers::pi / kColumns;
constexpr double kMaxRange = 655.34;  // m, in 16 bits
/// Rows of a LiDAR without rings: rad.
constexpr double kHighest = 60 * kDegree, kRowStep = 0.5 * kDegree;
constexpr int kRows = 241;

std::vector<double> rows_of(const SensorProfile& profile) {
  if (!profile.ring_elevations.empty()) return profile.ring_elevations;
  std::vector<double> rows;
  rows.reserve(kRows);
  for (int row = 0; row < kRows; ++row) rows.push_back(kHighest - row * kRowStep);
  return rows;
}

/// The row nearest to an elevation. Rows are in falling order.
std::size_t row_at(const std::vector<double>& rows, double elevation) {
  const auto below = std::lower_bound(rows.begin(), rows.end(), elevation, std::greater<>());
  if (below == rows.begin()) return 0;
  const auto above = std::prev(below);
  if (below == rows.end()) return rows.size() - 1;
  return std::size_t((*above - elevation < elevation - *below ? above : below) - rows.begin());
}

KeyframeRecord range_image(std::span<const Eigen::Vector3f> points, const SensorProfile& profile) {
  KeyframeRecord image;
  image.elevations = rows_of(profile);
  image.columns = kColumns;
  image.first_azimuth = -std::numbers::pi;
  image.azimuth_step = kColumnStep;
  image.ranges.resize(image.elevations.size() * kColumns);
  // Beyond the outermost rows by more than half a step, a return belongs to none.
  const double margin = std::max(profile.ring_spacing, kRowStep) / 2;
  const double top = image.elevations.front() + margin, bottom = image.elevations.back() - margin;
  std::vector<float> off_center(image.ranges.size());  // rad, of the return in each cell
  for (const Eigen::Vector3f& p : points) {
    const double range = p.norm();
    if (!(range > 0 && range < kMaxRange)) continue;
    const double elevation = std::atan2(double(p.z()), double(std::hypot(p.x(), p.y())));
    if (elevation > top || elevation < bottom) continue;
    const std::size_t row = row_at(image.elevations, elevation);
    const double column = (double(std::atan2(p.y(), p.x())) - image.first_azimuth) / kColumnStep;
    const std::size_t cell = row * kColumns + std::size_t(std::lround(column)) % kColumns;
    const auto off = float(
        std::hypot(elevation - image.elevations[row], kColumnStep * (column - std::round(column))));
    if (image.ranges[cell] != 0 && off >= off_center[cell]) continue;
    off_center[cell] = off;
    image.ranges[cell] = static_cast<std::uint16_t>(std::max(1L, std::lround(100 * range)));
  }
  return image;
}

}  // namespace

std::vector<KeyframeRecord> range_images(const PointCloud& scan_lidar, const DriveInfo& drive,
                                         int frame) {
  std::vector<KeyframeRecord> images;
  if (drive.lidars.size() < 2) {
    const SensorProfile profile =
        drive.lidars.empty() ? SensorProfile{} : drive.lidars.front().profile;
    images.push_back(range_image(scan_lidar.position, profile));
  } else {
    const std::vector<PointCloud> scans = scans_by_sensor(scan_lidar, drive.lidars);
    for (std::size_t k = 0; k < scans.size(); ++k) {
      images.push_back(range_image(scans[k].position, drive.lidars[k].profile));
    }
  }
  for (std::size_t k = 0; k < images.size(); ++k) {
    images[k].frame = frame;
    images[k].sensor = static_cast<int>(k);
  }
  return images;
}

void KeyframeRecorder::add(const TrackedFrame& tracked) {
  if (!tracked.tracked) return;
  const FrameResult& result = tracked.tracked->result;
  if (result.status != FrameStatus::kMapped) return;
  if (!choose(result.poses.submap, result.poses.T_odom_lidar)) return;
  for (KeyframeRecord& image : range_images(tracked.tracked->scan_lidar, drive_, result.index)) {
    fresh_.push_back(std::move(image));
  }
}

bool KeyframeRecorder::choose(int submap, const RigidMotion& T_odom_lidar) {
  const Eigen::Vector3d p_odom = T_odom_lidar.translation();
  if (spacing_ == 0 || submap < 0) return false;
  if (submap == submap_ && (p_odom - last_p_odom_).norm() < spacing_) return false;
  submap_ = submap;
  last_p_odom_ = p_odom;
  return true;
}

}  // namespace fovea
