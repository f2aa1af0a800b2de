#include "fovea/pipeline/map_light.h"

#include <gtest/gtest.h>

namespace fovea::map_light_test {

MapDifferences differences(float stops, int count) {
  MapDifferences all;
  for (int i = 0; i < count; ++i) {
    all.recent.add(Eigen::Array3f::Constant(256 * stops + float(i % 11 - 5)));
    all.colors.add(Eigen::Array3f::Constant(2600));
    all.ground.add(Eigen::Array3f::Constant(2600));
  }
  return all;
}

MapDifferences with_earlier(MapDifferences recent, std::size_t submap, float stops, int count) {
  recent.earlier[submap] = differences(stops, count).recent;
  return recent;
}

/// Opens submaps, 10 m apart, up to a number of them.
void drive_on(std::size_t submaps, MapLight& light, TileMap& map) {
  while (map.submaps().size() < submaps) {
    const RigidMotion T(Eigen::Translation3d(10.0 * double(map.submaps().size()), 0, 0));
    map.add_submap(T);
    light.follow(map.submaps().size() - 1, T, map);
  }
}

float gain(const MapLight& light, const ViewRecord& view, std::size_t submap) {
  return light.light(view, submap).gain[1];
}

TEST(MapLight, TheFirstImageHasTheExposureOfTheMap) {
  TileMap map;
  MapLight light;
  drive_on(1, light, map);
  EXPECT_EQ(gain(light, light.next(2, {}, {}, map), 0), 0);
  EXPECT_NEAR(gain(light, light.next(2, differences(1, 1000), {}, map), 0), 1, 0.01);
}

TEST(MapLight, AnImageOfNothingHasTheGainBefore) {
  TileMap map;
  MapLight light;
  drive_on(1, light, map);
  light.next(2, {}, {}, map);
  light.next(2, differences(-0.5f, 1000), {}, map);
  EXPECT_NEAR(gain(light, light.next(2, differences(3, 20), {}, map), 0), -0.5, 0.01);
  EXPECT_EQ(gain(light, light.next(3, {}, {}, map), 0), 0);  // another camera
}

TEST(MapLight, ARevisitedPlaceBringsTheSubmapsTogether) {
  TileMap map;
  MapLight light;
  drive_on(40, light, map);
  // The image is 0.1 stops above the recent points and 0.3 above those of submap 1: these are
  // darker by 0.2 stops.
  const ViewRecord view =
      light.next(2, with_earlier(differences(0.1f, 2000), 1, 0.3f, 3000), {}, map);
  ASSERT_TRUE(view.revisit);
  EXPECT_EQ(view.revisit->submap, 1);
  const float difference = map.submaps()[1].log2_gain[1] - map.submaps()[39].log2_gain[1];
  EXPECT_NEAR(difference, 0.2, 0.03);
  // One comparison a submap.
  EXPECT_FALSE(
      light.next(2, with_earlier(differences(0.1f, 2000), 1, 0.3f, 3000), {}, map).revisit);
}

TEST(MapLight, FewPointsAreNoRevisitedPlace) {
  TileMap map;
  MapLight light;
  drive_on(40, light, map);
  EXPECT_FALSE(
      light.next(2, with_earlier(differences(0.1f, 2000), 1, 0.3f, 1500), {}, map).revisit);
}

TEST(MapLight, WithoutRecentPointsTheEarlierOnesGiveTheGain) {
  TileMap map;
  MapLight light;
  drive_on(40, light, map);
  const ViewRecord view = light.next(2, with_earlier({}, 1, 0.3f, 3000), {}, map);
  EXPECT_NEAR(gain(light, view, 39), 0.3, 0.01);
  EXPECT_FALSE(view.revisit);
}

TEST(MapLight, ContinuesAnEarlierRun) {
  TileMap map, resumed_map;
  MapLight light, resumed;
  drive_on(30, light, map);
  drive_on(30, resumed, resumed_map);
  for (const MapDifferences& seen :
       {differences(0.4f, 800), with_earlier(differences(0.1f, 2000), 1, 0.3f, 3000)}) {
    resumed.replay(light.next(2, seen, {}, map), {}, resumed_map);
  }
  drive_on(31, light, map);
  drive_on(31, resumed, resumed_map);
  EXPECT_EQ(light.next(2, {}, {}, map), resumed.next(2, {}, {}, resumed_map));
  for (std::size_t k = 0; k < map.submaps().size(); ++k) {
    EXPECT_TRUE((map.submaps()[k].log2_gain == resumed_map.submaps()[k].log2_gain).all()) << k;
  }
}

}  // namespace fovea::map_light_test
