// Maps of one wall a submap, in colors that are known.
#include "fovea/merging/map_gain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/map/meta_keys.h"

namespace fovea::map_gain_test {

namespace fs = std::filesystem;

constexpr double kStep = 0.02;

/// A wall of a submap: the submaps stand 4 m apart.
struct Wall {
  double height = 1;  ///< m; it is 1 m wide
  std::uint8_t gray = 100;
};

class MapGain : public testing::Test {
 protected:
  MapReader map_of(const std::string& name, const std::vector<Wall>& walls) const {
    const fs::path path = folder_ / (name + ".fovea");
    const auto writer = MapWriter::create(path, true);
    writer->put_meta(meta_key::kTileSize, "4");
    writer->put_meta(meta_key::kDriveName, name);
    writer->put_meta(meta_key::kComplete, "1");
    for (std::size_t submap = 0; submap < walls.size(); ++submap) {
      writer->put_submap(submap, RigidMotion::Identity());
      const TileKey key{int(submap), 0, 0};
      writer->put_tile({submap, key}, tile_of(walls[submap], 4.0 * double(submap)));
    }
    writer->finish();
    return MapReader(path);
  }

  /// @param east  of the wall's tile, m
  static TilePoints tile_of(const Wall& wall, double east) {
    std::vector<Eigen::Vector3f> positions;
    for (double north = 0.01; north < 1; north += kStep) {
      for (double up = 0.01; up < wall.height; up += kStep) {
        positions.emplace_back(2, float(north), float(up));
      }
    }
    PointCloud points = one_point_each(positions);
    points.origin = Eigen::Vector3d(east, 0, 0);
    TilePoints tile = TilePoints::of(points);
    for (FusedColor& color : tile.colors) {
      color.color = LogColor(wall.gray, wall.gray, wall.gray);
      color.views = 2;
    }
    return tile;
  }

  static SubmapMatch match(std::size_t submap_a, std::size_t submap_b) {
    SubmapMatch match;
    match.submap_a = submap_a;
    match.submap_b = submap_b;
    return match;
  }

  TemporaryFolder folder_;
};

TEST_F(MapGain, OfASubmapIsThatOfMostSurfacesAround) {
  const MapReader a = map_of("a", {{}, {}, {}});
  const MapReader b = map_of("b", {{.gray = 120}, {.height = 0.5, .gray = 60}, {.gray = 120}});
  std::vector<SubmapMatch> matches{match(0, 0), match(1, 1), match(2, 2)};
  set_gains(a, b, matches);
  for (const SubmapMatch& match : matches) {
    ASSERT_TRUE(match.log2_gain);
    EXPECT_NEAR((*match.log2_gain)[0], std::log2(1.2), 0.01);  // also in the shadow of submap 1
  }
}

TEST_F(MapGain, GoesToTheMatchWithTheMostSurfaces) {
  const MapReader a = map_of("a", {{}});
  const MapReader b = map_of("b", {{.gray = 120}});
  std::vector<SubmapMatch> matches{match(0, 0), match(0, 0)};
  matches[0].T_a_b.translation().z() = 0.9;  // only the upper tenth of A's wall
  matches[0].overlap = 1;
  set_gains(a, b, matches);
  EXPECT_FALSE(matches[0].log2_gain);
  EXPECT_TRUE(matches[1].log2_gain);
}

TEST_F(MapGain, IsAbsentWithoutCommonSurfaces) {
  const MapReader a = map_of("a", {{}});
  const MapReader b = map_of("b", {{}});
  std::vector<SubmapMatch> matches{match(0, 0)};
  matches[0].T_a_b.translation().z() = 5;
  set_gains(a, b, matches);
  EXPECT_FALSE(matches[0].log2_gain);
}

}  // namespace fovea::map_gain_test
