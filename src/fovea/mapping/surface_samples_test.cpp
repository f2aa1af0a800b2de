#include "fovea/mapping/surface_samples.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "fovea/core/parallel.h"
#include "fovea/mapping/surface_test_support.h"

namespace fovea::surface_samples_test {

using namespace surface_test;

TEST(SurfaceSamples, AWallHasOnePointInEachCell) {
  constexpr double kDepth = 8.003;
  const PointCloud measured = scan({{wall_at(kDepth)}});
  const PointCloud points = sample_surfaces(measured, test_camera(), {}, plain_grid());
  EXPECT_NO_THROW(points.check());
  std::map<CellKey, int> per_cell;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = points.position[i].cast<double>();
    ASSERT_NEAR(p.z(), kDepth, 1e-5);
    ++per_cell[cell_of(p)];
    if (points.interpolated[i] == 0) continue;
    ASSERT_LT(off_center(p.x()), 1e-5);
    ASSERT_LT(off_center(p.y()), 1e-5);
    ASSERT_EQ(points.intensity[i], 0.25f);
    ASSERT_LT((points.normal[i] - Eigen::Vector3f(0, 0, -1)).norm(), 1e-3f);
  }
  for (int x = -100; x < 100; ++x) {
    for (int y = -10; y < 50; ++y) ASSERT_EQ((per_cell[{x, y, 400}]), 1) << x << " " << y;
  }
}

// Ground at depth z fills a pixel with z^3 / (fx fy height) of its area.
TEST(SurfaceSamples, NoPixelHasMoreThanTheLimit) {
  constexpr double kHeight = 1.653;
  const PointCloud measured = scan({{{{-50, kHeight, -5}, {50, kHeight + 1, 60}}}});
  const Camera camera = test_camera();
  for (const double limit : {1.0, 3.0, 6.0}) {
    const SurfaceOptions options{.spacing = kCell, .max_per_pixel = limit};
    const PointCloud points = sample_surfaces(measured, camera, options, plain_grid());
    std::size_t limited = 0;
    for (double z = 8.5; z < 14; z += 0.25) {
      std::size_t count = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector3f& p = points.position[i];
        count += points.interpolated[i] == 1 && std::abs(p.x()) < 1.5 && std::abs(p.z() - z) < 0.25;
      }
      const double area = z * z * z / (camera.fx * camera.fy * kHeight);
      const double all = area / (kCell * kCell), per_pixel = double(count) / 1.5 * area;
      // A triangle is as its middle is, up to half a meter away.
      const double lowest = std::min(all, limit / 2) * std::pow(1 - 0.5 / z, 3);
      EXPECT_LT(per_pixel, std::min(all, limit) * std::pow(1 + 0.5 / z, 3)) << z;
      if (all < limit * 8) {
        EXPECT_GT(per_pixel, 0.93 * lowest) << z;  // measured points have cells, too
      }
      limited += all > limit;
    }
    EXPECT_GT(limited, 0u) << limit;
  }
}

TEST(SurfaceSamples, TakenCellsGetNothing) {
  const PointCloud measured = scan({{wall_at(8.003)}});
  Random random(3);
  SampleGrid grid = grid_at(random_motion(random));
  const PointCloud all = sample_surfaces(measured, test_camera(), {}, grid);
  grid.taken = [](const Eigen::Vector3d& p_grid) {
    const CellKey cell = cell_of(p_grid);
    return (cell[0] * 7 + cell[1] * 3 + cell[2]) % 5 < 2;
  };
  const PointCloud points = sample_surfaces(measured, test_camera(), {}, grid);
  std::vector<Eigen::Vector3f> expected;
  for (const Eigen::Vector3f& p : all.position) {
    if (!grid.taken(grid.T_grid_cam * p.cast<double>())) expected.push_back(p);
  }
  EXPECT_EQ(points.position, expected);

  // Cells of bricks too: every second cell of every second brick.
  CellBrick half;
  for (int i = 0; i < 512; ++i) {
    const Eigen::Array3i cell(i & 7, i >> 3 & 7, i >> 6);
    if (cell.sum() % 2 == 0) half.mark(cell);
  }
  grid.taken_brick = [&](const Eigen::Array3i& brick) {
    return brick.sum() % 2 == 0 ? &half : nullptr;
  };
  std::erase_if(expected, [&](const Eigen::Vector3f& p) {
    const CellKey cell = cell_of(grid.T_grid_cam * p.cast<double>());
    int brick_sum = 0, sum = 0;
    for (const int i : cell) {
      brick_sum += i >> 3;
      sum += i & 7;
    }
    return brick_sum % 2 == 0 && sum % 2 == 0;
  });
  EXPECT_EQ(sample_surfaces(measured, test_camera(), {}, grid).position, expected);

  grid.taken = [](const Eigen::Vector3d&) { return true; };
  EXPECT_TRUE(sample_surfaces(measured, test_camera(), {}, grid).empty());
}

