#include "fovea/mapping/triangle_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "fovea/mapping/surface_test_support.h"

namespace fovea::triangle_sampler_test {

using namespace surface_test;

// Any grid has one sample for each column along the axis nearest to the normal, except where a
// measured point has the cell.
TEST(TriangleSampler, PlanesOfAnySlantAreSampledAtTheColumnsOfAnyGrid) {
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

// A coarse surface can therefore be refined when the camera comes nearer.
TEST(TriangleSampler, CoarseSamplesArePartOfFineOnes) {
  const BoxScene scene{{{{-50, 1.653, -5}, {50, 3, 60}}, {{-1.31, 0.4, 8.2}, {1.12, 1.653, 12}}}};
  const PointCloud measured = scan(scene);
  Random random(11);
  SampleGrid grid = grid_at(random_motion(random));
  const auto cells = [&](const PointCloud& points) {
    std::set<CellKey> keys;
    for (const Eigen::Vector3f& p : points.position) {
      keys.insert(cell_of(grid.T_grid_cam * p.cast<double>()));
    }
    return keys;
  };
  const auto sampled = [&](double limit) {
    return sample_surfaces(measured, test_camera(), {.spacing = kCell, .max_per_pixel = limit},
                           grid);
  };
  const std::set<CellKey> all = cells(sampled(0));
  std::set<CellKey> finer = all;
  for (const double limit : {6.0, 3.0, 1.5, 0.75}) {
    const std::set<CellKey> coarse = cells(sampled(limit));
    EXPECT_LT(coarse.size(), finer.size()) << limit;
    std::size_t new_ones = 0;
    for (const CellKey& cell : coarse) new_ones += !finer.contains(cell);
    EXPECT_LE(new_ones, coarse.size() / 10'000) << limit;  // floats at a cell's border
    finer = coarse;
  }
  EXPECT_LT(finer.size(), all.size() / 2);

  grid.taken = [&](const Eigen::Vector3d& p_grid) { return finer.contains(cell_of(p_grid)); };
  std::set<CellKey> in_the_end = cells(sampled(0));
  in_the_end.insert(finer.begin(), finer.end());
  EXPECT_NEAR(double(in_the_end.size()), double(all.size()), double(all.size()) / 10'000);
}

TEST(TriangleSampler, ATriangleGetsTheCentersInIt) {
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

}  // namespace fovea::triangle_sampler_test
