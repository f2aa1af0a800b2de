#include "fovea/mapping/surface_samples.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "../../../tests/synthetic_drive.h"
#include "fovea/base/angle.h"
#include "fovea/base/errors.h"
#include "fovea/base/parallel.h"
#include "fovea/base/random.h"
#include "fovea/mapping/camera_test_support.h"

namespace fovea::surface_samples_test {

constexpr double kCell = 0.02;

/// Rings of a LiDAR that stands a little above and behind the camera, cut to about its view.
struct Rings {
  double first = 2, last = -12, step = 0.4;  // elevations, degrees
  double azimuth_step = 0.17;                // degrees
  double noise = 0;                          // of ranges, standard deviation, m
};

// In the camera's frame: x right, y down, z forward; boxes of the scene likewise.
PointCloud scan(const BoxScene& scene, const Rings& rings = {}) {
  const Eigen::Vector3d lidar(0.01, -0.08, -0.27);
  Random random(1);
  PointCloud points;
  for (double elevation = rings.first; elevation > rings.last; elevation -= rings.step) {
    for (double azimuth = -35; azimuth < 35; azimuth += rings.azimuth_step) {
      const double e = elevation * kDegree, a = azimuth * kDegree;
      const Eigen::Vector3d ray(std::cos(e) * std::sin(a), -std::sin(e), std::cos(e) * std::cos(a));
      const auto hit = scene.cast(lidar, ray);
      if (!hit) continue;
      points.position.push_back(
          (lidar + (*hit + rings.noise * random.normal()) * ray).cast<float>());
      points.intensity.push_back(0.25f);
    }
  }
  return points;
}

Box wall_at(double depth) { return {{-20, -10, depth}, {20, 10, depth + 1}}; }

bool nothing_taken(const Eigen::Vector3d&) { return false; }

SampleGrid grid_at(const RigidMotion& T_grid_cam) { return {T_grid_cam, kCell, nothing_taken}; }

SampleGrid plain_grid() { return grid_at(RigidMotion::Identity()); }

RigidMotion random_motion(Random& random) {
  Twist twist;
  for (int i = 0; i < 3; ++i) twist[i] = random.uniform(-3, 3);
  for (int i = 3; i < 6; ++i) twist[i] = random.uniform(-100, 100);
  return exp_se3(twist);
}

using CellKey = std::array<int, 3>;

CellKey cell_of(const Eigen::Vector3d& p_grid) {
  const Eigen::Array3i cell = (p_grid.array() / kCell).floor().cast<int>();
  return {cell.x(), cell.y(), cell.z()};
}

double off_center(double coordinate) {
  const double cells = coordinate / kCell - 0.5;
  return std::abs(cells - std::round(cells)) * kCell;
}

std::size_t sample_count(const PointCloud& points) {
  return std::size_t(std::count(points.interpolated.begin(), points.interpolated.end(), 1));
}

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

// Density on a slant, for any grid: one sample for each column of the axis nearest to the normal,
// but where a measured point has its cell.
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

TEST(SurfaceSamples, GroundBetweenDistantRingsIsFilled) {
  constexpr double kHeight = 1.653;
  const BoxScene ground{{{{-50, kHeight, -5}, {50, kHeight + 1, 60}}}};
  const auto density = [&](const PointCloud& points, double near, double far) {
    std::size_t count = 0;
    for (const Eigen::Vector3f& p : points.position) {
      count += std::abs(p.x()) < 2 && p.z() > near && p.z() < far;
    }
    return double(count) * kCell * kCell / (4 * (far - near));
  };
  for (const double noise : {0.0, 0.015}) {
    const PointCloud measured = scan(ground, {.noise = noise});
    const PointCloud points =
        sample_surfaces(measured, test_camera(), {.max_per_pixel = 0}, plain_grid());
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_NEAR(points.position[i].y(), kHeight, noise == 0 ? 1e-5 : 0.05);
    }
    // Rings are 0.43 m apart at 10 m, 1 m at 15 m: beyond that it is not known to be flat.
    EXPECT_NEAR(density(points, 8.5, 10), 1, noise == 0 ? 0.002 : 0.05) << noise;
    EXPECT_NEAR(density(points, 12, 14), 1, noise == 0 ? 0.002 : 0.05) << noise;
    EXPECT_LT(density(points, 16, 18), 0.05) << noise;
    const PointCloud tau_alone = sample_surfaces(
        measured, test_camera(), {.max_edge = 0.3, .planar_edge = 0.1}, plain_grid());
    EXPECT_LT(density(tau_alone, 9, 14), 0.05) << noise;
  }
}

