#include "fovea/pipeline/map_colors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "../../../tests/sample_map.h"
#include "fovea/base/parallel.h"
#include "fovea/mapping/color_fusion.h"

namespace fovea::map_colors_test {

constexpr double kSpacing = 0.02;

Camera test_camera() { return {3, 621, 188, 360, 360, 310, 94, RigidMotion::Identity()}; }

Image image_of(const Rgb& color) {
  Image image(621, 188, 3);
  for (std::size_t i = 0; i < image.data.size(); i += 3) {
    image.data[i] = color.r, image.data[i + 1] = color.g, image.data[i + 2] = color.b;
  }
  return image;
}

FovealOptions white_zone(double near_range, double far_range = 18) {
  FovealOptions options;
  options.near_range = near_range;
  options.far_range = far_range;
  return options;
}

/// A view of one colour (of one's choice) from a place in the local frame, which is the camera's.
struct TestView {
  ImagePyramid image;
  Camera camera;
  FovealRegion region;
  RigidMotion T_cam_local;
  ColorView view;

  explicit TestView(const Image& picture, const RigidMotion& T_cam_local_ = RigidMotion::Identity(),
                    const FovealOptions& options = white_zone(1), int frame = 7)
      : image(picture),
        camera(test_camera()),
        region(options, camera),
        T_cam_local(T_cam_local_),
        view{image, camera, frame, kSpacing} {}
  TestView(const TestView&) = delete;
  TestView& operator=(const TestView&) = delete;

  SeenMap look(const TileMap& map) const {
    SeenMap seen;
    seen.look(map, region, T_cam_local, kSpacing);
    return seen;
  }
  std::size_t recolour(TileMap& map, const PointCloud& new_points_cam = {}) const {
    SeenMap seen = look(map);
    seen.put_in_front(new_points_cam);
    return seen.recolour(map, view);
  }
};

RigidMotion camera_at(double x, double y, double z) {
  RigidMotion T_cam_local = RigidMotion::Identity();
  T_cam_local.translation() = -Eigen::Vector3d(x, y, z);
  return T_cam_local;
}

std::vector<Eigen::Vector3f> wall(double depth, double left, double right, double top,
                                  double bottom) {
  std::vector<Eigen::Vector3f> positions;
  for (double x = left; x < right; x += kSpacing) {
    for (double y = top; y < bottom; y += kSpacing) {
      positions.push_back(Eigen::Vector3d(x, y, depth).cast<float>());
    }
  }
  return positions;
}

/// As colour_new_points() leaves points of colour (1, 2, 3) seen from 5 m; `frame` 0.
PointCloud new_points(const std::vector<Eigen::Vector3f>& positions) {
  PointCloud points = one_point_each(positions);
  points.frame.assign(points.size(), 0);
  points.weight.assign(points.size(), view_weight(5));
  points.reason.assign(points.size(), 0);
  return points;
}

TileMap map_of(const std::vector<Eigen::Vector3f>& positions) {
  TileMap map(4.0);
  map.add_submap(exp_se3((Twist() << 0.3, -0.2, 1.0, 5, -7, 2).finished()));
  map.add(new_points(positions));
  return map;
}

/// Calls f(p_local, tile, index) for all points.
void for_each_point(
    const TileMap& map,
    const std::function<void(const Eigen::Vector3d&, const PointCloud&, std::size_t)>& f) {
  for (const Submap& submap : map.submaps()) {
    for (const auto& [key, stored] : submap.tiles) {
      const PointCloud tile = stored.points->cloud();
      for (std::size_t i = 0; i < tile.size(); ++i) {
        f(submap.T_local_submap * (tile.origin + tile.position[i].cast<double>()), tile, i);
      }
    }
  }
}

TEST(NewColours, AreTheViewsAtThePoints) {
  Image ramp(621, 188, 3);
  for (int y = 0; y < ramp.height; ++y) {
    for (int x = 0; x < ramp.width; ++x) {
      ramp.pixel(x, y)[0] = static_cast<std::uint8_t>(x / 4);
      ramp.pixel(x, y)[1] = static_cast<std::uint8_t>(y);
      ramp.pixel(x, y)[2] = 50;
    }
  }
  const TestView view(ramp);
  PointCloud points;
  points.position = {{0, 0, 6}, {1.5f, 0.5f, 4}, {-2, -0.3f, 10}};
  colour_new_points(points, view.view);
  EXPECT_NO_THROW(points.check());
  const Camera camera = test_camera();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d pixel = *camera.project(points.position[i].cast<double>());
    EXPECT_NEAR(points.color[i].r, (pixel.x() - 1.5) / 4, 1) << i;
    EXPECT_NEAR(points.color[i].g, pixel.y(), 1) << i;
    EXPECT_EQ(points.color[i].b, 50);
    EXPECT_EQ(points.weight[i], view_weight(points.position[i].norm()));
  }
  EXPECT_EQ(points.views, std::vector<std::uint8_t>(3, 1));
  EXPECT_EQ(points.spread, std::vector<std::uint8_t>(3, 0));
  EXPECT_EQ(points.frame, std::vector<std::int32_t>(3, 7));
  EXPECT_EQ(points.camera, std::vector<std::int8_t>(3, 3));
}

