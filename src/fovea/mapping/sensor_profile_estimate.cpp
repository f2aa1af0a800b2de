#include "fovea/mapping/sensor_profile_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <vector>

#include "fovea/base/angle.h"
#include "fovea/mapping/ground.h"

namespace fovea {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// Nearer points are the vehicle's own.
constexpr float kMinRange = 0.5f;  // m
/// A pattern of fewer rings, or a scan of fewer points, is no evidence.
constexpr std::size_t kMinRings = 4, kMinPoints = 200;

/// Direction and range of a point.
struct Direction {
  double azimuth, elevation, range;  // rad, m
};

/// A scan in the order of its file, without points near the sensor.
struct Sweep {
  std::vector<Direction> directions;
  std::vector<std::uint16_t> ring;  // empty if the scan does not state it
};

/// The directions of one ring, or of a whole scan, by azimuth.
using Ring = std::vector<Direction>;

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Sweep directions_of(const PointCloud& scan) {
  Sweep sweep;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3f& p = scan.position[i];
    const float range = p.norm();
    if (!(range > kMinRange)) continue;
    sweep.directions.push_back({std::atan2(p.y(), p.x()), std::asin(p.z() / range), range});
    if (!scan.ring.empty()) sweep.ring.push_back(scan.ring[i]);
  }
  return sweep;
}

std::vector<Ring> rings_by_column(const Sweep& sweep) {
  std::map<std::uint16_t, Ring> rings;
  for (std::size_t i = 0; i < sweep.ring.size(); ++i) {
    rings[sweep.ring[i]].push_back(sweep.directions[i]);
  }
  std::vector<Ring> result;
  for (auto& [number, ring] : rings) result.push_back(std::move(ring));
  return result;
}

/// Change of azimuth from the point before, in (-pi, pi].
double step_to(const std::vector<Direction>& directions, std::size_t i) {
  return std::remainder(directions[i].azimuth - directions[i - 1].azimuth, kTurn);
}

/// Azimuth at which the rings of a scan begin that lists ring after ring: there the elevation
/// jumps.
double start_azimuth(const std::vector<Direction>& d) {
  double turned = 0;
  std::vector<std::pair<double, double>> jumps;  // of elevation; azimuth
  for (std::size_t i = 1; i < d.size(); ++i) {
    turned += step_to(d, i);
    jumps.emplace_back(std::abs(d[i].elevation - d[i - 1].elevation), d[i].azimuth);
  }
  const auto turns = static_cast<std::size_t>(std::abs(turned) / kTurn);
  const std::size_t count = std::clamp<std::size_t>(turns, 1, jumps.size());
  std::partial_sort(jumps.begin(), jumps.begin() + std::ptrdiff_t(count), jumps.end(),
                    std::greater<>());
  // The median azimuth of the jumps in the sector that has the most.
  constexpr int kSectors = 36;
  std::array<std::vector<double>, kSectors> sectors;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn =
        jumps[i].second / kTurn + 0.5 / kSectors;  // sectors are centered on the axes
    const double share = turn - std::floor(turn);
    const int sector = std::min(int(share * kSectors), kSectors - 1);
    const double center = kTurn * sector / kSectors;
    sectors[std::size_t(sector)].push_back(center +
                                           std::remainder(jumps[i].second - center, kTurn));
  }
  return median(*std::max_element(sectors.begin(), sectors.end(), [](const auto& a, const auto& b) {
    return a.size() < b.size();
  }));
}

double elevation_of(const Ring& ring) {
  std::vector<double> elevations;
  for (const Direction& d : ring) elevations.push_back(d.elevation);
  return median(std::move(elevations));
}

/// Rings of points that are listed ring after ring.
/// @param start  azimuth at which rings begin
std::vector<Ring> rings_from(const std::vector<Direction>& d, double start, bool turns_left) {
  constexpr double kLeastShare = 0.05;  // of the points of a mean ring
  // Angle turned since the start of a ring.
  const auto along = [&](const Direction& direction) {
    const double since = (turns_left ? 1 : -1) * (direction.azimuth - start);
    return since - kTurn * std::floor(since / kTurn);
  };
  std::vector<Ring> rings(1);
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (i > 0 && along(d[i]) < along(d[i - 1]) - kTurn / 2) rings.emplace_back();
    rings.back().push_back(d[i]);
  }
  // Where the end of a ring overlaps the start of the next, a few points are taken for a ring.
  const double least = kLeastShare * double(d.size()) / double(rings.size());
  std::erase_if(rings, [&](const Ring& ring) { return double(ring.size()) < least; });
  return rings;
}

