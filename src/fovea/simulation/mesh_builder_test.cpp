#include "fovea/simulation/mesh_builder.h"

#include <gtest/gtest.h>

#include <numbers>

namespace fovea::mesh_builder_test {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Volume within a closed mesh whose triangles face outward (divergence theorem).
double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    sum += mesh.corner(t, 0).dot(mesh.corner(t, 1).cross(mesh.corner(t, 2))) / 6;
  }
  return sum;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    const Vector3d a = mesh.corner(t, 0);
    sum += 0.5 * (mesh.corner(t, 1) - a).cross(mesh.corner(t, 2) - a).norm();
  }
  return sum;
}

/// Largest error of a texture coordinate's length along an edge, where it is in metres.
double stretch(const TriangleMesh& mesh) {
  double worst = 0;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangle[t][k], b = mesh.triangle[t][(k + 1) % 3];
      worst = std::max(worst, std::abs((mesh.position[a] - mesh.position[b]).norm() -
                                       double((mesh.texture[a] - mesh.texture[b]).norm())));
    }
  }
  return worst;
}

TEST(MeshBuilder, QuadIsTexturedInMetresFromItsFirstCorner) {
  MeshBuilder make;
  make.material = 4;
  make.surface = 9;
  make.texture_origin = {10, 20, 30};
  make.quad({1, 0, 0}, {3, 0, 0}, {3, 0, 1}, {1, 0, 1});
  const TriangleMesh& mesh = make.mesh();
  EXPECT_NO_THROW(mesh.check());
  ASSERT_EQ(mesh.size(), 2u);
  EXPECT_EQ(mesh.texture[0], Vector3f(10, 20, 30));
  EXPECT_EQ(mesh.texture[1], Vector3f(12, 20, 30));
  EXPECT_EQ(mesh.texture[3], Vector3f(10, 21, 30));
  EXPECT_EQ(mesh.material, (std::vector<std::uint16_t>{4, 4}));
  EXPECT_EQ(mesh.surface, (std::vector<std::uint32_t>{9, 9}));
  EXPECT_LT((mesh.normal(0) - Vector3d(0, -1, 0)).norm(), 1e-15);
  EXPECT_LT((mesh.normal(1) - Vector3d(0, -1, 0)).norm(), 1e-15);
}

TEST(MeshBuilder, ItsFrameMovesWhatIsGiven) {
  MeshBuilder make;
  make.frame.translation() = Vector3d(5, 0, 0);
  make.frame.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()).matrix();
  make.triangle({1, 0, 0}, {1, 1, 0}, {1, 0, 1});
  EXPECT_LT((make.mesh().corner(0, 0) - Vector3d(5, 1, 0)).norm(), 1e-12);
  EXPECT_LT((make.mesh().corner(0, 1) - Vector3d(4, 1, 0)).norm(), 1e-12);
  EXPECT_LT((make.mesh().normal(0) - Vector3d(0, 1, 0)).norm(), 1e-12);
  const TriangleMesh there = make.take();
  MeshBuilder other;
  other.frame = make.frame;
  other.append(there);  // is not moved again
  EXPECT_EQ(other.mesh().position, there.position);
}

TEST(MeshBuilder, BoxIsClosedAndFacesOutward) {
  MeshBuilder make;
  make.box({1, 2, 3}, {2, 4, 6});
  const TriangleMesh mesh = make.take();
  EXPECT_NO_THROW(mesh.check());
  EXPECT_EQ(mesh.size(), 12u);
  EXPECT_NEAR(volume(mesh), 6, 1e-12);
  EXPECT_NEAR(area(mesh), 22, 1e-12);
  EXPECT_LT(stretch(mesh), 1e-6);
  const Vector3d middle(1.5, 3, 4.5);
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    EXPECT_GT(mesh.normal(t).dot(mesh.corner(t, 0) - middle), 0.4);
  }
}

TEST(MeshBuilder, BarIsAPrismWithEnds) {
  constexpr int kSides = 48;
  MeshBuilder make;
  make.bar({0, 0, 1}, {0, 0, 4}, 0.5, 0.5, kSides);
  const double base = 0.5 * kSides * 0.25 * std::sin(2 * std::numbers::pi / kSides);
  EXPECT_NEAR(volume(make.mesh()), 3 * base, 1e-12);
  // A cone's frustum, lying.
  MeshBuilder cone;
  cone.bar({0, 0, 0}, {2, 0, 0}, 0.5, 0.25, kSides);
  EXPECT_NEAR(volume(cone.mesh()), 2 * base * (1 + 0.5 + 0.25) / 3, 1e-3);
  EXPECT_GT(volume(cone.mesh()), 0);
}

TEST(MeshBuilder, BallComesNearAnEllipsoid) {
  MeshBuilder make;
  make.ball({7, 8, 9}, {1, 2, 3}, 64);
  const TriangleMesh mesh = make.take();
  EXPECT_NO_THROW(mesh.check());
  EXPECT_NEAR(volume(mesh), 4 * std::numbers::pi / 3 * 6, 0.15);
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    const Vector3d middle = (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3;
    EXPECT_GT(mesh.normal(t).dot(middle - Vector3d(7, 8, 9)), 0);
    EXPECT_GT(mesh.normal(t).norm(), 0.5);  // none without an area
    for (int k = 0; k < 3; ++k) {
      const Vector3d unit =
          (mesh.corner(t, k) - Vector3d(7, 8, 9)).cwiseQuotient(Vector3d(1, 2, 3));
      EXPECT_NEAR(unit.norm(), 1, 1e-12);
    }
  }
}

}  // namespace fovea::mesh_builder_test