TEST(NewColours, SayThatTheirExposureWasMatched) {
  Image grey(621, 188, 3);
  std::fill(grey.data.begin(), grey.data.end(), 80);
  TestView view(grey);
  PointCloud points;
  points.position = {{0, 0, 6}, {1.5f, 0.5f, 4}};
  points.reason = {reason_of(PointRule::kMeasured), reason_of(PointRule::kPlanar)};
  colour_new_points(points, view.view);
  EXPECT_EQ(points.reason, (std::vector<std::uint8_t>{0, 2}));
  view.view.gain = Eigen::Array3f(1.5f, 1.5f, 1.5f);
  colour_new_points(points, view.view);
  EXPECT_EQ(points.reason, (std::vector<std::uint8_t>{0x10, 0x12}));
  EXPECT_EQ(points.color[0], (Rgb{120, 120, 120}));
}

// Near by the footprint is many pixels: the mean of stripes; far away it is less than one.
TEST(NewColours, AreMeansOverTheFootprint) {
  Image stripes(621, 188, 1);
  for (int y = 0; y < stripes.height; ++y) {
    for (int x = 0; x < stripes.width; ++x) stripes.pixel(x, y)[0] = x % 2 == 0 ? 0 : 200;
  }
  const TestView view(stripes);
  PointCloud points;
  points.position = {{0, 0, 3}, {0, 0, 8}};  // pixel 310 is black
  colour_new_points(points, view.view);
  EXPECT_EQ(points.color[0], (Rgb{100, 100, 100}));
  EXPECT_EQ(points.color[1], (Rgb{0, 0, 0}));
}

TEST(Recolour, AWallGetsTheWeightedMeanOfItsViews) {
  TileMap map = map_of(wall(9, -2, 2, -0.5, 0.5));
  const struct {
    Rgb color;
    RigidMotion T_cam_local;
  } views[] = {{{100, 40, 250}, camera_at(0, 0, 0)},
               {{180, 40, 10}, camera_at(0.5, 0, 4)},
               {{30, 200, 90}, camera_at(-0.5, 0.1, 5)}};
  for (int frame = 0; const auto& [color, T_cam_local] : views) {
    const TestView view(image_of(color), T_cam_local, white_zone(1), ++frame);
    EXPECT_EQ(view.recolour(map), map.size());
  }
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  double spread_error = 0;
  for_each_point(map, [&](const Eigen::Vector3d& p, const PointCloud& tile, std::size_t i) {
    double weight = view_weight(5);
    Eigen::Vector3d sum = weight * Eigen::Vector3d(1, 2, 3);
    double squares = weight * Eigen::Vector3d(1, 2, 3).squaredNorm();
    for (const auto& [color, T_cam_local] : views) {
      const double w = view_weight(static_cast<float>((T_cam_local * p).norm()));
      const Eigen::Vector3d seen = to_float(color).cast<double>();
      sum += w * seen;
      squares += w * seen.squaredNorm();
      weight += w;
    }
    ASSERT_EQ(tile.views[i], 4);
    ASSERT_NEAR(tile.weight[i], weight, 1);  // a distance within rounding of where weights change
    const Eigen::Vector3d mean = sum / weight, found = to_float(tile.color[i]).cast<double>();
    ASSERT_LT((found - mean).cwiseAbs().maxCoeff(), 4);
    error += (found - mean) / double(map.size());
    spread_error += (tile.spread[i] - std::sqrt((squares / weight - mean.squaredNorm()) / 3)) /
                    double(map.size());
    ASSERT_EQ(tile.frame[i], 0);  // what measured the point stays
  });
  EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.05);
  EXPECT_LT(std::abs(spread_error), 0.1);
}

