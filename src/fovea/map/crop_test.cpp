#include "fovea/map/crop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::crop_test {

TEST(CropRegion, ABoxHoldsItsBorders) {
  const CropRegion box = CropRegion::box("-1,0,2, 3,4,5.5");
  EXPECT_TRUE(box.contains({-1, 0, 2}));
  EXPECT_TRUE(box.contains({3, 4, 5.5}));
  EXPECT_TRUE(box.contains({0, 2, 3}));
  EXPECT_FALSE(box.contains({-1.001, 2, 3}));
  EXPECT_FALSE(box.contains({0, 4.001, 3}));
  EXPECT_FALSE(box.contains({0, 2, 1.999}));
  EXPECT_FALSE(box.contains({std::nan(""), 2, 3}));
  EXPECT_EQ(box.text(), "box -1,0,2, 3,4,5.5");
}

TEST(CropRegion, APolygonMayHaveBaysAndAnyHeight) {
  const CropRegion bay = CropRegion::polygon("0,0 4,0 4,4 2,1 0,4");
  EXPECT_TRUE(bay.contains({0.5, 2, -100}));
  EXPECT_TRUE(bay.contains({3.5, 2, 1e9}));
  EXPECT_TRUE(bay.contains({2, 0.5, 0}));
  EXPECT_FALSE(bay.contains({2, 2, 0}));  // the bay
  EXPECT_FALSE(bay.contains({-0.1, 1, 0}));
  EXPECT_FALSE(bay.contains({5, 1, 0}));
}

TEST(CropRegion, RefusesWhatIsNoRegion) {
  for (const char* text : {"", "1,2,3", "a,b,c,d,e,f", "0,0,0,1,1,0", "1,0,0,0,1,1",
                           "0,0,0,1,1,inf", "0,0,0,1,1,1,1"}) {
    EXPECT_THROW(CropRegion::box(text), ConfigError) << text;
  }
  for (const char* text : {"", "0,0 1,1", "0,0 1,1 2", "0,0 1,nan 2,2", "x"}) {
    EXPECT_THROW(CropRegion::polygon(text), ConfigError) << text;
  }
}

TEST(Crop, KeepsThePointsInsideWithAllThatIsKnownOfThem) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const MapReader whole(folder / "a.fovea");
  const CropRegion region = CropRegion::polygon("0,0 30,-5 25,60 5,50");
  const CropFigures figures =
      crop_map(whole, region, *MapWriter::create(folder / "b.fovea", false));
  EXPECT_GT(figures.points, 300u);
  EXPECT_GT(figures.left_out, 300u);
  EXPECT_EQ(figures.points + figures.left_out, whole.size());

  const MapReader part(folder / "b.fovea");
  EXPECT_EQ(part.size(), figures.points);
  EXPECT_EQ(part.frames().size(), whole.frames().size());
  EXPECT_EQ(part.meta().at("crop"), region.text());
  EXPECT_EQ(part.meta().at("config"), whole.meta().at("config"));
  // `frame` numbers the points of each submap.
  std::map<std::pair<std::size_t, int>, Eigen::Vector3f> kept;
  part.for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
    for (std::size_t i = 0; i < tile.size(); ++i) kept[{submap, tile.frame[i]}] = tile.position[i];
  });
  const std::vector<RigidMotion> T_local_submap = whole.submaps();
  whole.for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const bool inside =
          region.contains(T_local_submap[submap] * (tile.origin + tile.position[i].cast<double>()));
      const auto found = kept.find({submap, tile.frame[i]});
      ASSERT_EQ(found != kept.end(), inside);
      if (inside) {
        EXPECT_EQ(found->second, tile.position[i]);
      }
    }
  });
  // The same region again changes nothing more.
  crop_map(part, region, *MapWriter::create(folder / "c.fovea", false));
  EXPECT_EQ(MapReader(folder / "c.fovea").digest(), part.digest());
}

TEST(Crop, AnEmptyPartIsAMap) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const CropFigures figures =
      crop_map(MapReader(folder / "a.fovea"), CropRegion::box("1000,0,0,1001,1,1"),
               *MapWriter::create(folder / "b.fovea", false));
  EXPECT_EQ(figures.points, 0u);
  EXPECT_EQ(MapReader(folder / "b.fovea").size(), 0u);
}

}  // namespace fovea::crop_test
