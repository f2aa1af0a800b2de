#include "fovea/pipeline/visible_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fovea/core/parallel.h"
#include "fovea/pipeline/visible_map_test_support.h"

namespace fovea::visible_map_test {

TEST(VisibleMap, AWallGetsTheWeightedMeanOfItsViews) {
  TileMap map = map_of(wall(9, -2, 2, -0.5, 0.5));
  const struct {
    Rgb color;
    RigidMotion T_cam_local;
  } views[] = {{{100, 40, 230}, camera_at(0, 0, 0)},
               {{180, 40, 20}, camera_at(0.5, 0, 4)},
               {{30, 200, 90}, camera_at(-0.5, 0.1, 5)}};
  for (int frame = 0; const auto& [color, T_cam_local] : views) {
    const TestView view(image_of(color), T_cam_local, white_zone(1), ++frame);
    EXPECT_EQ(view.recolor(map), map.size());
  }
  Eigen::Array3d error = Eigen::Array3d::Zero();
  double spread_error = 0;  // codes
  for_each_point(map, [&](const Eigen::Vector3d& p, const PointCloud& tile, std::size_t i) {
    double weight = view_weight(5);
    Eigen::Array3d sum = weight * codes_of(Rgb{1, 2, 3}).cast<double>();
    double squares = weight * codes_of(Rgb{1, 2, 3}).cast<double>().square().sum();
    for (const auto& [color, T_cam_local] : views) {
      const double w = view_weight(static_cast<float>((T_cam_local * p).norm()));
      const Eigen::Array3d seen = codes_of(color).cast<double>();
      sum += w * seen;
      squares += w * seen.square().sum();
      weight += w;
    }
    ASSERT_EQ(tile.views[i], 4);
    ASSERT_NEAR(tile.weight[i], weight, 3);  // distances at steps of the weights
    const Eigen::Array3d mean = sum / weight, found = codes_of(tile.color[i]).cast<double>();
    ASSERT_LT((found - mean).abs().maxCoeff(), 6);
    error += (found - mean) / double(map.size());
    spread_error +=
        (tile.spread[i] * kSpreadStep - std::sqrt((squares / weight - mean.square().sum()) / 3)) /
        double(map.size());
    ASSERT_EQ(tile.frame[i], 0);  // the frame that measured the point
  });
  EXPECT_LT(error.abs().maxCoeff(), 1);
  EXPECT_LT(std::abs(spread_error), 2);
}

// A wall behind a board keeps its colors where the board hides it, whether the board is in the map
// or new.
TEST(VisibleMap, HiddenPointsKeepTheirColors) {
  const std::vector<Eigen::Vector3f> behind = wall(8, -2, 2, -0.8, 0.8);
  const std::vector<Eigen::Vector3f> board = wall(5, -0.5, 0.4, -0.3, 0.3);
  for (const bool board_is_new : {false, true}) {
    TileMap map = map_of(behind);
    if (!board_is_new) map.add(new_points(board));
    const TestView view(image_of({200, 200, 200}));
    PointCloud board_cam;
    if (board_is_new) board_cam.position = board;
    const std::size_t count = view.recolor(map, board_cam);
    std::size_t seen = 0;
    for_each_point(map, [&](const Eigen::Vector3d& p, const PointCloud& tile, std::size_t i) {
      seen += tile.views[i] == 2;
      const double x = p.x() * 5 / 8, y = p.y() * 5 / 8;  // through the board's plane
      const bool at_rim = std::abs(x + 0.5) < 0.06 || std::abs(x - 0.4) < 0.06 ||
                          std::abs(y + 0.3) < 0.06 || std::abs(y - 0.3) < 0.06;
      if (p.z() > 7 && at_rim) return;
      const bool hidden = p.z() > 7 && x > -0.5 && x < 0.4 && y > -0.3 && y < 0.3;
      ASSERT_EQ(tile.views[i], hidden ? 1 : 2) << p.transpose() << " " << board_is_new;
      if (hidden) {
        ASSERT_EQ(tile.color[i], (Rgb{1, 2, 3}));
        ASSERT_EQ(tile.weight[i], view_weight(5));
      } else {
        ASSERT_GT(to_rgb(tile.color[i]).r, 5);
      }
    });
    EXPECT_EQ(count, seen);
  }
}

TEST(VisibleMap, PointsOutsideTheRegionStayAsTheyAre) {
  std::vector<Eigen::Vector3f> positions;
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    positions.push_back(
        Eigen::Vector3d(random.uniform(-15, 15), random.uniform(-5, 5), random.uniform(-15, 15))
            .cast<float>());
  }
  TileMap map = map_of(positions);
  const RigidMotion T_cam_local = exp_se3((Twist() << 0.1, 0.8, 0.05, 1, 0, -2).finished());
  FovealOptions options = white_zone(3, 9);
  options.slices = {{-0.5, 0.2, -0.3, 0.1}, {0.25, 0.6, -0.1, 0.3}};
  const TestView view(image_of({200, 200, 200}), T_cam_local, options);
  const std::size_t count = view.recolor(map);
  std::size_t inside = 0, seen = 0;
  for_each_point(map, [&](const Eigen::Vector3d& p, const PointCloud& tile, std::size_t i) {
    Eigen::Vector2f pixel;
    const bool in_region = view.region.contains((T_cam_local * p).cast<float>(), pixel);
    inside += in_region;
    seen += tile.views[i] == 2;
    if (in_region) return;
    ASSERT_EQ(tile.views[i], 1);
    ASSERT_EQ(tile.color[i], (Rgb{1, 2, 3}));
  });
  EXPECT_EQ(count, seen);
  EXPECT_GT(seen, 100u);
  EXPECT_LE(seen, inside);
}

