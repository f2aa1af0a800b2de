#include "fovea/evaluation/free_space.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "fovea/drive/scans/sensor_scans.h"

namespace fovea {
namespace {

constexpr std::uint8_t kTestedBit = 1, kViolatingBit = 2, kEnclosedBit = 4;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float radians(double degrees) { return static_cast<float>(degrees) * kPi / 180; }
constexpr float kConeRadians = radians(FreeSpaceTest::kCone);
constexpr float kWideConeRadians = radians(FreeSpaceTest::kWideCone);

/// The returns of a scan by direction: cells of azimuth and elevation, each as wide as the cone.
class ReturnGrid {
 public:
  enum class Verdict { kUnseen, kBehindReturn, kViolating, kEnclosed };

  explicit ReturnGrid(const PointCloud& scan_lidar) : first_(kRows * kColumns + 1, 0) {
    std::vector<std::uint32_t> cell(scan_lidar.size(), kNoCell);
    for (std::size_t i = 0; i < scan_lidar.size(); ++i) {
      const Eigen::Vector3f& p = scan_lidar.position[i];
      const float range = p.norm();
      if (!(range > kNoReturn)) continue;
      const Eigen::Vector3f ray = p / range;
      cell[i] = static_cast<std::uint32_t>(row_of(elevation_of(ray)) * kColumns +
                                           wrap(column_of(azimuth_of(ray))));
      ++first_[cell[i] + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    returns_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < cell.size(); ++i) {
      if (cell[i] == kNoCell) continue;
      const float range = scan_lidar.position[i].norm();
      returns_[next[cell[i]]++] = {scan_lidar.position[i] / range, range};
    }
  }

  /// Whether a point at `range` along `ray` stands in front of every return near its ray, and if
  /// so, whether among returns all round.
  Verdict judge(const Eigen::Vector3f& ray, float range) const {
    const Surroundings near = look_around(ray, range, kConeRadians);
    if (near.any_before) return Verdict::kBehindReturn;
    if (!near.above && !near.below) return Verdict::kUnseen;
    const Surroundings wide = look_around(ray, range, kWideConeRadians);
    const bool enclosed = !wide.any_before && wide.above && wide.below;
    return enclosed ? Verdict::kEnclosed : Verdict::kViolating;
  }

 private:
  static constexpr int kColumns = 900, kRows = 450;
  static_assert(kColumns * FreeSpaceTest::kCone == 360 && kRows * FreeSpaceTest::kCone == 180);
  static constexpr std::uint32_t kNoCell = 0xffffffffu;
  static constexpr float kNoReturn = 1e-3f;  // m; a beam without a return is reported as the origin

  static float elevation_of(const Eigen::Vector3f& ray) {
    return std::asin(std::clamp(ray.z(), -1.0f, 1.0f));
  }
  static float azimuth_of(const Eigen::Vector3f& ray) { return std::atan2(ray.y(), ray.x()); }
  static int row_of(float elevation) {
    return std::clamp(static_cast<int>(std::floor((elevation + kPi / 2) / kConeRadians)), 0,
                      kRows - 1);
  }
  static int column_of(float azimuth) {
    return static_cast<int>(std::floor((azimuth + kPi) / kConeRadians));
  }
  static int wrap(int column) { return (column % kColumns + kColumns) % kColumns; }

  struct Return {
    Eigen::Vector3f ray;  // unit
    float range;
  };
  struct Surroundings {
    bool any_before = false;            // a return that the point is not far enough in front of
    bool above = false, below = false;  // returns on these sides of it, if there is none before
  };
  Surroundings look_around(const Eigen::Vector3f& ray, float range, float cone) const {
    const float chord = 2 * std::sin(cone / 2);
    const float elevation = elevation_of(ray), azimuth = azimuth_of(ray);
    // Towards the poles the cone spans ever more azimuth: asin(sin(cone) / cos(elevation)), and all
    // of it where the pole is inside.
    const float spread = std::sin(cone) / std::cos(elevation);
    const float half_width = spread < 1 && spread > 0 ? std::asin(spread) : kPi;
    const int left = column_of(azimuth - half_width);
    const int columns = std::min(column_of(azimuth + half_width) - left + 1, kColumns);
    const int low = row_of(elevation - cone), high = row_of(elevation + cone);
    Surroundings found;
    for (int row = low; row <= high; ++row) {
      for (int column = left; column < left + columns; ++column) {
        const int cell = row * kColumns + wrap(column);
        for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
          const Return& near = returns_[k];
          if ((near.ray - ray).squaredNorm() > chord * chord) continue;
          found.above |= near.ray.z() >= ray.z();
          found.below |= near.ray.z() <= ray.z();
          if (near.range <= range + FreeSpaceTest::kInFront) {
            found.any_before = true;
            return found;
          }
        }
      }
    }
    return found;
  }

