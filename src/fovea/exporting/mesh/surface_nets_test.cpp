#include "fovea/exporting/mesh/surface_nets.h"

#include <gtest/gtest.h>

#include "fovea/exporting/gltf.h"
#include "fovea/exporting/mesh/mesh_test_support.h"
#include "fovea/exporting/mesh/skirts.h"

namespace fovea::surface_nets_test {

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX(), kY = Eigen::Vector3d::UnitY(),
                      kZ = Eigen::Vector3d::UnitZ();

TEST(SurfaceNets, APlaneIsFlatAndFacesTheSensor) {
  const Eigen::Vector3d low(2, 2, 1), u = 4 * Eigen::Vector3d(0.96, 0, 0.28), v = 4 * kY;
  const Eigen::Vector3d up = u.cross(v).normalized();
  for (const double side : {1.0, -1.0}) {
    TestPoints points;
    points.add_square(low, u, v, low + side * 3 * up, /*noise=*/0.01);
    const TestMesh mesh = mesh_of(points.blocks());
    double area = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      EXPECT_GT(side * mesh.normal(t).normalized().dot(up), 0.9);
      area += mesh.normal(t).norm() / 2;
    }
    EXPECT_NEAR(area, 16, 16 * 0.06);  // it reaches 5 cm beyond its points at most
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      EXPECT_NEAR((mesh.position(i) - low).dot(up), 0, 0.01);
      EXPECT_GT(side * mesh.vertices[i].normal.cast<double>().dot(up), 0.98);
    }
  }
}

TEST(SurfaceNets, APlaneInTheLatticeIsWhole) {
  TestPoints points;
  points.add_square({2, 2, 1}, 4 * kX, 4 * kY, {4, 10, 2.7});  // seen from low
  const TestMesh mesh = mesh_of(points.blocks());
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += mesh.normal(t).z() / 2;
  EXPECT_NEAR(area, 16, 16 * 0.06);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_NEAR(mesh.position(i).z(), 1, 0.003);
  }
}

TEST(SurfaceNets, APlaneInTheFaceOfABlockWithoutPointsBelow) {
  TestPoints points;
  const double edge = block_edge(kTestVoxel);
  points.add_square({2, 2, edge + 1e-4}, 4 * kX, 4 * kY, {4, 10, edge + 2}, 5e-5);
  EXPECT_EQ(points.blocks().keys(), (std::vector<BlockKey>{{0, 0, 0}, {0, 0, 1}}));
  const TestMesh mesh = mesh_of(points.blocks());
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += mesh.normal(t).z() / 2;
  EXPECT_NEAR(area, 16, 16 * 0.06);
}

TEST(SurfaceNets, ASphereAcrossEightBlocksIsClosed) {
  const double edge = block_edge(kTestVoxel), radius = 1.5;
  const Eigen::Vector3d center(edge + 0.013, edge - 0.021, edge + 0.034);
  TestPoints points;
  points.add_sphere(center, radius);
  const PointBlocks& blocks = points.blocks();
  EXPECT_EQ(blocks.keys().size(), 8u);
  for_each_block_mesh(blocks, [](const BlockKey&, const BlockMesh& mesh) {
    EXPECT_FALSE(mesh.patch.empty());
    expect_sound(mesh.patch);
  });
  const TestMesh mesh = mesh_of(blocks);
  EXPECT_EQ(open_edges(mesh), 0u);  // vertices of neighbours are the same to the bit
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_NEAR((mesh.position(i) - center).norm(), radius, 0.004);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    EXPECT_GT(mesh.normal(t).dot(mesh.position(mesh.triangles[t][0]) - center), 0);
  }
}

