#include "fovea/mapping/calibration/edge_profiles.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

namespace fovea {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kBorder = 4;    // pixels between a profile's ends and the image's border
constexpr float kNoise = 6;      // RGB: smaller steps do not count
constexpr float kContrast = 60;  // RGB: profiles with a smaller sum of steps have a lower weight
constexpr double kMinGap = 0.2;  // pixels
// Limits between neighbors on one line: distance in the image (rad), difference of range (share).
constexpr double kNeighborhood = 0.028, kSameRange = 0.03;
constexpr int kMinNeighbors = 3;  // the edge itself included
constexpr double kNeighborRings = 1.3;
constexpr double kMinSpread = 3;       // pixels, along the line
constexpr double kMaxThickness = 0.3;  // of the spread along the line
constexpr double kMinFacing = 0.25;  // cosine between the direction outwards and the line's normal
constexpr double kObjectCell = 2;    // m, an object's cell

/// Interpolated color, mean of three positions across the profile.
Eigen::Vector3f color_at(const Image& image, const Vector2d& p, const Vector2d& across) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int k = -1; k <= 1; ++k) {
    const Vector2d q = p + k * across;
    sum += bilinear(image, q.x(), q.y());
  }
  return sum / 3;
}

/// The expected position of an edge in the image.
struct ImageEdge {
  Vector2d middle = Vector2d::Zero(), gap = Vector2d::Zero();  // pixels; from inside to outside
  Vector3d p_lidar = Vector3d::Zero();
  double range = 0;
  bool between_rings = false;
};

std::vector<ImageEdge> edges_in_view(const LidarEdges& edges_lidar, const Camera& camera) {
  std::vector<ImageEdge> edges;
  for (std::size_t i = 0; i < edges_lidar.size(); ++i) {
    const Vector3d inside = edges_lidar.inside.position[i].cast<double>();
    const Vector3d outside = edges_lidar.outside.position[i].cast<double>();
    const auto from = camera.project(camera.T_cam_lidar * inside);
    const auto to = camera.project(camera.T_cam_lidar * outside);
    if (!from || !to || !camera.in_view(*from) || !camera.in_view(*to)) continue;
    if ((*to - *from).norm() < kMinGap) continue;
    const Vector3d p_lidar = 0.5 * (inside + outside);
    edges.push_back({0.5 * (*from + *to), *to - *from, p_lidar, p_lidar.norm(),
                     edges_lidar.between_rings[i] != 0});
  }
  // Sorted by u: neighbors are on either side.
  std::stable_sort(edges.begin(), edges.end(), [](const ImageEdge& a, const ImageEdge& b) {
    return a.middle.x() < b.middle.x();
  });
  return edges;
}

bool on_one_line(const ImageEdge& a, const ImageEdge& b, double near) {
  return (a.middle - b.middle).squaredNorm() <= near * near && a.gap.dot(b.gap) > 0 &&
         std::abs(a.range - b.range) <= kSameRange * a.range;
}

