#include "fovea/surface_samples.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "fovea/core/parallel.h"
#include "fovea/mapping/surface.h"
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
TEST(SurfaceSamples, APixelHasAboutAsManyAsTheOptionsSay) {
  constexpr double kHeight = 1.653;
  const PointCloud measured = scan({{{{-50, kHeight, -5}, {50, kHeight + 1, 60}}}});
  const Camera camera = test_camera();
  for (const double limit : {0.75, 1.5, 3.0}) {
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
      const double margin = std::pow(1 + 0.5 / z, 3);
      EXPECT_LT(per_pixel, std::min(all, 2 * limit) * margin) << z;
      EXPECT_GT(per_pixel, 0.93 * std::min(all, limit / 2) / margin) << z;  // some are measured
      limited += all > 2 * limit;
    }
    EXPECT_GT(limited, 0u) << limit;
  }
}

TEST(SurfaceSamples, BeyondTheRangeOfFullDensityAPixelHasAboutOne) {
  const PointCloud measured = scan({{wall_at(12.003)}}, {.first = 1, .last = -1});
  const auto levels = [&](double full_density_range) {
    const SurfaceOptions options{.spacing = kCell, .full_density_range = full_density_range};
    const PointCloud points = sample_surfaces(measured, test_camera(), options, plain_grid());
    return std::set<std::uint8_t>(points.sampling_level.begin(), points.sampling_level.end());
  };
  EXPECT_EQ(levels(20), std::set<std::uint8_t>{0});
  EXPECT_EQ(levels(5), std::set<std::uint8_t>{1});  // a pixel is 1.7 cm wide, but it is far
  // At twelve times the focal length's usual depth the levels follow the pixel's area.
  const Camera camera = test_camera();
  for (const double depth : {18.0, 30.0, 60.0, 120.0, 500.0}) {
    const Eigen::Vector3d p(0, 0, depth), facing(0, 0, -1);
    const int level =
        sampling_level(p, facing, camera, {.spacing = kCell, .full_density_range = 5});
    const double cell = kCell * (1 << level), pixel = depth / camera.fx;
    if (level < kSamplingLevels - 1) {
      EXPECT_LE(pixel * pixel, 2 * cell * cell) << depth;
    }
    EXPECT_GT(pixel * pixel, level == 1 ? 0 : cell * cell / 2) << depth;
  }
}

TEST(SurfaceSamples, CoarseSamplesLieAtTheCentersOfCoarseCells) {
  PointCloud measured = scan({{wall_at(30.003)}}, {.step = 0.3});
  const SurfaceOptions options{.spacing = kCell, .full_density_range = 10};
  const PointCloud points = sample_surfaces(measured, test_camera(), options, plain_grid());
  std::set<CellKey> cells;
  std::size_t samples = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = points.position[i].cast<double>();
    ASSERT_EQ(points.sampling_level[i], 1);
    EXPECT_TRUE(cells.insert(cell_of(p, 1)).second);
    if (points.interpolated[i] == 0) continue;
    ++samples;
    ASSERT_LT(off_center(p.x(), 1), 1e-5);
    ASSERT_LT(off_center(p.y(), 1), 1e-5);
  }
  EXPECT_GT(samples, 10'000u);
}

