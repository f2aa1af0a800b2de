#include "fovea/map/road_height.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace fovea {
namespace {

constexpr double kStep = 1;      // m, between places
constexpr double kLongGap = 20;  // m, without a frame: the path is unknown there

using Heights = std::vector<std::optional<double>>;

/// Of the LiDAR frame above the road, by the number of the drive; absent where not stated.
Heights stated_heights(const MapReader& map) {
  Heights heights(map.drives().size());
  for (const SensorRecord& sensor : map.sensors()) {
    const auto drive = static_cast<std::size_t>(sensor.drive);
    if (drive >= heights.size() || heights[drive] || !sensor.profile.height) continue;
    heights[drive] = *sensor.profile.height - sensor.T_lidar_sensor.translation().z();
  }
  return heights;
}

/// Counts of heights in bins of one centimeter.
class HeightHistogram {
 public:
  static constexpr double kLowest = 0.3, kHighest = 10, kBin = 0.01;  // m
  static constexpr std::size_t kFewest = 1000;                        // points

  void add(double height) {
    if (!(height >= kLowest && height < kHighest)) return;
    ++counts_[static_cast<std::size_t>(height / kBin)];
    ++total_;
  }
  /// Nothing if there are too few heights.
  std::optional<double> median() const {
    if (total_ < kFewest) return std::nullopt;
    std::size_t bin = 0;
    for (std::size_t below = counts_[0]; 2 * below < total_; below += counts_[bin]) ++bin;
    return (static_cast<double>(bin) + 0.5) * kBin;
  }

 private:
  std::array<std::size_t, static_cast<std::size_t>(kHighest / kBin) + 1> counts_{};
  std::size_t total_ = 0;
};

}  // namespace

RoadHeight::RoadHeight(const MapReader& map) {
  const std::shared_ptr<const void> state = map.hold_state();
  const std::vector<DriveRecord> drives = map.drives();
  Heights by_drive = stated_heights(map);
  by_drive.emplace_back();  // of a frame that belongs to no drive
  Heights heights;          // by place
  std::size_t last_drive = by_drive.size();
  for (const FrameRecord& frame : map.frames()) {
    if (frame.status == FrameStatus::kSkipped) continue;
    const std::size_t drive = drive_of_frame(drives, frame.index);
    lead_to(frame.T_local_lidar.translation(), drive == last_drive);
    heights.resize(places_.size(), by_drive[drive]);
    last_drive = drive;
  }
  if (places_.empty()) return;
  index_places();
  const bool all_stated = std::all_of(heights.begin(), heights.end(),
                                      [](const auto& height) { return height.has_value(); });
  const double usual = all_stated ? 0 : height_above_points(map);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    places_[i].p_local.z() -= heights[i].value_or(usual);
  }
}

void RoadHeight::lead_to(const Eigen::Vector3d& p_local, bool follows) {
  if (follows) {
    const Eigen::Vector3d last = places_.back().p_local;
    const double distance = (p_local - last).norm();
    follows = distance <= kLongGap;
    const int steps = follows ? static_cast<int>(std::ceil(distance / kStep)) : 0;
    for (int i = 1; i < steps; ++i) {
      places_.push_back({last + (p_local - last) * i / steps, true});
    }
  }
  places_.push_back({p_local, follows});
}

void RoadHeight::index_places() {
  const Eigen::Vector3d first = places_.front().p_local;
  for (const Place& place : places_) {
    const Eigen::Vector2f p = (place.p_local - first).head<2>().cast<float>();
    in_plan_.emplace_back(p.x(), p.y(), 0.f);
  }
  tree_.emplace(in_plan_);
}

RoadHeight::Nearest RoadHeight::nearest_between(const Place& first, const Place& second,
                                                const Eigen::Vector3d& p_local) const {
  const Eigen::Vector3d along = second.p_local - first.p_local;
  const double length = along.head<2>().squaredNorm();
  const double share =
      length > 0 ? (p_local - first.p_local).head<2>().dot(along.head<2>()) / length : 0;
  const Eigen::Vector3d nearest = first.p_local + std::clamp(share, 0.0, 1.0) * along;
  return {(p_local - nearest).head<2>().squaredNorm(), nearest.z()};
}

double RoadHeight::above(const Eigen::Vector3d& p_local) const {
  if (places_.empty()) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector2f p = (p_local - places_.front().p_local).head<2>().cast<float>();
  const std::size_t i = tree_->nearest({p.x(), p.y(), 0}).index;
  const Place& place = places_[i];
  Nearest nearest = nearest_between(place, place, p_local);
  const auto try_with = [&](const Place& neighbor) {
    const Nearest other = nearest_between(place, neighbor, p_local);
    if (other.squared_distance < nearest.squared_distance) nearest = other;
  };
  if (place.follows) try_with(places_[i - 1]);
  if (i + 1 < places_.size() && places_[i + 1].follows) try_with(places_[i + 1]);
  return p_local.z() - nearest.z;
}

double RoadHeight::height_above_points(const MapReader& map) const {
  constexpr float kNear = 2;  // m in plan: the vehicle itself and its lane
  const std::vector<RigidMotion> T_local_submap = map.submaps();
  const Eigen::Vector3d first = places_.front().p_local;
  HeightHistogram heights;
  map.for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const Eigen::Vector3d p_local =
          T_local_submap.at(submap) * (tile.origin + tile.position[i].cast<double>());
      const Eigen::Vector2f p = (p_local - first).head<2>().cast<float>();
      const float distance = tree_->nearest({p.x(), p.y(), 0}, kNear).squared_distance;
      if (distance < kNear * kNear) heights.add(-above(p_local));
    }
  });
  return heights.median().value_or(kUsualSensorHeight);
}

}  // namespace fovea