/// Unit normal, outwards, of the line through an edge and its neighbors on the same side of an
/// object. Empty if they are not on a line.
/// @param near  largest distance of a neighbor, pixels
std::optional<Vector2d> line_normal(const std::vector<ImageEdge>& edges, std::size_t own,
                                    double near) {
  const ImageEdge& edge = edges[own];
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  Vector2d sum = Vector2d::Zero();
  int count = 0;
  const auto add = [&](const ImageEdge& other) {
    if (!on_one_line(edge, other, near)) return;
    const Vector2d offset = other.middle - edge.middle;
    sum += offset;
    scatter += offset * offset.transpose();
    ++count;
  };
  const double left = edge.middle.x() - near, right = edge.middle.x() + near;
  for (std::size_t i = own; i < edges.size() && edges[i].middle.x() <= right; ++i) add(edges[i]);
  for (std::size_t i = own; i > 0 && edges[i - 1].middle.x() >= left; --i) add(edges[i - 1]);
  if (count < kMinNeighbors) return std::nullopt;

  scatter = Eigen::Matrix2d(scatter / count - (sum / count) * (sum / count).transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(scatter);
  const double across = eigen.eigenvalues()[0], along = eigen.eigenvalues()[1];
  if (along < kMinSpread * kMinSpread || across > kMaxThickness * kMaxThickness * along) {
    return std::nullopt;
  }
  Vector2d normal = eigen.eigenvectors().col(0);
  if (normal.dot(edge.gap) < 0) normal = -normal;
  if (normal.dot(edge.gap) < kMinFacing * edge.gap.norm()) return std::nullopt;
  return normal;
}

std::array<float, EdgeProfile::kSize> strengths(const Image& image, const Vector2d& middle,
                                                const Vector2d& along) {
  std::array<float, EdgeProfile::kSize> strength{};
  const Vector2d across(-along.y(), along.x());
  Eigen::Vector3f before = color_at(image, middle - (EdgeProfile::kReach + 0.5) * along, across);
  float sum = kContrast;
  for (int k = 0; k < EdgeProfile::kSize; ++k) {
    const Eigen::Vector3f after =
        color_at(image, middle + (k - EdgeProfile::kReach + 0.5) * along, across);
    strength[std::size_t(k)] = std::max(0.0f, (after - before).norm() - kNoise);
    sum += strength[std::size_t(k)];
    before = after;
  }
  for (float& s : strength) s /= sum;
  return strength;
}

}  // namespace

std::array<int, 3> object_cell(const Vector3d& p_local) {
  const Eigen::Vector3i cell = (p_local / kObjectCell).array().floor().cast<int>();
  return {cell.x(), cell.y(), cell.z()};
}

std::vector<EdgeProfile> profiles_of_lidars(const std::vector<LidarEdges>& edges_lidar,
                                            const Image& image, const EdgeView& view) {
  std::vector<EdgeProfile> profiles;
  for (const LidarEdges& edges : edges_lidar) {
    const std::vector<EdgeProfile> of_lidar = edge_profiles(edges, image, view);
    profiles.insert(profiles.end(), of_lidar.begin(), of_lidar.end());
  }
  return profiles;
}

std::vector<EdgeProfile> edge_profiles(const LidarEdges& edges_lidar, const Image& image,
                                       const EdgeView& view) {
  const Camera camera = view.camera.at_image(SweepMotion{view.velocity});
  const std::vector<ImageEdge> edges = edges_in_view(edges_lidar, camera);
  // A line has one edge along each ring, so the neighbors are on the next rings.
  const double near_along_ring = std::max(kNeighborhood, kNeighborRings * edges_lidar.ring_spacing);
  std::vector<EdgeProfile> profiles;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const ImageEdge& edge = edges[i];
    const double near = edge.between_rings ? kNeighborhood : near_along_ring;
    const auto along = line_normal(edges, i, near * camera.fx);
    if (!along) continue;
    const Vector2d reach = EdgeProfile::kReach * along->cwiseAbs() + Vector2d::Constant(kBorder);
    if (!camera.in_view(edge.middle - reach) || !camera.in_view(edge.middle + reach)) continue;
    EdgeProfile profile;
    profile.frame = view.frame;
    profile.ring_spacing = static_cast<float>(edges_lidar.ring_spacing);
    profile.place = object_cell(view.T_local_lidar * edge.p_lidar);
    profile.half_gap = static_cast<float>(edge.gap.dot(*along) / 2);
    profile.strength = strengths(image, edge.middle, *along);
    profile.pixel = edge.middle.cast<float>();
    profile.normal = along->cast<float>();
    profile.J = pixel_jacobian(camera, edge.p_lidar, view.velocity).cast<float>();
    profile.J_along << (along->cast<float>().transpose() * profile.J).transpose(),
        edge.between_rings ? 0.0f : 1.0f,
        edge.between_rings ? static_cast<float>(along->y()) : 0.0f;
    profiles.push_back(profile);
  }
  return profiles;
}

}  // namespace fovea