  std::vector<std::uint32_t> first_;  // of each cell in returns_
  std::vector<Return> returns_;
};

double share_of(std::size_t part, std::size_t all) {
  if (all == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(part) / static_cast<double>(all);
}

std::uint8_t bits_of(ReturnGrid::Verdict verdict) {
  switch (verdict) {
    case ReturnGrid::Verdict::kUnseen:
      return 0;
    case ReturnGrid::Verdict::kBehindReturn:
      return kTestedBit;
    case ReturnGrid::Verdict::kViolating:
      return kTestedBit | kViolatingBit;
    case ReturnGrid::Verdict::kEnclosed:
      return kTestedBit | kViolatingBit | kEnclosedBit;
  }
  return 0;
}

bool in_any_view(const Eigen::Vector3f& p_lidar, const std::vector<Camera>& cameras) {
  for (const Camera& camera : cameras) {
    if (scored_pixel(camera, camera.T_cam_lidar * p_lidar.cast<double>())) return true;
  }
  return cameras.empty();
}

}  // namespace

FreeSpaceTest::FreeSpaceTest(const ColoredPoints& map)
    : map_(map), state_(map.position.size(), 0) {}

void FreeSpaceTest::add_scan(const PointCloud& scan_lidar, const RigidMotion& T_local_lidar,
                             const std::vector<Camera>& cameras,
                             std::span<const MountedLidar> lidars) {
  if (lidars.size() < 2) return add_scan_of(scan_lidar, T_local_lidar, cameras);
  const std::vector<PointCloud> scans = scans_by_sensor(scan_lidar, lidars);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    std::vector<Camera> at_sensor = cameras;
    for (Camera& camera : at_sensor) {
      camera.T_cam_lidar = camera.T_cam_lidar * lidars[k].T_lidar_sensor;
    }
    add_scan_of(scans[k], T_local_lidar * lidars[k].T_lidar_sensor, at_sensor);
  }
}

void FreeSpaceTest::add_scan_of(const PointCloud& scan_sensor, const RigidMotion& T_local_sensor,
                                const std::vector<Camera>& cameras) {
  const ReturnGrid returns(scan_sensor);
  const RigidMotion T_map_sensor = Eigen::Translation3d(-map_.origin) * T_local_sensor;
  const Eigen::Isometry3f T_sensor_map = T_map_sensor.inverse().cast<float>();
  const Eigen::Vector3f sensor_in_map = T_map_sensor.translation().cast<float>();
  for (const PointRun& run : map_.runs) {
    if (run.distance_to(sensor_in_map) >= kEvaluatedFar) continue;
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const Eigen::Vector3f p_sensor = T_sensor_map * map_.position[i];
      const float range = p_sensor.norm();
      if (!(range > kEvaluatedNear && range < kEvaluatedFar)) continue;
      // Other scans may be setting bits of the same point; bits are only ever set.
      std::atomic_ref<std::uint8_t> state(state_[i]);
      if ((state.load(std::memory_order_relaxed) & kEnclosedBit) != 0) continue;
      if (!in_any_view(p_sensor, cameras)) continue;
      const ReturnGrid::Verdict verdict = returns.judge(p_sensor / range, range);
      state.fetch_or(bits_of(verdict), std::memory_order_relaxed);
    }
  }
}

FreeSpaceTest::Result FreeSpaceTest::result() const {
  Result result;
  for (const std::uint8_t state : state_) {
    result.tested += (state & kTestedBit) != 0;
    result.violating += (state & kViolatingBit) != 0;
    result.enclosed += (state & kEnclosedBit) != 0;
  }
  return result;
}

std::vector<std::uint8_t> FreeSpaceTest::tested() const {
  std::vector<std::uint8_t> marks(state_.size());
  for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = state_[i] & kTestedBit;
  return marks;
}

double FreeSpaceTest::Result::share() const { return share_of(violating, tested); }
double FreeSpaceTest::Result::enclosed_share() const { return share_of(enclosed, tested); }

}  // namespace fovea
