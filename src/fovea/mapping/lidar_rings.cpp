#include "fovea/mapping/lidar_rings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "fovea/core/angle.h"
#include "fovea/core/median.h"

namespace fovea {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// Nearer points are on the vehicle.
constexpr float kMinRange = 0.5f;  // m
/// Least number of rings and of points of a scan.
constexpr std::size_t kMinRings = 4, kMinPoints = 200;

LidarSweep directions_of(const PointCloud& scan) {
  LidarSweep sweep;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3f& p = scan.position[i];
    const float range = p.norm();
    if (!(range > kMinRange)) continue;
    sweep.directions.push_back({std::atan2(p.y(), p.x()), std::asin(p.z() / range), range});
    if (!scan.ring.empty()) sweep.ring.push_back(scan.ring[i]);
  }
  return sweep;
}

std::vector<LidarRing> rings_by_column(const LidarSweep& sweep) {
  std::map<std::uint16_t, LidarRing> rings;
  for (std::size_t i = 0; i < sweep.ring.size(); ++i) {
    rings[sweep.ring[i]].push_back(sweep.directions[i]);
  }
  std::vector<LidarRing> result;
  for (auto& [number, ring] : rings) result.push_back(std::move(ring));
  return result;
}

/// Change of azimuth from the previous point, in (-pi, pi].
double step_to(const std::vector<LidarDirection>& directions, std::size_t i) {
  return std::remainder(directions[i].azimuth - directions[i - 1].azimuth, kTurn);
}

/// Azimuth at which rings begin in a scan that lists ring after ring: the elevation jumps there.
double start_azimuth(const std::vector<LidarDirection>& d) {
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
  // Median azimuth of the jumps in the sector with the most.
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
  return median_of(
      *std::max_element(sectors.begin(), sectors.end(),
                        [](const auto& a, const auto& b) { return a.size() < b.size(); }));
}

/// Splits points that are listed ring after ring.
/// @param start  azimuth at which rings begin
std::vector<LidarRing> rings_from(const std::vector<LidarDirection>& d, double start,
                                  bool turns_left) {
  constexpr double kLeastShare = 0.05;  // of the points of a mean ring
  // Angle since the start of a ring.
  const auto along = [&](const LidarDirection& direction) {
    const double since = (turns_left ? 1 : -1) * (direction.azimuth - start);
    return since - kTurn * std::floor(since / kTurn);
  };
  std::vector<LidarRing> rings(1);
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (i > 0 && along(d[i]) < along(d[i - 1]) - kTurn / 2) rings.emplace_back();
    rings.back().push_back(d[i]);
  }
  // If the end of a ring overlaps the start of the next, a few points form a false ring.
  const double least = kLeastShare * double(d.size()) / double(rings.size());
  std::erase_if(rings, [&](const LidarRing& ring) { return double(ring.size()) < least; });
  return rings;
}

/// Mean over rings of the median distance of their elevations from the median.
double spread_of(const std::vector<LidarRing>& rings) {
  double sum = 0;
  for (const LidarRing& ring : rings) {
    const double middle = elevation_of(ring);
    std::vector<double> away;
    for (const LidarDirection& d : ring) away.push_back(std::abs(d.elevation - middle));
    sum += median_of(std::move(away));
  }
  return sum / double(rings.size());
}

/// Rings of a scan that lists ring after ring, each by azimuth. Empty if the scan has another
/// order.
std::vector<LidarRing> rings_by_order(const LidarSweep& sweep) {
  constexpr double kNear = 2 * kDegree;  // between consecutive points of a ring
  constexpr double kFollowShare = 0.9;   // of the points
  constexpr double kTurningShare = 0.8;  // of steps that turn the same way
  const std::vector<LidarDirection>& d = sweep.directions;
  std::size_t near = 0, forward = 0;
  for (std::size_t i = 1; i < d.size(); ++i) {
    near += std::abs(step_to(d, i)) < kNear ? 1 : 0;
    forward += step_to(d, i) > 0 ? 1 : 0;
  }
  if (double(near) < kFollowShare * double(d.size())) return {};
  // A pattern that swings back and forth has no rings.
  const double turning = double(std::max(forward, d.size() - forward)) / double(d.size());
  if (turning < kTurningShare) return {};
  const bool turns_left = forward > d.size() / 2;
  // Trial starts: ahead, behind, and the jump of elevation. Objects near the sensor cause jumps,
  // too.
  std::vector<LidarRing> best;
  double least_spread = std::numeric_limits<double>::infinity();
  for (const double start : {0.0, kTurn / 2, start_azimuth(d)}) {
    std::vector<LidarRing> rings = rings_from(d, start, turns_left);
    const double spread = spread_of(rings);
    if (spread >= least_spread) continue;
    least_spread = spread;
    best = std::move(rings);
  }
  return best;
}