TEST(SurfaceNets, ABoxHasItsSixFaces) {
  const Eigen::Vector3d low(2, 3, 1), size(2, 1.5, 1);
  TestPoints points;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d a = Eigen::Vector3d::Unit(axis) * size[axis];
    const Eigen::Vector3d b = Eigen::Vector3d::Unit((axis + 1) % 3) * size[(axis + 1) % 3];
    const Eigen::Vector3d c = Eigen::Vector3d::Unit((axis + 2) % 3) * size[(axis + 2) % 3];
    const Eigen::Vector3d middle = low + size / 2;
    points.add_square(low, b, c, middle - 5 * a);
    points.add_square(low + a, b, c, middle + 5 * a);
  }
  const TestMesh mesh = mesh_of(points.blocks());
  const Eigen::AlignedBox3d box(low, low + size);
  EXPECT_EQ(open_edges(mesh), 0u);
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += mesh.normal(t).norm() / 2;
  EXPECT_NEAR(area, 13, 0.6);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p = mesh.position(i);
    const double inside = std::min((p - low).minCoeff(), (low + size - p).minCoeff());
    EXPECT_LT(std::max(box.exteriorDistance(p), inside), 0.06);  // edges are rounded
  }
}

TEST(SurfaceNets, TheSidesOfAThinWallDoNotAnnihilateOneAnother) {
  TestPoints points;
  const Eigen::Vector3d low(2, 2, 1);
  const double thick = 0.04;  // less than half a voxel
  points.add_square(low, 2 * kY, 2 * kZ, low - 5 * kX, 0, {200, 0, 0});
  points.add_square(low + thick * kX, 2 * kY, 2 * kZ, low + 5 * kX, 0, {0, 200, 0});
  const TestMesh mesh = mesh_of(points.blocks());
  double front = 0, back = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d n = mesh.normal(t) / 2;
    (n.x() < 0 ? front : back) += std::abs(n.x());
    EXPECT_GT(std::abs(n.normalized().x()), 0.7);
  }
  EXPECT_NEAR(front, 4, 0.5);
  EXPECT_NEAR(back, 4, 0.5);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const MeshVertex& vertex = mesh.vertices[i];
    const bool is_front = vertex.normal.x() < 0;
    EXPECT_NEAR(mesh.position(i).x(), is_front ? 2 : 2 + thick, 0.005);
    // Each side has its own colour.
    EXPECT_EQ(vertex.light[is_front ? 0 : 1], linear_light(200));
    EXPECT_EQ(vertex.light[is_front ? 1 : 0], 0);
  }
}

TEST(SurfaceNets, APoleStands) {
  const Eigen::Vector3d foot(4, 4, 0.5);
  TestPoints points;
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 24; ++k) {
      const double turn = 2 * M_PI * k / 24;
      const Eigen::Vector3d out(std::cos(turn), std::sin(turn), 0);
      points.add(foot + 0.08 * out + 0.02 * i * kZ, foot + 6 * out + kZ);
    }
  }
  const TestMesh mesh = mesh_of(points.blocks());
  std::set<int> heights;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p = mesh.position(i) - foot;
    EXPECT_NEAR(std::hypot(p.x(), p.y()), 0.08, 0.03);
    heights.insert(static_cast<int>(p.z() / 0.1));
  }
  EXPECT_GE(heights.size(), 19u);
}

TEST(SurfaceNets, NoSurfaceWhereNoPointsAre) {
  TestPoints points;
  const Eigen::Vector3d sensor(4, 3, 4);
  const std::vector<Eigen::AlignedBox2d> parts = {{Eigen::Vector2d(2, 2), Eigen::Vector2d(3.5, 4)},
                                                  {Eigen::Vector2d(3.8, 2), Eigen::Vector2d(6, 4)}};
  for (const Eigen::AlignedBox2d& part : parts) {
    points.add_square({part.min().x(), part.min().y(), 1.03}, part.sizes().x() * kX,
                      part.sizes().y() * kY, sensor);
  }
  points.add({8, 8, 1}, sensor);  // alone
  points.add({8.03, 8, 1}, sensor);
  const BlockMesh block = mesh_block(points.blocks(), {0, 0, 0});
  EXPECT_EQ(block.lonely_cells, 1u);
  const TestMesh mesh = mesh_of(points.blocks());
  EXPECT_GT(mesh.triangles.size(), 1000u);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector2d p = mesh.position(i).head<2>();
    EXPECT_LT(std::min(parts[0].exteriorDistance(p), parts[1].exteriorDistance(p)), 0.08);
  }
}

