#include "bench/registration_bench.h"

#include <cmath>

#include "bench/duel.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/registration/local_map.h"
#include "fovea/mapping/registration/normals.h"

namespace fovea::bench {
namespace {

constexpr double kVoxel = 0.25;  // m
constexpr double kRobustWidth = 0.1;

RegistrationOptions options() {
  RegistrationOptions options;
  options.robust_width = kRobustWidth;
  return options;
}

RegistrationCloud prepared(const std::vector<Eigen::Vector3f>& scan) {
  return prepare_cloud(voxel_thinned(scan, static_cast<float>(kVoxel)), options(), kVoxel);
}

/// A local map of all scans but the last, and the pose that the last one is expected at.
struct Street {
  LocalMap map{LocalMapOptions{.max_keyframes = 20}};
  RigidMotion guess = RigidMotion::Identity();

  explicit Street(const BenchData& data) {
    RigidMotion pose = RigidMotion::Identity(), step = pose;
    for (std::size_t k = 0; k + 1 < data.frames.size(); ++k) {
      RegistrationCloud scan = prepared(data.scan(k));
      if (k > 0) {
        const RegistrationResult found = register_to(map, scan, pose * step, options());
        check(found.converged, "a scan that does not fit the ones before");
        step = pose.inverse() * found.T_target_source;
        pose = found.T_target_source;
      }
      map.add(std::move(scan.points), pose);
    }
    guess = pose * step;
  }
};

}  // namespace

void bench_thinning(benchmark::State& state, const BenchData& data) {
  const std::vector<Eigen::Vector3f>& scan = data.frames.back().scan.position;
  const std::size_t points = voxel_sample(scan, float{kVoxel}).size();
  check(points > 0 && points < scan.size(), "nothing thinned");
  solo(state, [&] { return voxel_sample(scan, float{kVoxel}).size(); });
  state.counters["points"] = static_cast<double>(points);
}

void bench_normals(benchmark::State& state, const BenchData& data) {
  const std::vector<Eigen::Vector3f> points =
      voxel_thinned(data.frames.back().scan.position, float{kVoxel});
  constexpr int kNeighbors = 10;
  const auto ours = [&] { return estimate_normals(points, {kNeighbors, kVoxel}); };
  const auto by_tree = [&] { return estimate_normals(points, {kNeighbors}); };
  std::size_t known = 0, alike = 0;
  const std::vector<Eigen::Vector3f> a = ours(), b = by_tree();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (a[i].isZero() || b[i].isZero()) continue;
    ++known;
    alike += std::abs(a[i].dot(b[i])) > 0.9f;
  }
  check(known > points.size() / 2 && alike > known * 2 / 3, "normals unlike the tree's");
  duel(state, [&] { return ours().size(); }, [&] { return by_tree().size(); });
  state.counters["points"] = static_cast<double>(points.size());
}

void bench_alignment(benchmark::State& state, const BenchData& data) {
  const Street street(data);
  const RegistrationCloud scan = prepared(data.frames.back().scan.position);
  const LocalMap::Target& target = street.map.target();
  const PointIndex tree(target.cloud.points);
  const Eigen::Translation3d T_origin_odom(-target.origin_odom);
  const auto ours = [&] { return register_to(street.map, scan, street.guess, options()); };
  const auto by_tree = [&] {
    return register_clouds(target.cloud, tree, scan, T_origin_odom * street.guess, options());
  };
  const RegistrationResult result = ours();
  const Eigen::Vector3d apart = (T_origin_odom * result.T_target_source).translation() -
                                by_tree().T_target_source.translation();
  check(result.converged && apart.norm() < 1e-3, "a pose unlike the tree's");
  duel(state, [&] { return ours().pairs; }, [&] { return by_tree().pairs; });
  state.counters["points"] = static_cast<double>(scan.points.size());
  state.counters["target"] = static_cast<double>(target.cloud.points.size());
}

void bench_local_map(benchmark::State& state, const BenchData& data) {
  Street street(data);
  const RegistrationCloud scan = prepared(data.frames.back().scan.position);
  RigidMotion pose = street.guess;
  const RigidMotion step(Eigen::Translation3d(0.2, 0, 0));
  RegistrationCloud next;
  const auto drive_on = [&] {
    next = scan;
    pose = pose * step;
  };
  solo(state, drive_on, [&] {
    street.map.add(std::move(next.points), pose);
    return street.map.size();
  });
  check(street.map.size() >= scan.points.size() / 2, "a map without points");
  state.counters["target"] = static_cast<double>(street.map.size());
}

}  // namespace fovea::bench