TEST(SurfaceSamples, TakenCellsGetNothing) {
  const PointCloud measured = scan({{wall_at(8.003)}});
  Random random(3);
  SampleGrid grid = grid_at(random_motion(random));
  const PointCloud all = sample_surfaces(measured, test_camera(), {}, grid);
  grid.taken = [](const Eigen::Vector3d& p_grid, int level) {
    const CellKey cell = cell_of(p_grid, level);
    return (cell[0] * 7 + cell[1] * 3 + cell[2]) % 5 < 2;
  };
  const PointCloud points = sample_surfaces(measured, test_camera(), {}, grid);
  std::vector<Eigen::Vector3f> expected;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Eigen::Vector3f& p = all.position[i];
    if (!grid.taken(grid.T_grid_cam * p.cast<double>(), all.sampling_level[i])) {
      expected.push_back(p);
    }
  }
  EXPECT_EQ(points.position, expected);

  grid.taken = [](const Eigen::Vector3d&, int) { return true; };
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
    next.taken = [&](const Eigen::Vector3d& p_grid, int) {
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
    std::array<std::set<CellKey>, kSamplingLevels> cells;
    std::size_t twice = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int level = points.sampling_level[i];
      const Eigen::Vector3d p_grid = grid.T_grid_cam * points.position[i].cast<double>();
      twice += !cells[std::size_t(level)].insert(cell_of(p_grid, level)).second;
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

// Any grid has one sample for each column along the axis nearest to the normal, except where a
// measured point has the cell.
TEST(SurfaceSamples, PlanesOfAnySlantAreSampledAtTheColumnsOfAnyGrid) {
  const Camera camera = test_camera();
  const Eigen::Vector3d middle(0.4, 0.3, 7);
  for (int trial = 0; trial < 12; ++trial) {
    Random random(std::uint64_t(trial) + 10);
    const Eigen::Vector3d n_cam =
        Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), -1).normalized();
    const SampleGrid grid = grid_at(random_motion(random));
    PointCloud measured;
    for (double u = 400; u < 900; u += 4) {
      for (double v = 20; v < 380; v += 4) {
        const Eigen::Vector3d ray((u + random.uniform(-1, 1) - camera.cx) / camera.fx,
                                  (v + random.uniform(-1, 1) - camera.cy) / camera.fy, 1);
        const double depth = n_cam.dot(middle) / n_cam.dot(ray);
        if (depth > 1 && depth < 20) measured.position.push_back((ray * depth).cast<float>());
      }
    }
    const PointCloud points = sample_surfaces(measured, camera, {}, grid);

    const Eigen::Vector3d n = grid.T_grid_cam.linear() * n_cam, center = grid.T_grid_cam * middle;
    Eigen::Index axis;
    n.cwiseAbs().maxCoeff(&axis);
    const Eigen::Index a = (axis + 1) % 3, b = (axis + 2) % 3;
    std::set<CellKey> with_measured;
    std::map<CellKey, int> with_sample;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d p = grid.T_grid_cam * points.position[i].cast<double>();
      ASSERT_NEAR(n.dot(p - center), 0, 1e-5);
      if (points.interpolated[i] == 0) {
        with_measured.insert(cell_of(p));
        continue;
      }
      ASSERT_LT(off_center(p[a]), 1e-5);
      ASSERT_LT(off_center(p[b]), 1e-5);
      ASSERT_LT((points.normal[i].cast<double>() - n_cam).norm(), 5e-3);
      CellKey column = cell_of(p);
      column[std::size_t(axis)] = 0;
      ++with_sample[column];
    }
    std::size_t columns = 0, missing = 0;
    constexpr double kReach = 0.5;
    for (double at_a = -kReach; at_a < kReach; at_a += kCell) {
      for (double at_b = -kReach; at_b < kReach; at_b += kCell) {
        Eigen::Vector3d p;
        p[a] = (std::floor((center[a] + at_a) / kCell) + 0.5) * kCell;
        p[b] = (std::floor((center[b] + at_b) / kCell) + 0.5) * kCell;
        p[axis] = center[axis] - (n[a] * (p[a] - center[a]) + n[b] * (p[b] - center[b])) / n[axis];
        CellKey column = cell_of(p);
        column[std::size_t(axis)] = 0;
        const int found = with_sample.contains(column) ? with_sample[column] : 0;
        ++columns;
        ASSERT_LE(found, 1);
        missing += found == 0 && !with_measured.contains(cell_of(p));
      }
    }
    ASSERT_GE(columns, 2500u);
    EXPECT_LE(missing, 2u) << "trial " << trial;  // a sample within rounding of its cell's border
  }
}

TEST(SurfaceSamples, ATriangleGetsTheCentersInIt) {
  PointCloud corners;
  // In the outer halves of their cells, so that no center of those is in the triangle.
  corners.position = {{0.018f, 0.019f, 2.003f}, {0.241f, 0.033f, 2.053f}, {0.052f, 0.222f, 2.023f}};
  corners.intensity = {0.1f, 0.2f, 0.6f};
  const PointCloud points = sample_surfaces(corners, test_camera(), {}, plain_grid());
  std::vector<Eigen::Vector2d> centers;
  const auto left_of = [&](std::size_t i, std::size_t j, const Eigen::Vector2d& p) {
    const Eigen::Vector2d a = corners.position[i].head<2>().cast<double>();
    const Eigen::Vector2d b = corners.position[j].head<2>().cast<double>();
    return (b - a).x() * (p - a).y() - (b - a).y() * (p - a).x() > 0;
  };
  for (int x = -5; x < 20; ++x) {
    for (int y = -5; y < 20; ++y) {
      const Eigen::Vector2d p((x + 0.5) * kCell, (y + 0.5) * kCell);
      if (left_of(0, 1, p) && left_of(1, 2, p) && left_of(2, 0, p)) centers.push_back(p);
    }
  }
  ASSERT_GT(centers.size(), 50u);
  ASSERT_EQ(points.size(), 3 + centers.size());
  const Eigen::Vector3f a = corners.position[0];
  const Eigen::Vector3f n = (corners.position[2] - a).cross(corners.position[1] - a).normalized();
  for (const Eigen::Vector2d& center : centers) {
    EXPECT_TRUE(std::any_of(points.position.begin() + 3, points.position.end(), [&](const auto& p) {
      return (p.template head<2>().template cast<double>() - center).norm() < 1e-6;
    })) << center.transpose();
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(n.dot(points.position[i] - a), 0, 1e-6f);
    EXPECT_LT((points.normal[i] - n).norm(), 1e-5f);
    if (i >= 3) {
      EXPECT_NEAR(points.intensity[i], 0.3f, 1e-6f);
    }
  }
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
