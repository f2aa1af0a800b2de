#include "fovea/ray_filter.h"

#include <gtest/gtest.h>

#include "fovea/core/random.h"

namespace fovea::ray_filter_test {

Camera test_camera() { return {0, 200, 100, 100, 100, 99.5, 49.5, RigidMotion::Identity()}; }

Ray ray_of(const Eigen::Vector3f& p, const Camera& c) {
  return {{float(c.fx) * p.x() / p.z() + float(c.cx), float(c.fy) * p.y() / p.z() + float(c.cy)},
          p.norm()};
}

/// A wall across the view at depth z, sampled at every pixel of a region.
std::vector<Ray> wall(float z, const Camera& c, int x0, int x1, int y0, int y1) {
  std::vector<Ray> rays;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      rays.push_back(ray_of({(float(x) - float(c.cx)) / float(c.fx) * z,
                             (float(y) - float(c.cy)) / float(c.fy) * z, z},
                            c));
    }
  }
  return rays;
}

std::size_t count(const std::vector<RayVerdict>& verdicts, RayVerdict wanted) {
  return static_cast<std::size_t>(std::count(verdicts.begin(), verdicts.end(), wanted));
}

TEST(RayFilter, FirstScanOfAWallIsAllVisible) {
  const Camera camera = test_camera();
  const auto scan = wall(10, camera, 20, 60, 20, 60);
  const auto verdicts = RayFilter().filter(scan, {}, camera, {});
  EXPECT_EQ(count(verdicts, RayVerdict::kVisible), scan.size());
}

TEST(RayFilter, ScanPointInFrontOfAMapPointIsOccluding) {
  const Camera camera = test_camera();
  const auto map = wall(10, camera, 0, 200, 0, 100);
  const auto scan = wall(9, camera, 50, 60, 50, 60);  // 1 m in front of the mapped wall
  const auto verdicts = RayFilter().filter(scan, map, camera, {});
  EXPECT_EQ(count(verdicts, RayVerdict::kOccluding), scan.size());
}

TEST(RayFilter, ScanPointBehindTheMappedWallIsOccluded) {
  const Camera camera = test_camera();
  const auto wall_in_map = wall(10, camera, 0, 200, 0, 100);
  const std::vector<Ray> behind_it{{{100, 50}, 14.0f}};
  EXPECT_EQ(RayFilter().filter(behind_it, wall_in_map, camera, {})[0], RayVerdict::kOccluded);
}

TEST(RayFilter, NewSurfaceNextToTheMapIsKept) {
  const Camera camera = test_camera();
  const auto map = wall(10, camera, 0, 50, 0, 100);
  const auto scan = wall(10, camera, 60, 100, 0, 100);
  const auto verdicts = RayFilter().filter(scan, map, camera, {});
  EXPECT_EQ(count(verdicts, RayVerdict::kVisible), scan.size());
}

// The paper's case: a box in front of a wall, with a map from another pose that contains the wall
// behind the box. The scan contains the box (new, in front of the mapped wall). It also contains
// wall points that the box hides from the camera, due to the parallax between LiDAR and camera.
TEST(RayFilter, PointsSeenThroughAMappedBoxAreOccluded) {
  const Camera camera = test_camera();
  const auto box = wall(5, camera, 80, 120, 30, 70);  // in the map
  std::vector<Ray> hidden;  // sparse wall points behind the middle of the box
  for (int y = 40; y < 60; y += 8) {
    for (int x = 90; x < 110; x += 8) {
      const float z = 10;
      hidden.push_back(ray_of(
          {(float(x) - float(camera.cx)) / 100 * z, (float(y) - float(camera.cy)) / 100 * z, z},
          camera));
    }
  }
  const auto verdicts = RayFilter().filter(hidden, box, camera, {});
  EXPECT_EQ(count(verdicts, RayVerdict::kOccluded), hidden.size());
}

TEST(RayFilter, OccludersStillOwnTheirPixelsInTheSecondTest) {
  // The filter discards a scan patch that occludes the map. It still compares a lone far scan point
  // in the middle of the patch with it: docs/method.md 5, "discarded occluders still count as
  // owners in step 2".
  const Camera camera = test_camera();
  auto map = wall(10, camera, 0, 200, 0, 100);
  std::erase_if(map, [](const Ray& r) {
    return r.pixel.x() > 99.4f && r.pixel.x() < 100.6f && r.pixel.y() > 49.4f &&
           r.pixel.y() < 50.6f;
  });
  auto scan = wall(5, camera, 90, 111, 40, 61);
  std::erase_if(scan, [](const Ray& r) {
    return r.pixel.x() > 99.4f && r.pixel.x() < 100.6f && r.pixel.y() > 49.4f &&
           r.pixel.y() < 50.6f;
  });
  scan.push_back(ray_of({(100.f - 99.5f) / 100 * 10, (50.f - 49.5f) / 100 * 10, 10}, camera));
  const auto verdicts = RayFilter().filter(scan, map, camera, {});
  EXPECT_EQ(verdicts.back(), RayVerdict::kOccluded);
  EXPECT_EQ(count(verdicts, RayVerdict::kOccluding), scan.size() - 1);
}

TEST(RayFilter, OfOneScanTheNearestKeepsThePixel) {
  const Camera camera = test_camera();
  const std::vector<Ray> scan{{{50, 50}, 9.0f}, {{50.3f, 50.2f}, 8.99f}, {{49.6f, 50.4f}, 9.01f}};
  const auto verdicts = RayFilter().filter(scan, {}, camera, {});
  EXPECT_EQ(verdicts,
            (std::vector{RayVerdict::kShared, RayVerdict::kVisible, RayVerdict::kShared}));
}