/// Mean over rings of the median distance of their elevations from the median.
double spread_of(const std::vector<Ring>& rings) {
  double sum = 0;
  for (const Ring& ring : rings) {
    const double middle = elevation_of(ring);
    std::vector<double> away;
    for (const Direction& d : ring) away.push_back(std::abs(d.elevation - middle));
    sum += median(std::move(away));
  }
  return sum / double(rings.size());
}

/// Rings of a scan that lists ring after ring, each by azimuth. Empty if its points do not follow
/// each other that way.
std::vector<Ring> rings_by_order(const Sweep& sweep) {
  constexpr double kNear = 2 * kDegree;  // between points that follow each other on a ring
  constexpr double kFollowShare = 0.9;   // of the points
  const std::vector<Direction>& d = sweep.directions;
  std::size_t near = 0, forward = 0;
  for (std::size_t i = 1; i < d.size(); ++i) {
    near += std::abs(step_to(d, i)) < kNear ? 1 : 0;
    forward += step_to(d, i) > 0 ? 1 : 0;
  }
  if (double(near) < kFollowShare * double(d.size())) return {};
  const bool turns_left = forward > d.size() / 2;
  // Ahead, behind, or where elevations jump: objects near the sensor make elevations jump, too.
  std::vector<Ring> best;
  for (const double start : {0.0, kTurn / 2, start_azimuth(d)}) {
    std::vector<Ring> rings = rings_from(d, start, turns_left);
    if (best.empty() || spread_of(rings) < spread_of(best)) best = std::move(rings);
  }
  return best;
}

/// Rings as runs of elevations with gaps between them. Empty if elevations do not gather.
std::vector<Ring> rings_by_elevation(const std::vector<Sweep>& sweeps) {
  constexpr double kBin = 0.02 * kDegree;
  constexpr double kLeastCount = 0.05;   // of the mean of bins that have points
  constexpr double kMostOccupied = 0.5;  // of the bins between the outermost rings
  std::map<int, std::size_t> bins;
  std::size_t points = 0;
  const auto bin_of = [&](const Direction& d) { return int(std::floor(d.elevation / kBin)); };
  for (const Sweep& sweep : sweeps) {
    for (const Direction& d : sweep.directions) ++bins[bin_of(d)];
    points += sweep.directions.size();
  }
  if (bins.empty()) return {};
  const double least = kLeastCount * double(points) / double(bins.size());
  std::erase_if(bins, [&](const auto& bin) { return double(bin.second) < least; });
  const int span = bins.rbegin()->first - bins.begin()->first + 1;
  if (double(bins.size()) > kMostOccupied * span) return {};
  // Bins that follow each other, but for one empty bin, are one ring.
  std::map<int, std::size_t> ring_of_bin;
  std::size_t count = 0;
  int last = bins.begin()->first;
  for (const auto& [bin, unused] : bins) {
    count += bin > last + 2 ? 1 : 0;
    ring_of_bin[bin] = count;
    last = bin;
  }
  std::vector<Ring> rings(count + 1);
  for (const Sweep& sweep : sweeps) {
    for (const Direction& d : sweep.directions) {
      const auto ring = ring_of_bin.find(bin_of(d));
      if (ring != ring_of_bin.end()) rings[ring->second].push_back(d);
    }
  }
  return rings;
}

