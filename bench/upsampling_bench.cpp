// Upsampling beside PCL's moving least squares, the paper's Table I: the same LiDAR scan, about the
// same number of points produced, in turns in one process.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/drive_arguments.h"
#include "bench/mls_peer.h"
#include "fovea/core/output_file.h"
#include "fovea/core/parallel.h"
#include "fovea/core/path_name.h"
#include "fovea/errors.h"
#include "fovea/upsample.h"
#include "tools/paper/upsampling_times.h"

namespace fovea::bench {
namespace {

using Json = nlohmann::ordered_json;

/// Points produced may differ from those wanted by this share.
constexpr double kTolerance = 0.05;

constexpr std::array kThreads{1, 2};

/// Somebody's way to upsample one column's points.
struct Contender {
  std::string method;  ///< "fovea", "local plane", "uniform density"
  std::size_t given = 0;
  std::function<MlsRun(int threads)> run;
  std::size_t points = 0;                           ///< produced
  std::array<std::vector<double>, 2> seconds = {};  ///< of each run, by kThreads

  double median(std::size_t threads) const {
    std::vector<double> sorted = seconds[threads];
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
  }
};

std::vector<float> flat(const PointCloud& cloud, std::size_t count) {
  std::vector<float> xyz;
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) xyz.push_back(cloud.position[i][axis]);
  }
  return xyz;
}

/// About the smallest number in (0, most] that gives `wanted` points, for what grows with it. From
/// below: what is far too much takes minutes.
std::size_t least_that_gives(std::size_t wanted, std::size_t most,
                             const std::function<std::size_t(std::size_t)>& produced) {
  std::size_t low = 0, high = std::min<std::size_t>(most, 16);
  while (high < most && produced(high) < wanted) {
    low = high;
    high = std::min(most, 2 * high);
  }
  while (high - low > high / 200 + 1) {
    const std::size_t middle = low + (high - low) / 2;
    (produced(middle) < wanted ? low : high) = middle;
  }
  return high;
}

/// The coarsest grid in the disc that the scan's points are enough for, and as many of these as it
/// takes.
Contender local_plane(const PointCloud& scan, std::size_t wanted, MlsOptions options) {
  options.method = MlsMethod::kLocalPlane;
  double ratio = 1.5;  // of the disc's radius to the grid's step
  const auto samples = [&] { return samples_in_disc(options.sample_radius, options.sample_step); };
  do {
    options.sample_step = options.sample_radius / ratio;
    ratio += 0.5;
  } while (static_cast<double>(wanted) > 0.9 * samples() * static_cast<double>(scan.size()));
  const std::vector<float> xyz = flat(scan, scan.size());
  const std::size_t given = least_that_gives(wanted, scan.size(), [&](std::size_t count) {
    return run_mls(xyz.data(), count, options).points;
  });
  return {"local plane", given, [xyz, given, options](int threads) mutable {
            options.threads = threads;
            return run_mls(xyz.data(), given, options);
          }};
}

/// From the very points that Fovea is given.
Contender uniform_density(const PointCloud& points, std::size_t wanted, MlsOptions options) {
  options.method = MlsMethod::kUniformDensity;
  const std::vector<float> xyz = flat(points, points.size());
  constexpr std::size_t kDensest = 1'000'000;
  options.points_in_radius =
      static_cast<int>(least_that_gives(wanted, kDensest, [&](std::size_t count) {
        options.points_in_radius = static_cast<int>(count);
        return run_mls(xyz.data(), points.size(), options).points;
      }));
  const std::size_t given = points.size();
  return {"uniform density", given, [xyz, given, options](int threads) mutable {
            options.threads = threads;
            return run_mls(xyz.data(), given, options);
          }};
}

/// @param given, camera  must outlive the contender
Contender fovea(const paper::UpsamplingCase& given, const Camera& camera) {
  UpsampleOptions options;
  options.rate = given.rate;
  return {"fovea", given.points_cam.size(), [&given, &camera, options](int threads) {
            const ThreadLimit limit(threads);
            const auto start = std::chrono::steady_clock::now();
            MlsRun run;
            run.points = upsample(given.points_cam, camera, options).size();
            run.seconds =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            return run;
          }};
}

/// In turns, so that what else the machine does falls on all alike.
void race(std::vector<Contender>& contenders, int runs, std::size_t wanted) {
  for (int run = 0; run < runs; ++run) {
    for (std::size_t t = 0; t < kThreads.size(); ++t) {
      for (Contender& contender : contenders) {
        // OpenMP's threads spin for a while after their work and would slow down who is next.
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
        const MlsRun result = contender.run(kThreads[t]);
        contender.points = result.points;
        contender.seconds[t].push_back(result.seconds);
        const double off = static_cast<double>(result.points) / static_cast<double>(wanted) - 1;
        if (result.finite && std::abs(off) <= kTolerance) continue;
        throw InputError(
            fmt::format("{} made {} points of {} wanted", contender.method, result.points, wanted),
            "benchmark", "give a drive with denser scans");
      }
    }
  }
}