TEST(RayFilter, PointWhosePixelTheMapOwnsTakesTheSecondTest) {
  const Camera camera = test_camera();
  const std::vector<Ray> map{{{50, 50}, 9.0f}};
  // Just behind a lone map point of the same surface: sigma 0, within a centimeter: visible.
  EXPECT_EQ(RayFilter().filter(std::vector<Ray>{{{50, 50}, 9.005f}}, map, camera, {})[0],
            RayVerdict::kVisible);
  EXPECT_EQ(RayFilter().filter(std::vector<Ray>{{{50, 50}, 9.02f}}, map, camera, {})[0],
            RayVerdict::kOccluded);
  // Equally short rays: the map's ray comes first, so nothing is hidden.
  EXPECT_EQ(RayFilter().filter(std::vector<Ray>{{{50, 50}, 9.0f}}, map, camera, {})[0],
            RayVerdict::kVisible);
}

TEST(RayFilter, ALonePointIsVisible) {
  EXPECT_EQ(RayFilter().filter(std::vector<Ray>{{{0, 0}, 4.0f}}, {}, test_camera(), {})[0],
            RayVerdict::kVisible);
}

// A value differs from the mean of N values by at most (N - 1) / sqrt(N) deviations.
TEST(RayFilter, OutlierNeedsMoreThanFiveRaysAtTwoDeviations) {
  const Camera camera = test_camera();
  const auto with_neighbors = [&](int n) {
    std::vector<Ray> scan{{{50, 50}, 14.0f}};
    for (int i = 0; i < n; ++i) scan.push_back({{float(48 + i % 5), float(48 + i / 5)}, 7.0f});
    return RayFilter().filter(scan, {}, camera, {})[0];
  };
  EXPECT_EQ(with_neighbors(4), RayVerdict::kVisible);   // 5 rays: 1.79 deviations at most
  EXPECT_EQ(with_neighbors(5), RayVerdict::kOccluded);  // 6 rays: 2.04
}

TEST(RayFilter, SmallerOutlierRateRejectsMore) {
  const Camera camera = test_camera();
  Random random(3);
  std::vector<Ray> scan = wall(10, camera, 0, 100, 0, 100);
  for (Ray& ray : scan) ray.length += float(random.uniform(-0.05, 0.05));
  std::size_t before = 0;
  for (const double rate : {1.6, 1.2, 0.8, 0.4}) {
    RayFilterOptions options;
    options.outlier_rate = rate;
    const std::size_t rejected =
        count(RayFilter().filter(scan, {}, camera, options), RayVerdict::kOccluded);
    EXPECT_GT(rejected, before) << rate;
    before = rejected;
  }
}

TEST(RayFilter, MatchesTheFormulaByBruteForce) {
  const Camera camera = test_camera();
  Random random(11);
  std::vector<Ray> scan, map;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray{{float(random.uniform(0, 60)), float(random.uniform(0, 60))},
                  float(random.uniform(4, 6))};
    (i % 3 == 0 ? map : scan).push_back(ray);
  }
  const auto verdicts = RayFilter().filter(scan, map, camera, {});
  const auto pixel = [](const Ray& r) {
    return std::pair{int(std::lround(r.pixel.x())), int(std::lround(r.pixel.y()))};
  };
  std::map<std::pair<int, int>, std::vector<std::pair<float, int>>> at;  // length, index; -1 = map
  for (const Ray& r : map) at[pixel(r)].push_back({r.length, -1});
  for (int i = 0; i < int(scan.size()); ++i) at[pixel(scan[i])].push_back({scan[i].length, i});
  for (auto& [p, rays] : at) std::sort(rays.begin(), rays.end());
  for (int i = 0; i < int(scan.size()); ++i) {
    const auto p = pixel(scan[i]);
    const auto& rays = at[p];
    const bool map_here =
        std::any_of(rays.begin(), rays.end(), [](auto r) { return r.second < 0; });
    RayVerdict expected = RayVerdict::kVisible;
    if (rays[0].second == i && map_here) {
      expected = RayVerdict::kOccluding;
    } else if (rays[0].second != i && rays[0].second >= 0) {
      expected = RayVerdict::kShared;
    } else {
      std::vector<double> lengths;
      for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
          const auto found = at.find({p.first + x, p.second + y});
          if (found != at.end()) lengths.push_back(found->second[0].first);
        }
      }
      double mean = 0, variance = 0;
      for (const double d : lengths) mean += d / double(lengths.size());
      for (const double d : lengths) variance += (d - mean) * (d - mean) / double(lengths.size());
      const double off = std::abs(scan[i].length - mean), sigma = std::sqrt(variance);
      if (std::abs(off - 2 * sigma) < 1e-9) continue;  // a tie in rounding
      if (off > 2 * sigma && !(sigma < 1e-3 && off < 1e-2)) expected = RayVerdict::kOccluded;
    }
    EXPECT_EQ(verdicts[i], expected) << i;
  }
}

TEST(RayFilter, ImageBordersAndReuseOfTheGrid) {
  const Camera camera = test_camera();
  RayFilter filter;
  const std::vector<Ray> corners{{{0, 0}, 5}, {{199, 0}, 5}, {{0, 99}, 5}, {{199, 99}, 5}};
  const auto first = filter.filter(corners, {}, camera, {});
  EXPECT_EQ(count(first, RayVerdict::kVisible), 4u);
  EXPECT_EQ(filter.filter(corners, {}, camera, {}), first);  // independent of the last frame
  Camera larger = camera;
  larger.width = 400;
  EXPECT_EQ(count(filter.filter(corners, {}, larger, {}), RayVerdict::kVisible), 4u);
}

}  // namespace fovea::ray_filter_test