// A wall behind a board keeps its colours where the board hides it, whether the board is in the map
// or new.
TEST(Recolour, HiddenPointsKeepTheirColours) {
  const std::vector<Eigen::Vector3f> behind = wall(8, -2, 2, -0.8, 0.8);
  const std::vector<Eigen::Vector3f> board = wall(5, -0.5, 0.4, -0.3, 0.3);
  for (const bool board_is_new : {false, true}) {
    TileMap map = map_of(behind);
    if (!board_is_new) map.add(new_points(board));
    const TestView view(image_of({200, 200, 200}));
    PointCloud board_cam;
    if (board_is_new) board_cam.position = board;
    const std::size_t count = view.recolour(map, board_cam);
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
        ASSERT_GT(tile.color[i].r, 50);
      }
    });
    EXPECT_EQ(count, seen);
  }
}

TEST(Recolour, PointsOutsideTheRegionStayAsTheyAre) {
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
  const std::size_t count = view.recolour(map);
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

// Tiles are left out whole where the camera does not look; none that holds a point in view is.
TEST(Recolour, FindsEveryPointInViewWhereverItsTileLies) {
  Random random(5);
  std::size_t all_inside = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Twist twist;
    for (double& value : twist) value = random.uniform(-1.5, 1.5);
    const RigidMotion T_cam_local = exp_se3(twist);
    std::vector<Eigen::Vector3f> positions;  // so few that none hides another
    for (int i = 0; i < 300; ++i) {
      positions.push_back(
          Eigen::Vector3d(random.uniform(-19, 19), random.uniform(-19, 19), random.uniform(-19, 19))
              .cast<float>());
    }
    TileMap map = map_of(positions);
    const TestView view(image_of({200, 200, 200}), T_cam_local);
    view.recolour(map);
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

// Nearer than the near blind zone nothing is coloured, but it hides.
TEST(Recolour, WhatIsOutsideTheRegionHidesToo) {
  TileMap map = map_of(wall(8, -1, 1, -0.3, 0.3));
  map.add(new_points(wall(2, -1, 1, -0.3, 0.3)));
  const TestView view(image_of({200, 200, 200}), RigidMotion::Identity(), white_zone(4));
  EXPECT_EQ(view.recolour(map), 0u);
}

// Something comes between the camera and a wall that is in the map: in front of it by more than
// 30 cm and 5 %.
TEST(SeenMap, MarksWhatStandsBeforeTheMap) {
  const Camera camera = test_camera();
  const FovealRegion region(white_zone(1), camera);
  const TileMap map = map_of(wall(8, -1, 1, -0.5, 0.5));
  SeenMap seen;
  seen.look(map, region, RigidMotion::Identity(), kSpacing);
  PointCloud points;
  points.position = {{0, 0, 5},       {0.2f, 0.1f, 7.5f}, {0, 0, 7.7f}, {0, 0, 8},
                     {0, 0, 8.5f},    {-0.3f, 0, 3},      {2, 0, 5},  // beside the wall
                     {0.4f, -0.2f, 4}};
  EXPECT_EQ(seen.marks_before(points), (std::vector<std::uint8_t>{1, 1, 0, 0, 0, 1, 0, 1}));
  seen.look(TileMap(), region, RigidMotion::Identity(), kSpacing);
  EXPECT_EQ(seen.marks_before(points), std::vector<std::uint8_t>(8, 0));
}

// A wall whose points have two views of one colour, and a third image of another exposure.
TEST(Exposure, GainBringsAnImageToTheMap) {
  const std::vector<Eigen::Vector3f> positions = wall(8, -2, 2, -0.8, 0.8);
  TileMap map(4.0);
  map.add_submap(RigidMotion::Identity());
  PointCloud points = new_points(positions);
  points.color.assign(points.size(), Rgb{100, 60, 80});
  points.views.assign(points.size(), 2);
  map.add(points);
  const auto gain_of = [&](const Rgb& color) {
    const TestView view(image_of(color));
    return view.look(map).compare(view.view).gain;
  };
  EXPECT_LT((gain_of({100, 60, 80}) - 1).abs().maxCoeff(), 1e-3);
  EXPECT_LT((gain_of({200, 120, 160}) - 0.5f).abs().maxCoeff(), 1e-3);
  EXPECT_LT((gain_of({50, 60, 40}) - Eigen::Array3f(2, 1, 2)).abs().maxCoeff(), 1e-3);
  EXPECT_EQ(gain_of({255, 255, 255}).matrix(), Eigen::Vector3f::Ones());  // saturated: no answer
  EXPECT_FALSE(is_exposure_off(gain_of({120, 72, 96})));
  EXPECT_TRUE(is_exposure_off(gain_of({200, 120, 160})));
  EXPECT_TRUE(is_exposure_off(gain_of({50, 30, 40})));

  // How far off an image is: (100, 60, 80) against (120, 60, 90).
  const TestView other(image_of({120, 60, 90}));
  const SeenMap::Comparison off = other.look(map).compare(other.view);
  EXPECT_GT(off.points, 100u);
  EXPECT_NEAR(off.error, 10, 0.1);

  // New points under the matching gain lie close to the map's colours.
  const TestView bright(image_of({200, 120, 160}));
  ColorView view = bright.view;
  view.gain = matching_gain(gain_of({200, 120, 160}));
  PointCloud added;
  added.position = {{0, 0, 8}};
  colour_new_points(added, view);
  EXPECT_NEAR(added.color[0].r, 100, 8);
  EXPECT_GT(added.color[0].r, 100);
}

TEST(Exposure, FewPointsSayNothing) {
  TileMap map = map_of(wall(8, -0.1, 0.1, -0.1, 0.1));
  const TestView view(image_of({200, 200, 200}));
  EXPECT_EQ(view.look(map).compare(view.view).gain.matrix(), Eigen::Vector3f::Ones());
}

TEST(Recolour, AnEmptyMapAndAViewOfNothingAreNormal) {
  TileMap empty;
  const TestView view(image_of({200, 200, 200}));
  EXPECT_EQ(view.recolour(empty), 0u);
  TileMap behind = map_of(wall(-8, -1, 1, -0.3, 0.3));
  EXPECT_EQ(view.recolour(behind), 0u);
}

TEST(Recolour, GivesTheSameAtAnyThreadCount) {
  const auto run = [](int threads) {
    const ThreadLimit limit(threads);
    TileMap map = map_of(wall(8, -3, 3, -1, 1));
    map.add_submap(camera_at(0.3, 0, 0.5));
    map.add(new_points(wall(5, -0.5, 0.4, -0.3, 0.3)));
    Random random(3);
    for (int frame = 0; frame < 4; ++frame) {
      Image image(621, 188, 3);
      for (std::uint8_t& value : image.data) value = static_cast<std::uint8_t>(random.below(256));
      TestView(image, camera_at(0.1 * frame, 0, 0.2 * frame), white_zone(1), frame).recolour(map);
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

}  // namespace fovea::map_colors_test
