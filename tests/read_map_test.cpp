// docs/read_map.py reads a map as its page tells, without this library.
#include <gtest/gtest.h>

#include "fovea/map/map_store.h"
#include "tests/program.h"
#include "tests/sample_map.h"

namespace fovea::read_map_test {

TEST(ReadMap, AScriptInAnotherLanguageReadsEveryColouredPoint) {
  const TemporaryFolder folder;
  const auto map = folder / "a.fovea", text = folder / "points.txt";
  write_sample_map(map);
  // The package is Debian's, and so is its Python.
  const std::string command = "/usr/bin/python3 '" FOVEA_SOURCE_DIR "/docs/read_map.py' '" +
                              map.string() + "' > '" + text.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);

  std::ifstream lines(text);
  const MapReader reader(map);
  const std::vector<RigidMotion> T_local_submap = reader.submaps();
  std::size_t points = 0;
  reader.for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      if (tile.camera[i] == kNoCamera) continue;
      Eigen::Vector3d p_local;
      int red = 0, green = 0, blue = 0;
      ASSERT_TRUE(lines >> p_local.x() >> p_local.y() >> p_local.z() >> red >> green >> blue);
      const Eigen::Vector3d expected =
          T_local_submap[submap] * (tile.origin + tile.position[i].cast<double>());
      EXPECT_LT((p_local - expected).cwiseAbs().maxCoeff(), 6e-5);
      EXPECT_EQ(red, to_rgb(tile.color[i]).r);
      EXPECT_EQ(green, to_rgb(tile.color[i]).g);
      EXPECT_EQ(blue, to_rgb(tile.color[i]).b);
      ++points;
    }
  });
  EXPECT_EQ(points, reader.colored_size());
  std::string rest;
  EXPECT_FALSE(lines >> rest);
}

}  // namespace fovea::read_map_test
