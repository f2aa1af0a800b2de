#include "fovea/exporting/city/tile_overview.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "../../../../tests/sample_city.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/core/input_file.h"
#include "fovea/exporting/tileset/glb_reader.h"

namespace fovea::tile_overview_test {

TEST(TileOverview, ItsLevelsAreCoarserPicturesOfTheWholeTile) {
  const TemporaryFolder folder;
  const std::filesystem::path map = folder / "tile.fovea", overview = folder / "overview.glb";
  write_sample_tile(map, {0, 0}, 64, 3000);
  write_tile_overview(map, overview, 64);
  const InputFile file(overview, kStreamedFile);
  std::size_t below = read_glb_level(file, 0).size();
  for (std::size_t level = 1; level <= 7; ++level) {
    const double spacing = std::ldexp(0.5, int(level));
    const std::vector<ExportPoint> points = read_glb_level(file, level);
    EXPECT_LE(points.size(), below);
    below = points.size();
    std::set<std::array<int, 3>> cells;
    Eigen::AlignedBox3d box;
    for (const ExportPoint& point : points) {
      const Eigen::Array3d cell = ((point.position.array() + 32) / spacing).floor();
      cells.insert({int(cell.x()), int(cell.y()), int(cell.z())});
      box.extend(point.position);
    }
    EXPECT_GE(cells.size(), points.size() - points.size() / 100) << "one point in a cell";
    EXPECT_GT(box.sizes().minCoeff(), 48 - 2 * spacing) << "of the whole tile";
  }
  EXPECT_GE(below, 1u);
  EXPECT_LE(below, 2u);  // the points are 48 m high
}

}  // namespace fovea::tile_overview_test