/// The rings of one sweep, of as many rings as most sweeps have.
std::vector<Ring> usual_rings(const std::vector<Sweep>& sweeps,
                              std::vector<Ring> (*rings_of)(const Sweep&)) {
  std::map<std::size_t, std::vector<std::vector<Ring>>> by_count;
  for (const Sweep& sweep : sweeps) {
    std::vector<Ring> rings = rings_of(sweep);
    by_count[rings.size()].push_back(std::move(rings));
  }
  const auto usual = std::max_element(
      by_count.begin(), by_count.end(),
      [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  return usual == by_count.end() ? std::vector<Ring>() : usual->second.front();
}

std::vector<Ring> find_rings(const std::vector<Sweep>& sweeps) {
  const bool stated = std::all_of(sweeps.begin(), sweeps.end(),
                                  [](const Sweep& sweep) { return !sweep.ring.empty(); });
  std::vector<Ring> rings = usual_rings(sweeps, stated ? rings_by_column : rings_by_order);
  if (rings.size() < kMinRings) rings = rings_by_elevation(sweeps);
  if (rings.size() < kMinRings) return {};
  std::sort(rings.begin(), rings.end(),
            [](const Ring& a, const Ring& b) { return elevation_of(a) > elevation_of(b); });
  return rings;
}

/// Median angle between points that follow each other on a ring.
double spacing_along(std::vector<Ring> rings) {
  constexpr double kSame = 1e-4;  // rad: further returns of one beam
  constexpr double kGap = 3 * kDegree;
  std::vector<double> steps;
  for (Ring& ring : rings) {
    std::sort(ring.begin(), ring.end(),
              [](const Direction& a, const Direction& b) { return a.azimuth < b.azimuth; });
    for (std::size_t i = 1; i < ring.size(); ++i) {
      const double step = ring[i].azimuth - ring[i - 1].azimuth;
      if (step > kSame && step < kGap) steps.push_back(step);
    }
  }
  return median(std::move(steps));
}

/// Standard deviation of ranges: of a range against the mean of its neighbors on the ring, which
/// lies on the surface, if that is smooth. Nothing if too few ranges can be compared.
std::optional<double> range_noise_of(std::vector<Ring> rings, double spacing) {
  constexpr double kStep = 0.3;                // m: more is an edge of depth
  constexpr double kToDeviation = 1 / 0.6745;  // median of a normal variable's magnitude
  std::vector<double> differences;
  for (Ring& ring : rings) {
    std::sort(ring.begin(), ring.end(),
              [](const Direction& a, const Direction& b) { return a.azimuth < b.azimuth; });
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      const double before = ring[i].azimuth - ring[i - 1].azimuth,
                   after = ring[i + 1].azimuth - ring[i].azimuth;
      if (std::max(before, after) > 1.5 * spacing || std::min(before, after) < 0.5 * spacing) {
        continue;
      }
      const double difference = ring[i].range - (ring[i - 1].range + ring[i + 1].range) / 2;
      if (std::abs(difference) < kStep) differences.push_back(std::abs(difference));
    }
  }
  if (differences.size() < kMinPoints) return std::nullopt;
  return median(std::move(differences)) * kToDeviation / std::sqrt(1.5);
}

/// Mean angle between neighboring points of a scan without rings.
double spacing_without_rings(const Sweep& sweep) {
  constexpr double kCell = 1 * kDegree;
  std::set<std::pair<int, int>> cells;
  double solid_angle = 0;
  for (const Direction& d : sweep.directions) {
    const auto row = int(std::floor(d.elevation / kCell));
    const double width = kCell / std::max(0.1, std::cos(row * kCell));
    if (cells.emplace(row, int(std::floor(d.azimuth / width))).second) solid_angle += kCell * kCell;
  }
  return std::sqrt(solid_angle / double(sweep.directions.size()));
}

/// Height above the ground of a LiDAR that stands upright or upside down.
std::optional<double> height_of(std::span<const PointCloud> scans) {
  std::vector<double> heights;
  for (const PointCloud& scan : scans) {
    std::vector<Eigen::Vector3f> turned = scan.position;
    std::optional<double> height = sensor_height(turned);
    if (!height) {
      for (Eigen::Vector3f& p : turned) p = {p.x(), -p.y(), -p.z()};
      height = sensor_height(turned);
    }
    if (height) heights.push_back(*height);
  }
  if (heights.empty()) return std::nullopt;
  return median(std::move(heights));
}

}  // namespace

SensorProfile estimate_sensor_profile(std::span<const PointCloud> scans,
                                      const SensorProfile& stated) {
  SensorProfile profile = stated;
  std::vector<Sweep> sweeps;
  for (const PointCloud& scan : scans) {
    Sweep sweep = directions_of(scan);
    if (sweep.directions.size() >= kMinPoints) sweeps.push_back(std::move(sweep));
  }
  if (sweeps.empty()) return profile;
  if (!profile.height) profile.height = height_of(scans);
  const std::vector<Ring> rings = find_rings(sweeps);
  if (rings.empty()) {
    profile.ring_spacing = profile.point_spacing = spacing_without_rings(sweeps.front());
    return profile;
  }
  for (const Ring& ring : rings) profile.ring_elevations.push_back(elevation_of(ring));
  std::vector<double> gaps;
  for (std::size_t i = 1; i < rings.size(); ++i) {
    gaps.push_back(profile.ring_elevations[i - 1] - profile.ring_elevations[i]);
  }
  profile.ring_spacing = median(std::move(gaps));
  profile.point_spacing = spacing_along(rings);
  profile.range_noise = range_noise_of(rings, profile.point_spacing).value_or(profile.range_noise);
  return profile;
}

}  // namespace fovea