TEST(SurfaceNets, ColoursAreThoseNearAndGreyWhereThereAreNone) {
  TestPoints points;
  const Eigen::Vector3d sensor(4, 3, 4);
  points.add_square({2, 2, 1}, 2 * kX, 2 * kY, sensor, 0, {255, 0, 0});
  points.add_square({4, 2, 1}, 2 * kX, 2 * kY, sensor, 0, {0, 255, 0});
  for (double x = 6.01; x < 8; x += 0.02) {
    for (double y = 2.01; y < 4; y += 0.02) points.add({x, y, 1}, sensor, kUncolored, false);
  }
  const TestMesh mesh = mesh_of(points.blocks());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const double x = mesh.position(i).x();
    const auto [r, g, b] = mesh.vertices[i].light;
    if (x < 3.9) {
      EXPECT_EQ((std::array{r, g, b}), (std::array<std::uint16_t, 3>{65535, 0, 0}));
    }
    if (x > 4.1 && x < 5.9) {
      EXPECT_EQ((std::array{r, g, b}), (std::array<std::uint16_t, 3>{0, 65535, 0}));
    }
    if (x > 6.15) {
      EXPECT_FALSE(mesh.vertices[i].colored);
      EXPECT_EQ(r, linear_light(128));
    }
  }
}

TEST(SurfaceNets, ACoarserLevelIsTheSameSurfaceWithFewerTriangles) {
  TestPoints points;
  const Eigen::Vector3d center(6.4, 6.3, 6.5);
  points.add_sphere(center, 3);
  const TestMesh fine = mesh_of(points.blocks());
  const PointBlocks half = coarser(points.blocks());
  EXPECT_EQ(half.voxel(), 2 * kTestVoxel);
  const TestMesh coarse = mesh_of(half);
  EXPECT_EQ(open_edges(coarse), 0u);
  EXPECT_NEAR(double(fine.triangles.size()) / double(coarse.triangles.size()), 4, 0.4);
  for (std::size_t i = 0; i < coarse.vertices.size(); ++i) {
    EXPECT_NEAR((coarse.position(i) - center).norm(), 3, 0.01);
  }
}

TEST(Skirts, HangWhereTheSurfaceLeavesTheBlock) {
  TestPoints points;
  const double edge = block_edge(kTestVoxel);
  points.add_square({edge - 1, 2, 1}, 2 * kX, 2 * kY, {edge, 3, 4});
  for (const int x : {0, 1}) {
    const MeshPatch bare = mesh_block(points.blocks(), {x, 0, 0}).patch;
    MeshPatch patch = bare;
    add_skirts(patch);
    expect_sound(patch);
    const std::size_t added = patch.triangles.size() - bare.triangles.size();
    EXPECT_NEAR(double(added), 2 * 20, 8);  // along 2 m of the one face that the surface crosses
    for (std::size_t i = bare.vertices.size(); i < patch.vertices.size(); ++i) {
      EXPECT_NEAR(kTestVoxel * place_of(patch.vertices[i]).z(), 0.9, 0.002);
    }
    for (std::size_t t = bare.triangles.size(); t < patch.triangles.size(); ++t) {
      const auto place = [&](std::size_t i) {
        return place_of(patch.vertices[patch.triangles[t][i]]);
      };
      const double out = (place(1) - place(0)).cross(place(2) - place(0)).x();
      EXPECT_GT(x == 0 ? out : -out, 0);  // seen from the neighbour's side
    }
  }
}

}  // namespace fovea::surface_nets_test