/// Rings as runs of elevations with gaps between them. Empty if elevations form no runs.
std::vector<LidarRing> rings_by_elevation(const std::vector<LidarSweep>& sweeps) {
  constexpr double kBin = 0.02 * kDegree;
  constexpr double kLeastCount = 0.05;   // of the mean of the occupied bins
  constexpr double kMostOccupied = 0.5;  // of the bins between the outermost rings
  std::map<int, std::size_t> bins;
  std::size_t points = 0;
  const auto bin_of = [&](const LidarDirection& d) { return int(std::floor(d.elevation / kBin)); };
  for (const LidarSweep& sweep : sweeps) {
    for (const LidarDirection& d : sweep.directions) ++bins[bin_of(d)];
    points += sweep.directions.size();
  }
  if (bins.empty()) return {};
  const double least = kLeastCount * double(points) / double(bins.size());
  std::erase_if(bins, [&](const auto& bin) { return double(bin.second) < least; });
  const int span = bins.rbegin()->first - bins.begin()->first + 1;
  if (double(bins.size()) > kMostOccupied * span) return {};
  // Consecutive bins, with at most one empty bin between them, form one ring.
  std::map<int, std::size_t> ring_of_bin;
  std::size_t count = 0;
  int last = bins.begin()->first;
  for (const auto& [bin, unused] : bins) {
    count += bin > last + 2 ? 1 : 0;
    ring_of_bin[bin] = count;
    last = bin;
  }
  std::vector<LidarRing> rings(count + 1);
  for (const LidarSweep& sweep : sweeps) {
    for (const LidarDirection& d : sweep.directions) {
      const auto ring = ring_of_bin.find(bin_of(d));
      if (ring != ring_of_bin.end()) rings[ring->second].push_back(d);
    }
  }
  return rings;
}

/// The rings of one sweep with the most frequent number of rings.
std::vector<LidarRing> usual_rings(const std::vector<LidarSweep>& sweeps,
                                   std::vector<LidarRing> (*rings_of)(const LidarSweep&)) {
  std::map<std::size_t, std::vector<std::vector<LidarRing>>> by_count;
  for (const LidarSweep& sweep : sweeps) {
    std::vector<LidarRing> rings = rings_of(sweep);
    by_count[rings.size()].push_back(std::move(rings));
  }
  const auto usual = std::max_element(
      by_count.begin(), by_count.end(),
      [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  return usual == by_count.end() ? std::vector<LidarRing>() : usual->second.front();
}

}  // namespace

double elevation_of(const LidarRing& ring) {
  std::vector<double> elevations;
  for (const LidarDirection& d : ring) elevations.push_back(d.elevation);
  return median_of(std::move(elevations));
}

std::vector<LidarSweep> sweeps_of(std::span<const PointCloud> scans) {
  std::vector<LidarSweep> sweeps;
  for (const PointCloud& scan : scans) {
    LidarSweep sweep = directions_of(scan);
    if (sweep.directions.size() >= kMinPoints) sweeps.push_back(std::move(sweep));
  }
  return sweeps;
}

std::vector<LidarRing> find_rings(const std::vector<LidarSweep>& sweeps) {
  const bool stated = std::all_of(sweeps.begin(), sweeps.end(),
                                  [](const LidarSweep& sweep) { return !sweep.ring.empty(); });
  std::vector<LidarRing> rings = usual_rings(sweeps, stated ? rings_by_column : rings_by_order);
  if (rings.size() < kMinRings) rings = rings_by_elevation(sweeps);
  if (rings.size() < kMinRings) return {};
  std::vector<std::pair<double, LidarRing>> by_elevation;
  for (LidarRing& ring : rings) {
    std::sort(ring.begin(), ring.end(), [](const LidarDirection& a, const LidarDirection& b) {
      return a.azimuth < b.azimuth;
    });
    const double elevation = elevation_of(ring);
    by_elevation.emplace_back(elevation, std::move(ring));
  }
  std::sort(by_elevation.begin(), by_elevation.end(),
            [](const auto& a, const auto& b) { return a.first > b.first; });
  rings.clear();
  for (auto& [elevation, ring] : by_elevation) rings.push_back(std::move(ring));
  return rings;
}

}  // namespace fovea
