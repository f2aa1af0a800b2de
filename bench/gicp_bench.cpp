// Registration beside PCL's and Open3D's: each scan of a drive to the one before, the same points,
// the same guess, in turns in one process on one thread.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/bench_data.h"
#include "bench/duel.h"
#include "bench/registration_peer.h"
#if defined(FOVEA_PCL_PEER)
#include "bench/pcl_peer.h"
#endif
#if defined(FOVEA_OPEN3D_PEER)
#include "bench/open3d_peer.h"
#endif
#include "fovea/core/parallel.h"
#include "fovea/core/wall_clock.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea::bench {
namespace {

constexpr double kVoxel = 0.25;  // m
/// Poses further apart than this are not of the same pair of scans (m).
constexpr double kApart = 0.1;

struct Peer {
  std::string name;
  bool is_gicp;  // which ends where ours does
  PeerRegistration (*align)(const RegistrationTask&);
};

const std::vector<Peer> kPeers{
#if defined(FOVEA_PCL_PEER)
    {"PCL's GICP", true, pcl_gicp},
    {"PCL's ICP, point to point", false, pcl_icp},
#endif
#if defined(FOVEA_OPEN3D_PEER)
    {"Open3D's GICP", true, open3d_gicp},
    {"Open3D's ICP, point to plane", false, open3d_icp},
#endif
};

struct Contender {
  std::string name;
  std::vector<double> ms, apart_mm;  // by scan
};

PeerPoints points_of(const std::vector<Eigen::Vector3f>& points) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  return {points.front().data(), points.size()};
}

RegistrationOptions options() {
  RegistrationOptions options;
  options.robust_width = 0.1;
  return options;
}

/// What a new scan costs: its normals, the index of the one before, the alignment.
RegistrationResult ours(const RegistrationCloud& target, const std::vector<Eigen::Vector3f>& scan,
                        const RigidMotion& guess) {
  const PointIndex index(target.points, kVoxel);
  return register_clouds(target, index, prepare_cloud(scan, options(), kVoxel), guess, options());
}

void race(const BenchData& data, int runs) {
  const ThreadLimit limit(1);
  std::vector<Contender> contenders{{"Fovea's GICP", {}, {}}};
  for (const Peer& peer : kPeers) contenders.push_back({peer.name, {}, {}});
  RigidMotion guess = RigidMotion::Identity();
  std::size_t points = 0;
  for (std::size_t k = 1; k < data.frames.size(); ++k) {
    const auto thinned = [&](std::size_t i) {
      return voxel_thinned(data.scan(i), static_cast<float>(kVoxel));
    };
    const std::vector<Eigen::Vector3f> before = thinned(k - 1), scan = thinned(k);
    const RegistrationCloud target = prepare_cloud(before, options(), kVoxel);
    const RegistrationResult truth = ours(target, scan, guess);
    check(truth.converged, "a scan that does not fit the one before");
    points += scan.size();
    RegistrationTask task{
        points_of(before), points_of(scan), {}, options().max_distance, options().neighbors};
    using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(task.guess) = guess.matrix();
    for (int run = 0; run < runs; ++run) {
      const WallClock::time_point start = WallClock::now();
      benchmark::DoNotOptimize(ours(target, scan, guess));
      contenders[0].ms.push_back(milliseconds_since(start));
      contenders[0].apart_mm.push_back(0);
      for (std::size_t i = 0; i < kPeers.size(); ++i) {
        const PeerRegistration result = kPeers[i].align(task);
        const Eigen::Map<const RowMajor> T(result.T_target_source);
        const double apart =
            (T.topRightCorner<3, 1>() - truth.T_target_source.translation()).norm();
        check(!kPeers[i].is_gicp || apart < kApart, "a pose unlike " + kPeers[i].name);
        contenders[i + 1].ms.push_back(1e3 * result.seconds);
        contenders[i + 1].apart_mm.push_back(1e3 * apart);
      }
    }
    guess = truth.T_target_source;
  }
  const std::size_t scans = data.frames.size() - 1;
  fmt::print(
      "{} scans of {} points\n\n| | ms | times Fovea | mm from Fovea's pose |\n"
      "| --- | --- | --- | --- |\n",
      scans, points / scans);
  for (const Contender& contender : contenders) {
    std::vector<double> ratio;
    for (std::size_t i = 0; i < contender.ms.size(); ++i) {
      ratio.push_back(contender.ms[i] / contenders[0].ms[i]);
    }
    fmt::print("| {} | {:.1f} | {:.1f} | {:.0f} |\n", contender.name, median(contender.ms),
               median(ratio), median(contender.apart_mm));
  }
}

}  // namespace
}  // namespace fovea::bench

int main(int argc, char** argv) {
  CLI::App app("Registration of a drive's scans beside PCL's and Open3D's", "gicp_bench");
  std::string drive;
  int runs = 3;
  app.add_option("drive", drive, "KITTI drive")->required();
  app.add_option("--runs", runs, "Turns for each scan")->check(CLI::Range(1, 1000));
  CLI11_PARSE(app, argc, argv);
  try {
    fovea::bench::race(fovea::bench::load_bench_data(drive), runs);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "gicp_bench: error: {}\n", error.what());
    return 1;
  }
}