/// Prints a column of the table and returns it. Fovea is the first contender.
Json report(const paper::UpsamplingCase& given, const std::vector<Contender>& contenders) {
  Json column{{"points", given.wanted}, {"rate", given.rate}, {"results", Json::array()}};
  for (std::size_t t = 0; t < kThreads.size(); ++t) {
    for (const Contender& c : contenders) {
      const double seconds = c.median(t), times = seconds / contenders.front().median(t);
      fmt::print("| {} | {} | {} | {} | {} | {:.1f} | {:.1f} |\n", given.wanted, c.method,
                 kThreads[t], c.given, c.points, 1000 * seconds, times);
      column["results"].push_back({{"method", c.method},
                                   {"threads", kThreads[t]},
                                   {"given", c.given},
                                   {"produced", c.points},
                                   {"seconds", seconds},
                                   {"times_fovea", times}});
    }
  }
  std::fflush(stdout);
  return column;
}

/// All points of the scan, in its order, at the rates of the paper's Table II.
std::vector<paper::UpsamplingCase> whole_scan_cases(const FrameSource& drive,
                                                    const Camera& camera) {
  const PointCloud scan = paper::scan_in_view(drive);
  std::vector<paper::UpsamplingCase> cases;
  for (int rate = 1; rate <= 3; ++rate) {
    paper::UpsamplingCase given{0, rate, scan};
    given.wanted = static_cast<int>(fovea(given, camera).run(1).points);
    cases.push_back(std::move(given));
  }
  return cases;
}

struct Arguments {
  app::DriveArguments drive;
  std::string json;
  int runs = 5;
  MlsOptions mls;
};

void run(const Arguments& arguments) {
  std::optional<OutputFile> file;
  if (!arguments.json.empty()) file.emplace(arguments.json, /*force=*/true);
  const auto drive = arguments.drive.open();
  const Camera& camera = drive->info().calibration.cameras.at(0);
  const PointCloud scan = paper::shuffled_scan(*drive);
  Json json{{"drive", name_of(arguments.drive.drive)},
            {"runs", arguments.runs},
            {"search_radius", arguments.mls.search_radius},
            {"polynomial_order", arguments.mls.polynomial_order},
            {"columns", Json::array()},
            {"whole_scan", Json::array()}};
  fmt::print(
      "| points | method | threads | given | produced | ms | times Fovea |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n");
  const auto race_all = [&](const char* key, const std::vector<paper::UpsamplingCase>& cases) {
    for (const paper::UpsamplingCase& given : cases) {
      const auto wanted = static_cast<std::size_t>(given.wanted);
      std::vector<Contender> contenders{fovea(given, camera),
                                        local_plane(scan, wanted, arguments.mls),
                                        uniform_density(given.points_cam, wanted, arguments.mls)};
      race(contenders, arguments.runs, wanted);
      json[key].push_back(report(given, contenders));
    }
  };
  race_all("columns", paper::upsampling_cases(*drive));
  race_all("whole_scan", whole_scan_cases(*drive, camera));
  if (!file) return;
  file->stream() << json.dump(2) << "\n";
  file->commit();
}

}  // namespace
}  // namespace fovea::bench

int main(int argc, char** argv) {
  fovea::bench::Arguments arguments;
  CLI::App app("Upsampling beside PCL's moving least squares, on the middle scan of a drive");
  app.add_option("DRIVE", arguments.drive.drive, "KITTI drive")->required();
  app.add_option("--cameras", arguments.drive.cameras, "Camera (default: 2)")->type_name("K");
  app.add_option("--json", arguments.json, "For fovea reproduce --mls")->type_name("FILE");
  app.add_option("--runs", arguments.runs, "Of which the median counts")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_option("--search-radius", arguments.mls.search_radius,
                 "m, of MLS's neighbourhoods (default: Fovea's tau)")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--order", arguments.mls.polynomial_order,
                 "Of MLS's surfaces; 1 is a plane, 2 PCL's default")
      ->capture_default_str()
      ->check(CLI::Range(1, 5));
  CLI11_PARSE(app, argc, argv);
  try {
    fovea::bench::run(arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "upsampling_bench: error: {}\n", error.what());
    return 1;
  }
  return 0;
}