// The map skips whole tiles outside the view, but none with a point in view.
TEST(VisibleMap, FindsEveryPointInViewWhereverItsTileLies) {
  Random random(5);
  std::size_t all_inside = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Twist twist;
    for (double& value : twist) value = random.uniform(-1.5, 1.5);
    const RigidMotion T_cam_local = exp_se3(twist);
    std::vector<Eigen::Vector3f> positions;  // few, so that they do not hide each other
    for (int i = 0; i < 300; ++i) {
      positions.push_back(
          Eigen::Vector3d(random.uniform(-19, 19), random.uniform(-19, 19), random.uniform(-19, 19))
              .cast<float>());
    }
    TileMap map = map_of(positions);
    const TestView view(image_of({200, 200, 200}), T_cam_local);
    view.recolor(map);
    std::size_t seen = 0, inside = 0;
    for_each_point(map, [&](const Eigen::Vector3d& p, const PointCloud& tile, std::size_t i) {
      Eigen::Vector2f pixel;
      inside += view.region.contains((T_cam_local * p).cast<float>(), pixel);
      seen += tile.views[i] == 2;
    });
    EXPECT_GE(seen + 1, inside) << trial;  // one may hide another
    all_inside += inside;
  }
  EXPECT_GT(all_inside, 150u);
}

// Points in the near blind zone get no color, but hide others.
TEST(VisibleMap, PointsOutsideTheRegionHideOthers) {
  TileMap map = map_of(wall(8, -1, 1, -0.3, 0.3));
  map.add(new_points(wall(2, -1, 1, -0.3, 0.3)));
  const TestView view(image_of({200, 200, 200}), RigidMotion::Identity(), white_zone(4));
  EXPECT_EQ(view.recolor(map), 0u);
}

// Points between the camera and a wall in the map: more than 30 cm and 5 % in front of it.
TEST(VisibleMap, FindsPointsInFrontOfTheMap) {
  const Camera camera = test_camera();
  const FovealRegion region(white_zone(1), camera, kOneLidar);
  const TileMap map = map_of(wall(8, -1, 1, -0.5, 0.5));
  VisibleMap seen;
  seen.render(map, region, RigidMotion::Identity(), kSpacing);
  PointCloud points;
  points.position = {{0, 0, 5},       {0.2f, 0.1f, 7.5f}, {0, 0, 7.7f}, {0, 0, 8},
                     {0, 0, 8.5f},    {-0.3f, 0, 3},      {2, 0, 5},  // next to the wall
                     {0.4f, -0.2f, 4}};
  EXPECT_EQ(seen.find_occluding(points), (std::vector<std::uint8_t>{1, 1, 0, 0, 0, 1, 0, 1}));
  seen.render(TileMap(), region, RigidMotion::Identity(), kSpacing);
  EXPECT_EQ(seen.find_occluding(points), std::vector<std::uint8_t>(8, 0));
}

