// Writes a small georeferenced map, and as JSON what its exports must hold: for tests/web.
#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

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
          {"color", {tile.color[i].r, tile.color[i].g, tile.color[i].b}},
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
  writer->put_meta("map.tile_size", "4");
  writer->put_meta("georeferenced", "1");
  writer->put_meta("origin.latitude", "49.011212804408");
  writer->put_meta("origin.longitude", "8.4228850417969");
  writer->put_meta("origin.altitude", "112.83492279053");
  for (const FrameRecord& frame : dated_frames()) writer->put_frame(frame);
  nlohmann::json points = nlohmann::json::array();
  for (std::size_t id = 0; id < map.submaps().size(); ++id) {
    const Submap& submap = map.submaps()[id];
    writer->put_submap(id, submap.T_local_submap);
    for (const auto& [key, stored] : submap.tiles) {
      const PointCloud& tile = *stored.points;
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

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: write_test_map FOLDER\n");
    return 2;
  }
  write(argv[1]);
  return 0;
}
