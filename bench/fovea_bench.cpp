// Times of the stages that have a budget, beside peers where there are any, their results checked.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <malloc.h>

#include <cstdio>
#include <string>
#include <string_view>

#include "bench/bench_data.h"
#include "bench/cgal_peer.h"
#include "bench/duel.h"
#include "bench/mapping_bench.h"
#include "bench/registration_bench.h"
#include "fovea/core/parallel.h"
#include "fovea/core/random.h"
#include "fovea/drive/images/png_decode.h"
#include "fovea/mapping/image_mesh.h"
#include "fovea/surface_samples.h"
#include "fovea/upsample.h"

namespace fovea::bench {
namespace {

void decode(benchmark::State& state, const BenchData& data) {
  const Image image = decode_png(data.png);
  check(image.data == decode_png_by_libpng(data.png).data, "an image unlike libpng's");
  duel(
      state, [&] { return decode_png(data.png).data[0]; },
      [&] { return decode_png_by_libpng(data.png).data[0]; });
  state.counters["MB"] = 1e-6 * static_cast<double>(image.data.size());
}

std::size_t finite_triangles(std::span<const GridPoint> points) {
  DelaunayTriangulation triangulation;
  triangulation.insert(points);
  std::size_t finite = 0;
  for (std::size_t t = 0; t < triangulation.triangle_count(); ++t) {
    finite += triangulation.is_finite(t);
  }
  // Euler: whatever the triangles are, they and the edges of the hull are as many.
  return triangulation.triangle_count() == 2 * triangulation.points().size() - 2 ? finite : 0;
}

void triangulate(benchmark::State& state, const std::vector<GridPoint>& points) {
  const std::size_t triangles = finite_triangles(points);
  check(triangles > 0, "no triangulation");
  const auto ours = [&] {
    DelaunayTriangulation triangulation;
    return triangulation.insert(points)[0];
  };
  if (has_cgal()) {
    check(triangles == cgal_triangles(points), "not as many triangles as CGAL has");
    duel(state, ours, [&] { return cgal_triangles(points); });
  } else {
    solo(state, ours);
  }
  state.counters["points"] = static_cast<double>(points.size());
}

std::vector<GridPoint> random_points(std::int64_t count) {
  Random random(1);
  const auto coordinate = [&] { return static_cast<std::int32_t>(random.below(1 << 26)); };
  std::vector<GridPoint> points;
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int32_t x = coordinate();
    points.push_back({x, coordinate()});
  }
  return points;
}

std::vector<GridPoint> scan_pixels(const BenchData& data) {
  const GridProjection project(data.camera, data.scan_cam.origin);
  std::vector<GridPoint> pixels;
  for (const Eigen::Vector3f& position : data.scan_cam.position) {
    if (const auto pixel = project(position)) pixels.push_back(*pixel);
  }
  return pixels;
}

void densify(benchmark::State& state, const BenchData& data) {
  UpsampleOptions options;
  options.rate = static_cast<int>(state.range(0));
  UpsampleOptions before = options;
  --before.rate;
  const std::size_t points = upsample(data.scan_cam, data.camera, options).size();
  check(points > upsample(data.scan_cam, data.camera, before).size(), "a rate that adds no point");
  solo(state, [&] { return upsample(data.scan_cam, data.camera, options).size(); });
  state.counters["points"] = static_cast<double>(points);
}

/// As the default preset samples a frame that meets an empty map.
void sample(benchmark::State& state, const BenchData& data) {
  std::vector<std::uint32_t> near;
  for (std::uint32_t i = 0; i < data.scan_cam.size(); ++i) {
    if (data.scan_cam.position[i].norm() < 18) near.push_back(i);
  }
  const PointCloud scan = data.scan_cam.select(near);
  const SurfaceOptions options;
  const SampleGrid grid{RigidMotion::Identity(), options.spacing,
                        [](const Eigen::Vector3d&, int) { return false; }};
  const auto ours = [&] { return sample_surfaces(scan, data.camera, options, grid).size(); };
  const std::size_t points = ours();
  check(points > scan.size(), "no sample");
  solo(state, ours);
  state.counters["points"] = static_cast<double>(points);
}

template <class F>
benchmark::internal::Benchmark* add(const std::string& name, F&& run) {
  return benchmark::RegisterBenchmark(name.c_str(), std::forward<F>(run))
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

void add_all(const BenchData& data) {
  add("decode", [&](auto& state) { decode(state, data); });
  add("triangulate/scan", [&](auto& state) { triangulate(state, scan_pixels(data)); });
  add("triangulate/random", [](auto& state) { triangulate(state, random_points(state.range(0))); })
      ->Arg(1'000)
      ->Arg(10'000)
      ->Arg(100'000)
      ->Arg(450'000)
      ->Arg(1'000'000);
  add("upsample/rate", [&](auto& state) { densify(state, data); })->DenseRange(1, 3);
  add("register/thin", [&](auto& state) { bench_thinning(state, data); });
  add("register/normals", [&](auto& state) { bench_normals(state, data); });
  add("register/align", [&](auto& state) { bench_alignment(state, data); });
  add("register/local_map", [&](auto& state) { bench_local_map(state, data); });
  add("sample_surfaces", [&](auto& state) { sample(state, data); });
  const auto street = map_street(data);
  add("map/render", [street](auto& state) { bench_render(state, *street); });
  add("map/recolor", [street](auto& state) { bench_recolor(state, *street); });
  add("map/moving", [street](auto& state) { bench_moving(state, *street); });
  add("map/paper_filter", [street](auto& state) { bench_paper_filter(state, *street); });
  add("map/store", [street](auto& state) { bench_store(state, *street); });
  add("chain", [&](auto& state) { bench_chain(state, data); });
}

/// Takes "--drive DIR" or "--drive=DIR" and "--json" out of the arguments.
std::string take_arguments(std::vector<char*>& arguments) {
  static char json[] = "--benchmark_format=json";
  std::string drive;
  std::vector<char*> others;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view argument = arguments[i];
    if (argument == "--drive" && i + 1 < arguments.size()) {
      drive = arguments[++i];
    } else if (argument.starts_with("--drive=")) {
      drive = argument.substr(8);
    } else {
      others.push_back(argument == "--json" ? json : arguments[i]);
    }
  }
  arguments = others;
  return drive;
}

int run(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  const std::string drive = take_arguments(arguments);
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  const ThreadLimit one(1);
  // A program that maps a drive gets there by itself: after some frames glibc keeps what is freed.
  constexpr int kKept = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kKept);
  mallopt(M_TRIM_THRESHOLD, kKept);
  const BenchData data = load_bench_data(drive);
  add_all(data);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace fovea::bench

int main(int argc, char** argv) {
  try {
    return fovea::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "fovea_bench: error: {}\n", error.what());
    return 1;
  }
}