TEST(VisibleMap, AnEmptyMapAndAViewOfNothingAreNormal) {
  TileMap empty;
  const TestView view(image_of({200, 200, 200}));
  EXPECT_EQ(view.recolor(empty), 0u);
  TileMap behind = map_of(wall(-8, -1, 1, -0.3, 0.3));
  EXPECT_EQ(view.recolor(behind), 0u);
}

TEST(VisibleMap, GivesTheSameAtAnyThreadCount) {
  const auto run = [](int threads) {
    const ThreadLimit limit(threads);
    TileMap map = map_of(wall(8, -3, 3, -1, 1));
    map.add_submap(camera_at(0.3, 0, 0.5));
    map.add(new_points(wall(5, -0.5, 0.4, -0.3, 0.3)));
    Random random(3);
    for (int frame = 0; frame < 4; ++frame) {
      Image image(621, 188, 3);
      for (std::uint8_t& value : image.data) value = static_cast<std::uint8_t>(random.below(256));
      TestView(image, camera_at(0.1 * frame, 0, 0.2 * frame), white_zone(1), frame).recolor(map);
    }
    return map;
  };
  const TileMap one = run(1), two = run(2);
  for (std::size_t id = 0; id < 2; ++id) {
    for (const auto& [key, stored] : one.submaps()[id].tiles) {
      const PointCloud tile = stored.points->cloud();
      expect_same_columns(tile, two.submaps()[id].tiles.at(key).points->cloud());
    }
  }
}

// An image of another exposure than a wall in the map.
TEST(VisibleMap, DifferencesGiveTheGainOfAnImage) {
  TileMap map = map_of(wall(8, -2, 2, -0.8, 0.8));
  TestView(image_of({100, 60, 80})).recolor(map);
  const LogGain first = *gain_of(TestView(image_of({100, 60, 80})).differences(map));
  const auto gain_to_first = [&](const Rgb& color) -> LogGain {
    return *gain_of(TestView(image_of(color)).differences(map)) - first;
  };
  EXPECT_LT((gain_to_first({200, 120, 160}) - 1).abs().maxCoeff(), 1e-3);
  EXPECT_LT((gain_to_first({50, 60, 40}) - LogGain(-1, 0, -1)).abs().maxCoeff(), 1e-3);
}

// A submap counts as left 120 m down the path, however many submaps that makes.
TEST(VisibleMap, DifferencesTellRevisitedSubmapsApart) {
  const Image image = image_of({100, 60, 80});
  const auto differences_on_a_circle = [&](double circumference) {
    TileMap map = map_of(wall(8, -2, 2, -0.8, 0.8));  // submap 0
    TestView(image).recolor(map);
    for (int k = 1; k <= 12; ++k) {
      const double angle = 2 * std::numbers::pi * k / 12;
      const double radius = circumference / (2 * std::numbers::pi);
      map.add_submap(RigidMotion(
          Eigen::Translation3d(5 + radius * std::sin(angle), 0, radius * (1 - std::cos(angle)))));
    }
    const TestView view(image);
    return view.render(map).differences(view.view, /*below=*/1);
  };
  const MapDifferences small = differences_on_a_circle(100), large = differences_on_a_circle(200);
  EXPECT_GT(small.recent.size(), 100u);
  EXPECT_TRUE(small.earlier.empty());
  EXPECT_EQ(large.recent.size(), 0u);
  EXPECT_EQ(large.earlier.at(0).size(), small.recent.size());
}

TEST(VisibleMap, SaturatedAndDarkValuesGiveNoDifference) {
  TileMap map = map_of(wall(8, -2, 2, -0.8, 0.8));
  EXPECT_GT(TestView(image_of({200, 120, 160})).differences(map).size(), 100u);
  EXPECT_EQ(TestView(image_of({255, 120, 160})).differences(map).size(), 0u);
  EXPECT_EQ(TestView(image_of({200, 5, 160})).differences(map).size(), 0u);
}

}  // namespace fovea::visible_map_test
