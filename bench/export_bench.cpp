// Exports of a large map: time, peak memory and bytes of `fovea export`, a process each. The map is
// made here: a street of 2 cm samples, as many as wanted. Fails if an export fails, has another
// number of points or takes more than a GiB of memory.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "fovea/core/random.h"
#include "fovea/errors.h"
#include "fovea/map/map_store.h"

namespace {

using namespace fovea;
namespace fs = std::filesystem;

constexpr double kTileSize = 4, kSpacing = 0.02;
constexpr int kSamples = 200;         // along a tile's edge
constexpr int kTilesAcross = 10;      // of the street
constexpr int kColumnsPerSubmap = 5;  // 20 m of drive
constexpr double kPeakLimit = 1024;   // MiB

/// 4 m x 4 m of wavy ground with noise, in the order in which scans would bring it: none.
PointCloud street_tile(const TileKey& key, std::size_t count, Random& random) {
  PointCloud tile;
  tile.origin = kTileSize * Eigen::Vector3d(key.x, key.y, key.z);
  for (std::size_t i = 0; i < count; ++i) {
    const auto cell = static_cast<int>(i);
    const double x = kSpacing * (cell % kSamples + random.uniform()),
                 y = kSpacing * (double(cell / kSamples) + random.uniform());
    const double wave = std::sin(0.3 * (tile.origin.x() + x)) + std::sin(tile.origin.y() + y);
    tile.position.push_back(
        Eigen::Vector3d(x, y, 2 + 0.5 * wave + random.uniform(-0.01, 0.01)).cast<float>());
    const auto shade = static_cast<std::uint8_t>(128 + 50 * wave + random.uniform(0, 20));
    tile.color.push_back({shade, static_cast<std::uint8_t>(shade / 2), 90});
    tile.range.push_back(static_cast<float>(random.uniform(3, 18)));
    tile.frame.push_back(key.x);
  }
  tile.incidence.assign(count, 0.7f);
  tile.intensity.assign(count, 0.3f);
  tile.camera.assign(count, 2);
  tile.interpolated.assign(count, 1);
  tile.views.assign(count, 9);
  tile.spread.assign(count, 4);
  tile.weight.assign(count, 100);
  tile.reason.assign(count, 1);
  return tile;
}

void write_street(const fs::path& path, std::size_t points) {
  const auto writer = MapWriter::create(path, true);
  writer->put_meta("map.tile_size_m", "4");
  writer->put_meta("georeferenced", "1");
  writer->put_meta("origin.latitude_deg", "49.0093");
  writer->put_meta("origin.longitude_deg", "8.4371");
  writer->put_meta("origin.height_m", "114.5");
  Random random(1);
  for (int x = 0; points > 0; ++x) {
    FrameRecord frame;
    frame.index = x;
    frame.stamp = TimeNs{1'317'046'453} * kNsPerSecond + x * kNsPerSecond / 10;
    writer->put_frame(frame);
    const auto submap = static_cast<std::size_t>(x / kColumnsPerSubmap);
    if (x % kColumnsPerSubmap == 0) writer->put_submap(submap, RigidMotion::Identity());
    for (int y = 0; y < kTilesAcross && points > 0; ++y) {
      const TileKey key{x, y, 0};
      const std::size_t count = std::min(points, std::size_t{kSamples} * kSamples);
      writer->put_tile({submap, key}, street_tile(key, count, random));
      points -= count;
    }
    if (x % kColumnsPerSubmap == kColumnsPerSubmap - 1) writer->commit();
  }
  writer->commit();
}

struct Run {
  double seconds = 0, cpu_seconds = 0, peak_mib = 0;
};

/// Runs a program to its end; std::runtime_error if it fails.
Run run(const std::vector<std::string>& command) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = ::fork();
  if (child == 0) {
    ::execv(words[0], words.data());
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  if (child < 0 || ::wait4(child, &status, 0, &usage) != child || status != 0) {
    throw std::runtime_error(fmt::format("failed: {}", fmt::join(command, " ")));
  }
  const auto time = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
          time(usage.ru_utime) + time(usage.ru_stime), double(usage.ru_maxrss) / 1024};
}

std::uintmax_t bytes_of(const fs::path& path) {
  if (!fs::is_directory(path)) return fs::file_size(path);
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  return bytes;
}

void measure(const std::string& fovea, const fs::path& map, const std::string& format,
             const std::string& crs, std::size_t points) {
  const fs::path output = map.parent_path() / ("street." + format);
  std::vector<std::string> command = {fovea,      "export", map.string(), output.string(),
                                      "--format", format,   "--force",    "--quiet"};
  if (!crs.empty()) command.insert(command.end(), {"--crs", crs});
  const Run figures = run(command);
  const std::uintmax_t bytes = bytes_of(output);
  fmt::print(
      "{:8} {:6} {:8.1f} s {:8.1f} s CPU {:7.0f} MiB peak {:8.1f} MB {:6.1f} bytes a point\n",
      format, crs, figures.seconds, figures.cpu_seconds, figures.peak_mib, 1e-6 * double(bytes),
      double(bytes) / double(points));
  std::fflush(stdout);
  fs::remove_all(output);
  // Header, records and 49 bytes a point.
  if (format == "las" && (bytes < 49 * points || bytes > 49 * points + 10'000)) {
    throw std::runtime_error("the LAS file has another number of points");
  }
  // 16 bytes a point in the leaves alone.
  if (format == "3dtiles" && bytes < 16 * points) {
    throw std::runtime_error("the tileset has fewer points");
  }
  if (figures.peak_mib > kPeakLimit) throw std::runtime_error("an export took over 1 GiB");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Time and peak memory of exports of a large map");
  std::string fovea, folder;
  std::size_t points = 100'000'000;
  std::vector<std::string> formats = {"ply", "las", "las:utm", "3dtiles"};
  app.add_option("FOVEA", fovea, "The program")->required();
  app.add_option("-o", folder, "Folder for the map and its exports, which go as they are measured")
      ->required();
  app.add_option("--points", points, "Of the map");
  app.add_option("--formats", formats, "FORMAT or FORMAT:CRS")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  try {
    fs::create_directories(folder);
    const fs::path map = fs::path(folder) / "street.fovea";
    const auto begin = std::chrono::steady_clock::now();
    write_street(map, points);
    fmt::print("a map of {} points, {:.1f} MB, made in {:.0f} s\n", points,
               1e-6 * double(fs::file_size(map)),
               std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    std::fflush(stdout);
    for (const std::string& format : formats) {
      const std::size_t colon = std::min(format.find(':'), format.size());
      measure(fovea, map, format.substr(0, colon),
              colon < format.size() ? format.substr(colon + 1) : "", points);
    }
    fs::remove(map);
  } catch (const std::exception& error) {
    fmt::print(stderr, "export_bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