// A map with rounded positions has all samples of a scan when it gets the same scan again.
TEST(SurfaceSamples, RoundedPointsHaveTheirCells) {
  const PointCloud measured = scan({{wall_at(8.003)}}, {.noise = 0.02});
  Random random(12);
  SampleGrid grid = grid_at(random_motion(random));
  static constexpr double kStep = 0.001;
  const auto rounded = [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    // An offset of 0.1 step decides positions on a cell border.
    return ((p / kStep).array().round() + 0.1).matrix() * kStep;
  };
  const auto again = [&] {
    const PointCloud first = sample_surfaces(measured, test_camera(), {}, grid);
    std::set<CellKey> had;
    for (const Eigen::Vector3f& p : first.position) {
      had.insert(cell_of(rounded(grid.T_grid_cam * p.cast<double>())));
    }
    SampleGrid next = grid;
    next.taken = [&](const Eigen::Vector3d& p_grid) {
      return had.contains(cell_of(grid.step > 0 ? rounded(p_grid) : p_grid));
    };
    return sample_surfaces(measured, test_camera(), {}, next).size();
  };
  EXPECT_GT(again(), 100u);  // positions not rounded
  grid.step = kStep;
  EXPECT_LE(again(), 10u);
}

TEST(SurfaceSamples, NoTwoPointsHaveOneCell) {
  const BoxScene scene{{{{-50, 1.653, -5}, {50, 3, 60}}, {{-1.31, 0.4, 8.2}, {1.12, 1.653, 12}}}};
  for (std::uint64_t trial = 0; trial < 4; ++trial) {
    Random random(trial + 20);
    const SampleGrid grid = grid_at(random_motion(random));
    const PointCloud measured = scan(scene, {.noise = 0.02});
    const PointCloud points = sample_surfaces(measured, test_camera(), {}, grid);
    std::set<CellKey> cells;
    std::size_t twice = 0;
    for (const Eigen::Vector3f& p : points.position) {
      twice += !cells.insert(cell_of(grid.T_grid_cam * p.cast<double>())).second;
    }
    EXPECT_LE(twice, points.size() / 10'000);  // floats at a cell's border
  }
}

TEST(SurfaceSamples, MeasuredPointsComeFirstAsTheyWere) {
  Random random(5);
  PointCloud measured = scan({{wall_at(8.003)}}, {.noise = 0.02});
  for (float& intensity : measured.intensity) intensity = static_cast<float>(random.uniform());
  const PointCloud points = sample_surfaces(measured, test_camera(), {}, plain_grid());
  std::set<CellKey> cells;
  std::size_t next = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (!cells.insert(cell_of(measured.position[i].cast<double>())).second) continue;
    ASSERT_EQ(points.position[next], measured.position[i]);
    ASSERT_EQ(points.intensity[next], measured.intensity[i]);
    ASSERT_EQ(points.interpolated[next], 0);
    ++next;
  }
  ASSERT_LT(next, points.size());
  EXPECT_EQ(sample_count(points), points.size() - next);
}

TEST(SurfaceSamples, TheSameAtAnyThreadCount) {
  const PointCloud measured = scan({{wall_at(8.003)}}, {.noise = 0.02});
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    Random random(7);
    return sample_surfaces(measured, test_camera(), {}, grid_at(random_motion(random)));
  };
  const PointCloud one = run(1), two = run(2);
  ASSERT_GT(one.size(), 50'000u);
  EXPECT_EQ(one.position, two.position);
  EXPECT_EQ(one.normal, two.normal);
  EXPECT_EQ(one.intensity, two.intensity);
  EXPECT_EQ(one.interpolated, two.interpolated);
}

}  // namespace fovea::surface_samples_test
