// Writes maps for tests/web: map.fovea, a small georeferenced one, with points.json, what its
// exports must hold; plain.fovea, a large one with known distances; city/, three tiles; and
// large_city/, of more tiles than one tileset has.
#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/sample_city.h"
#include "tests/sample_map.h"

namespace {

using namespace fovea;

/// Frames 0 to 9, from 26 September 2011, 14:14:13 of the drive's clock on.
std::vector<FrameRecord> dated_frames() {
  std::vector<FrameRecord> frames(10);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].index = static_cast<int>(i);
    frames[i].stamp = TimeNs{1'317'046'453} * kNsPerSecond + TimeNs(i) * kNsPerSecond / 10;
  }
  return frames;
}

/// The sample map's points, of these ten frames.
TileMap map_points() {
  Random random(11);
  TileMap map(4.0);
  for (int submap = 0; submap < 2; ++submap) {
    map.add_submap(exp_se3(
        (Twist() << 0.01, -0.02, 1.0 / 3 + submap, 100.0 / 7, 50.0 * submap, 1e-3).finished()));
    PointCloud points = random_map_points(2000, random, 12.0);
    points.origin = {10, 50.0 * submap, 0};
    for (std::int32_t& frame : points.frame) frame %= 10;
    map.add(points);
  }
  return map;
}

nlohmann::json point_json(const Eigen::Vector3d& p_local, const PointCloud& tile, std::size_t i) {
  return {{"local", {p_local.x(), p_local.y(), p_local.z()}},
          {"color", {to_rgb(tile.color[i]).r, to_rgb(tile.color[i]).g, to_rgb(tile.color[i]).b}},
          {"camera", tile.camera[i]},
          {"frame", tile.frame[i]},
          {"range", tile.range[i]},
          {"intensity", tile.intensity[i]},
          {"interpolated", tile.interpolated[i]},
          {"views", tile.views[i]},
          {"spread", tile.spread[i]},
          {"reason", tile.reason[i]}};
}

void write(const std::filesystem::path& folder) {
  const TileMap map = map_points();
  const auto writer = MapWriter::create(folder / "map.fovea", true);
  writer->put_meta("map.tile_size_m", "4");
  writer->put_meta("georeferenced", "1");
  writer->put_meta("origin.latitude_deg", "49.011212804408");
  writer->put_meta("origin.longitude_deg", "8.4228850417969");
  writer->put_meta("origin.height_m", "112.83492279053");
  for (const FrameRecord& frame : dated_frames()) writer->put_frame(frame);
  nlohmann::json points = nlohmann::json::array();
  for (std::size_t id = 0; id < map.submaps().size(); ++id) {
    const Submap& submap = map.submaps()[id];
    writer->put_submap(id, submap.T_local_submap);
    for (const auto& [key, stored] : submap.tiles) {
      const PointCloud tile = stored.points->cloud();
      writer->put_tile({id, key}, tile);
      for (std::size_t i = 0; i < tile.size(); ++i) {
        if (tile.camera[i] == kNoCamera) continue;
        points.push_back(point_json(
            submap.T_local_submap * (tile.origin + tile.position[i].cast<double>()), tile, i));
      }
    }
  }
  writer->commit();
  std::ofstream(folder / "points.json") << points;
}

constexpr double kTile = 4, kSpacing = 0.02;  // m

/// A tile of a plain: a chequered floor at z = 0, seen by frame x.
PointCloud floor_tile(const TileKey& key) {
  constexpr int kAlong = 200;
  PointCloud tile;
  tile.origin = kTile * Eigen::Vector3d(key.x, key.y, key.z);
  for (int i = 0; i < kAlong * kAlong; ++i) {
    const float x = static_cast<float>(kSpacing * (i % kAlong) + 0.01),
                y = static_cast<float>(kSpacing * (i / kAlong) + 0.01);
    tile.position.emplace_back(x, y, 0.f);
    const bool dark = (int(x) + int(y)) % 2 == 0;
    tile.color.push_back(dark ? Rgb{70, 90, 70} : Rgb{120, 140, 120});
  }
  return tile;
}

/// A red post of 1 m at the middle of the tile.
void put_post(PointCloud& tile) {
  for (int i = 0; i < 3600; ++i) {
    const double angle = 0.1 * (i % 60), height = i / 60 / 60.0;
    tile.position.push_back(
        Eigen::Vector3d(2 + 0.1 * std::cos(angle), 2 + 0.1 * std::sin(angle), height)
            .cast<float>());
    tile.color.push_back({255, 0, 0});
  }
}

void fill_columns(PointCloud& tile, int frame) {
  const std::size_t n = tile.size();
  tile.range.assign(n, 8.f);
  tile.incidence.assign(n, 0.5f);
  tile.frame.assign(n, frame);
  tile.camera.assign(n, 2);
  tile.interpolated.assign(n, 1);
  tile.views.assign(n, 3);
  tile.spread.assign(n, 4);
  tile.weight.assign(n, 100);
  tile.reason.assign(n, 1);
}

/// 100 m x 20 m with 5 million points, from x = 0 and around y = 0, and two posts 20 m apart: at
/// (10, -4) and (26, 8). A frame each metre along the middle, 1.7 m above the floor.
void write_plain(const std::filesystem::path& folder) {
  const auto writer = MapWriter::create(folder / "plain.fovea", true);
  writer->put_meta("map.tile_size_m", "4");
  for (int i = 0; i < 100; ++i) {
    FrameRecord frame;
    frame.index = i;
    frame.stamp = from_seconds(0.1 * i);
    frame.T_local_lidar.translation() = Eigen::Vector3d(i, 0, 1.7);
    writer->put_frame(frame);
  }
  writer->put_submap(0, RigidMotion(Eigen::Translation3d(0, -2, 0)));
  for (int x = 0; x < 25; ++x) {
    for (int y = -2; y <= 2; ++y) {
      PointCloud tile = floor_tile({x, y, 0});
      if ((x == 2 && y == -1) || (x == 6 && y == 2)) put_post(tile);
      fill_columns(tile, std::min(4 * x, 99));
      writer->put_tile({0, {x, y, 0}}, tile);
    }
  }
  writer->commit();
}

std::vector<CityTile> square_of_tiles(int edge) {
  std::vector<CityTile> tiles;
  for (int x = 0; x < edge; ++x) {
    for (int y = 0; y < edge; ++y) tiles.push_back({x, y});
  }
  return tiles;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: write_test_map FOLDER\n");
    return 2;
  }
  write(argv[1]);
  write_plain(argv[1]);
  fovea::write_sample_city(std::filesystem::path(argv[1]) / "city", {{0, 0}, {1, 0}, {0, 1}});
  fovea::write_repeated_city(std::filesystem::path(argv[1]) / "large_city", square_of_tiles(17),
                             300);
  return 0;
}