// Ground at depth z fills a pixel with z^3 / (fx fy height) of its area.
TEST(SurfaceSamples, NoMoreFallOntoAPixelThanMay) {
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
      // A triangle is as its middle is, up to half a metre away.
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

// So that a coarse surface becomes the fine one where it is seen nearer.
TEST(SurfaceSamples, WhatIsSampledCoarselyIsPartOfWhatIsSampledFinely) {
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

// Rings 0.3 to 1 m apart: a sample says whether short edges let it in, or only the ground's being
// flat. The rings that a point of the ground lies between are known, and so are their triangles'
// edges: at least as long as the gap, at most its diagonal with a step along the ring.
TEST(SurfaceSamples, SayWhyTheyAreThere) {
  constexpr double kHeight = 1.653, kMaxEdge = 0.55;
  const Rings rings;
  const PointCloud measured = scan({{{{-50, kHeight, -5}, {50, kHeight + 1, 60}}}}, rings);
  const PointCloud points =
      sample_surfaces(measured, test_camera(), {.max_edge = kMaxEdge}, plain_grid());
  std::array<std::size_t, kPointRules> count{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint8_t rule = points.reason[i];
    ASSERT_LT(rule, kPointRules);
    ++count[rule];
    ASSERT_EQ(rule == reason_of(PointRule::kMeasured), points.interpolated[i] == 0);
    const Eigen::Vector3f p = points.position[i] - Eigen::Vector3f(0.01f, -0.08f, -0.27f);
    if (points.interpolated[i] == 0) continue;
    const double out = std::hypot(p.x(), p.z()), height = kHeight + 0.08;
    const double below = (rings.first + std::atan2(height, out) / kDegree) / rings.step;
    const auto radius = [&](double ring) {
      return height / std::tan((ring * rings.step - rings.first) * kDegree);
    };
    // Chords of a ring lie inside its circle: a little beyond a ring's points are its triangles.
    if (std::abs(below - std::round(below)) < 0.02) continue;
    const double gap = radius(std::floor(below)) - radius(std::ceil(below));
    const double along = radius(std::floor(below)) * rings.azimuth_step * kDegree;
    if (std::hypot(gap, 2 * along) < kMaxEdge) {
      ASSERT_EQ(rule, reason_of(PointRule::kShortEdges)) << out;
    }
    if (gap > kMaxEdge) {
      ASSERT_EQ(rule, reason_of(PointRule::kPlanar)) << out;
    }
  }
  EXPECT_GT(count[reason_of(PointRule::kMeasured)], 1000u);
  EXPECT_GT(count[reason_of(PointRule::kShortEdges)], 10000u);
  EXPECT_GT(count[reason_of(PointRule::kPlanar)], 10000u);
  EXPECT_EQ(count[reason_of(PointRule::kCentroid)], 0u);
}

// What lies between a board and the wall behind it was never measured.
TEST(SurfaceSamples, NothingIsSampledBetweenABoardAndTheWallBehind) {
  for (const double azimuth_step : {0.17, 0.09, 0.4}) {
    for (double gap = 0.42; gap < 1.1; gap += 0.06) {
      const Box board{{-1.03, -0.12, 6}, {0.91, 0.57, 6.01}};
      const BoxScene scene{{board, wall_at(6 + gap)}};
      const PointCloud measured = scan(scene, {.step = 0.3, .azimuth_step = azimuth_step});
      const PointCloud points = sample_surfaces(measured, test_camera(), {}, plain_grid());
      ASSERT_GT(sample_count(points), 10'000u);
      std::size_t between = 0;
      for (const Eigen::Vector3f& p : points.position) {
        between += std::abs(p.z() - 6) > 0.005f && std::abs(p.z() - 6 - gap) > 0.005f;
      }
      // At the board's corners the gap itself turns: a small triangle there may pass for flat.
      EXPECT_LE(between, 2u) << "gap " << gap << " m, azimuth step " << azimuth_step << ", of "
                             << points.size();
    }
  }
}

// Chords cut corners by less than tau; beyond them samples are on the surfaces.
TEST(SurfaceSamples, ABoxOnTheGroundKeepsItsShape) {
  const BoxScene scene{{{{-50, 1.653, -5}, {50, 3, 60}}, {{-1.31, 0.4, 8.2}, {1.12, 1.653, 12}}}};
  const PointCloud points = sample_surfaces(scan(scene), test_camera(), {}, plain_grid());
  ASSERT_GT(sample_count(points), 50'000u);
  std::size_t off = 0;
  for (const Eigen::Vector3f& p : points.position) {
    const double distance = scene.distance(p.cast<double>());
    ASSERT_LT(distance, 0.15) << p.transpose();  // half of tau
    off += distance > 0.005;
  }
  EXPECT_LT(double(off), 0.01 * double(points.size()));
}

// A corner of a house, an edge of 90 degrees towards the camera, and its two normals.
TEST(SurfaceSamples, NormalsAreThoseOfTheSidesOfAnEdge) {
  const Eigen::Vector3d left_normal = Eigen::Vector3d(-1, 0, -1).normalized();
  const Eigen::Vector3d right_normal = Eigen::Vector3d(1, 0, -1).normalized();
  const Eigen::Vector3d edge(0.2, 0, 7);
  const Camera camera = test_camera();
  PointCloud measured;
  for (double u = 400; u < 850; u += 4) {
    for (double v = 20; v < 380; v += 4) {
      const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
      const Eigen::Vector3d& n =
          ray.x() / ray.z() < edge.x() / edge.z() ? left_normal : right_normal;
      measured.position.push_back((ray * (n.dot(edge) / n.dot(ray))).cast<float>());
    }
  }
  const PointCloud points = sample_surfaces(measured, camera, {}, plain_grid());
  std::size_t on_left = 0, on_right = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = points.position[i].cast<double>();
    const bool left = p.x() < edge.x();
    const Eigen::Vector3d& n = left ? left_normal : right_normal;
    ASSERT_LT(std::abs(n.dot(p - edge)), 0.04);       // 4 pixels at 7 m
    if (std::abs(p.x() - edge.x()) < 0.25) continue;  // smoothed over the edge
    ASSERT_LT((points.normal[i].cast<double>() - n).norm(), 0.01);
    (left ? on_left : on_right) += points.interpolated[i];
  }
  EXPECT_GT(on_left, 1000u);
  EXPECT_GT(on_right, 1000u);
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

  // And those of bricks: in every second one, every second cell.
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

// A map that rounds what it keeps: asked again for the same scan, it has all of it.
TEST(SurfaceSamples, WhatIsRoundedHasItsCell) {
  const PointCloud measured = scan({{wall_at(8.003)}}, {.noise = 0.02});
  Random random(12);
  SampleGrid grid = grid_at(random_motion(random));
  static constexpr double kStep = 0.001;
  const auto rounded = [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    // A tenth of a step beyond, that decides where a cell ends just there.
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
  EXPECT_GT(again(), 100u);  // asked for where they are
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

TEST(SurfaceSamples, ATriangleGivesTheCentresInIt) {
  PointCloud corners;
  // In the outer halves of their cells, so that no centre of those is in the triangle.
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

TEST(SurfaceSamples, FewCollinearAndEqualPointsAreNormalInput) {
  const Eigen::Vector3f a(0, 0, 5), b(0.1f, 0, 5), c(0.2f, 0, 5);
  for (const auto& positions :
       std::vector<std::vector<Eigen::Vector3f>>{{}, {a}, {a, b}, {a, b, c}, {a, a, a}}) {
    PointCloud cloud;
    cloud.position = positions;
    const PointCloud points = sample_surfaces(cloud, test_camera(), {}, plain_grid());
    EXPECT_NO_THROW(points.check());
    EXPECT_TRUE(points.intensity.empty());
    const std::set<float> places = [&] {
      std::set<float> x;
      for (const Eigen::Vector3f& p : positions) x.insert(p.x());
      return x;
    }();
    EXPECT_EQ(points.size(), places.size());
    EXPECT_EQ(points.normal, std::vector<Eigen::Vector3f>(places.size(), {0.f, 0.f, 0.f}));
    EXPECT_EQ(points.interpolated, std::vector<std::uint8_t>(places.size(), 0));
  }
}

// Two points of one pixel: the nearer is the surface's corner, the other stays as it is.
TEST(SurfaceSamples, TheNearestPointOfAPixelIsItsCorner) {
  PointCloud cloud;
  for (const double depth : {9.0, 5.0}) {
    cloud.position.push_back(Eigen::Vector3d(0.02 * depth, 0.02 * depth, depth).cast<float>());
  }
  cloud.position.push_back({0.3f, 0.1f, 5});
  cloud.position.push_back({0.1f, 0.3f, 5});
  const PointCloud points = sample_surfaces(cloud, test_camera(), {}, plain_grid());
  ASSERT_GT(points.size(), 20u);
  EXPECT_EQ(points.position[0], cloud.position[0]);
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_NEAR(points.position[i].z(), 5, 1e-5);
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

TEST(SurfaceSamples, RejectsPointsThatAreNotInFrontOfTheCamera) {
  PointCloud cloud;
  cloud.position = {{0, 0, 5}, {0, 1, -1}};
  EXPECT_THROW(sample_surfaces(cloud, test_camera(), {}, plain_grid()), std::invalid_argument);
}

TEST(SurfaceOptions, NameTheBadField) {
  EXPECT_NO_THROW(SurfaceOptions{}.validate());
  EXPECT_NO_THROW(SurfaceOptions{.spacing = 0}.validate());
  const auto message = [](const SurfaceOptions& options) -> std::string {
    try {
      options.validate();
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-0.02, 0.001, 1.5, kInfinite, kNaN}) {
    EXPECT_NE(message({.spacing = bad}).find("surface.spacing"), std::string::npos) << bad;
  }
  for (const double bad : {0.0, -0.3, kInfinite, kNaN}) {
    EXPECT_NE(message({.max_edge = bad}).find("surface.max_edge"), std::string::npos) << bad;
    EXPECT_NE(message({.planar_edge = bad}).find("surface.planar_edge"), std::string::npos) << bad;
  }
  EXPECT_NO_THROW(SurfaceOptions{.max_per_pixel = 0}.validate());
  for (const double bad : {-1.0, 0.05, 2000.0, kNaN}) {
    EXPECT_NE(message({.max_per_pixel = bad}).find("surface.max_per_pixel"), std::string::npos)
        << bad;
  }
  for (const double bad : {-0.1, 1.6, kNaN}) {
    EXPECT_NE(message({.planar_angle = bad}).find("surface.planar_angle"), std::string::npos)
        << bad;
  }
}

}  // namespace fovea::surface_samples_test
