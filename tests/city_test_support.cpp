#include "tests/city_test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "fovea/map/map_store.h"
#include "tests/program.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::vector<fs::path>& paths) {
  std::string text;
  for (const fs::path& path : paths) text += fmt::format(" '{}'", path.string());
  return text;
}

}  // namespace

void adjust_alone(const std::vector<fs::path>& maps, const fs::path& poses) {
  const ProgramRun run =
      run_fovea(fmt::format("adjust{} -o '{}' --quiet", quoted(maps), poses.string()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
}

std::size_t make_city(const fs::path& city, const std::vector<fs::path>& maps,
                      const fs::path& poses, const CityTile& low, const CityTile& high,
                      double tile_size) {
  fs::create_directories(city / "tiles");
  fs::copy_file(poses, city / "poses.json");
  std::size_t tiles = 0;
  for (int x = low.x; x <= high.x; ++x) {
    for (int y = low.y; y <= high.y; ++y) {
      const fs::path tile = city / "tiles" / fmt::format("{}_{}.fovea", x, y);
      const ProgramRun run =
          run_fovea(fmt::format("fuse{} --poses '{}' --tile={},{} --tile-size {} -o '{}' --quiet",
                                quoted(maps), poses.string(), x, y, tile_size, tile.string()));
      if (run.exit_code == 0)
        ++tiles;
      else
        EXPECT_NE(run.err.find("no map has a point in tile"), std::string::npos) << run.err;
    }
  }
  std::vector<std::string> drives;
  for (const fs::path& map : maps) drives.push_back(map.stem().string());
  write_manifest(city, drives, tile_size);
  return tiles;
}

void write_manifest(const fs::path& city, const std::vector<std::string>& drives,
                    double tile_size) {
  nlohmann::ordered_json json = {{"fovea_city", 1}, {"revision", 1}};
  json["origin"] = nlohmann::json::parse(read_text(city / "poses.json")).at("origin");
  json["tile_size_m"] = tile_size;
  json["session"] = "best";
  json["poses"] = "poses.json";
  json["drives"] = nlohmann::json::array();
  for (const std::string& name : drives) {
    json["drives"].push_back({{"name", name},
                              {"path", name},
                              {"length_m", 1.0},
                              {"frames", 1},
                              {"maps", nlohmann::json::array()}});
  }
  json["tiles"] = nlohmann::json::array();
  for (const auto& entry : fs::directory_iterator(city / "tiles")) {
    int x = 0, y = 0;
    const bool is_tile = entry.path().extension() == ".fovea" &&
                         std::sscanf(entry.path().stem().c_str(), "%d_%d", &x, &y) == 2;
    if (!is_tile) continue;
    json["tiles"].push_back({{"x", x},
                             {"y", y},
                             {"file", (fs::path("tiles") / entry.path().filename()).string()},
                             {"points", MapReader(entry.path()).size()},
                             {"bytes", entry.file_size()},
                             {"revision", 1}});
  }
  std::ofstream(city / "city.json") << json.dump(1) << "\n";
}

}  // namespace fovea
