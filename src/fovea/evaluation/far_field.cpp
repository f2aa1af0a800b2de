#include "fovea/evaluation/far_field.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "fovea/evaluation/cross_fit.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/mapping/scan_projection.h"
#include "fovea/mapping/surface.h"

namespace fovea {
namespace {

constexpr float kFine = 0.05f, kCoarse = 0.10f;  // m
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Heights of a scan in squares of one meter, LiDAR frame.
class HeightSquares {
 public:
  explicit HeightSquares(const PointCloud& scan_lidar) {
    for (const Eigen::Vector3f& p : scan_lidar.position) {
      Heights& heights = squares_.try_emplace(square_of(p), p.z(), p.z()).first->second;
      heights = {std::min(heights.first, p.z()), std::max(heights.second, p.z())};
    }
  }

  /// Up to 30 cm above the lowest return of its square, and 50 cm or more below the LiDAR.
  bool on_ground(const Eigen::Vector3f& p) const {
    constexpr float kAbove = 0.3f, kBelowLidar = 0.5f;
    return p.z() < squares_.at(square_of(p)).first + kAbove && p.z() < -kBelowLidar;
  }
  /// Whether nothing stands on the ground around a return: the heights of its square and of the
  /// eight around it differ by less than 30 cm.
  bool is_level(const Eigen::Vector3f& p) const {
    constexpr float kLevel = 0.3f;
    Heights all{p.z(), p.z()};
    for (const int dx : {-1, 0, 1}) {
      for (const int dy : {-1, 0, 1}) {
        const auto [x, y] = square_of(p);
        const auto found = squares_.find({x + dx, y + dy});
        if (found == squares_.end()) continue;
        all = {std::min(all.first, found->second.first),
               std::max(all.second, found->second.second)};
      }
    }
    return all.second - all.first < kLevel;
  }

 private:
  using Heights = std::pair<float, float>;  // lowest, highest
  static std::pair<int, int> square_of(const Eigen::Vector3f& p) {
    return {int(std::floor(p.x())), int(std::floor(p.y()))};
  }
  std::map<std::pair<int, int>, Heights> squares_;
};

/// Normal of a flat upright surface from the nearest returns; zero where there is none.
Eigen::Vector3f upright_normal(const PointCloud& scan_lidar, const KdTree& tree,
                               const Eigen::Vector3f& p) {
  constexpr std::size_t kNeighbors = 16;
  constexpr double kFlat = 0.03;    // m, deviation from the plane
  constexpr double kWide = 0.1;     // m, deviation along the plane
  constexpr float kUpright = 0.5f;  // most of the normal that is vertical
  std::vector<Neighbor> neighbors;
  tree.nearest_k(p, kNeighbors, neighbors);
  Eigen::Matrix3Xd offsets(3, neighbors.size());
  for (std::size_t k = 0; k < neighbors.size(); ++k) {
    offsets.col(Eigen::Index(k)) = (scan_lidar.position[neighbors[k].index] - p).cast<double>();
  }
  offsets.colwise() -= offsets.rowwise().mean().eval();
  const Eigen::Matrix3d spread = offsets * offsets.transpose() / double(neighbors.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  const Eigen::Vector3d deviations = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  const Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>();
  const bool is_flat = deviations[0] < kFlat && deviations[1] > kWide;
  return is_flat && std::abs(normal.z()) < kUpright ? normal : Eigen::Vector3f::Zero();
}

/// Whether a line through a surface meets two layers of map points: the offsets of the points near
/// it have a gap.
bool has_two_layers(const KdTree& tree, const std::vector<Eigen::Vector3f>& map,
                    const Eigen::Vector3f& p, const Eigen::Vector3f& normal) {
  constexpr float kReach = 0.5f, kStep = 0.05f, kRadius = 0.1f, kGap = 0.08f;  // m
  std::vector<float> offsets;
  for (float along = -kReach; along <= kReach; along += kStep) {
    const Eigen::Vector3f query = p + along * normal;
    const Neighbor nearest = tree.nearest(query, kRadius);
    if (nearest.squared_distance <= kRadius * kRadius) {
      offsets.push_back((map[nearest.index] - p).dot(normal));
    }
  }
  std::sort(offsets.begin(), offsets.end());
  return std::adjacent_find(offsets.begin(), offsets.end(),
                            [](float a, float b) { return b - a > kGap; }) != offsets.end();
}

/// The returns in one band.
class BandComparison {
 public:
  BandComparison(const FarMap& map, const PointCloud& measured, const PointCloud& scan,
                 const PlacedFrame& placed, const Camera& camera)
      : map_(map),
        measured_(measured),
        scan_(scan),
        placed_(placed),
        camera_(camera),
        hiding_(scan, camera),
        scan_tree_(scan.position),
        heights_(scan) {}

  FarBand compare(const RangeBand& band, const FarPictures& pictures) const {
    EvaluatedView view =
        without_masked(evaluated_view(measured_, scan_, placed_, camera_, pictures.photograph,
                                      map_.origin_local, band),
                       pictures.mask);
    std::vector<std::uint8_t> visible;
    visible.reserve(view.pixel.size());
    for (std::size_t i = 0; i < view.pixel.size(); ++i) {
      const std::uint16_t sensor = scan_.sensor_at(view.scan_index[i]);
      visible.push_back(hiding_.hidden(view.pixel[i], p_cam(view, i).norm(), sensor) ? 0 : 1);
    }
    view = select(view, visible);
    const NearestSamples nearest = nearest_samples(view.position, map_.tree, map_.color);
    const std::vector<Eigen::Vector3f> color = cross_fitted(view, nearest.color);
    FarBand sums;
    for (std::size_t i = 0; i < view.position.size(); ++i) {
      const bool is_ground = heights_.on_ground(scan_.position[view.scan_index[i]]);
      FarSums& of_kind = is_ground ? sums.ground : sums.upright;
      const auto footprint = static_cast<float>(p_cam(view, i).z() / camera_.fx);
      const bool covered = nearest.distance[i] <= std::max(kCoarse, footprint);
      ++of_kind.points;
      of_kind.covered_5cm += nearest.distance[i] <= std::max(kFine, footprint);
      of_kind.covered_10cm += covered;
      of_kind.color += double(color_error(view.color[i], color[i], view.grey));
      const Eigen::Vector3f normal = normal_local(view.scan_index[i], is_ground);
      if (!covered || normal.isZero()) continue;
      ++of_kind.flat;
      of_kind.double_layer += has_two_layers(map_.tree, map_.position, view.position[i], normal);
    }
    return sums;
  }

 private:
  Eigen::Vector3d p_cam(const EvaluatedView& view, std::size_t i) const {
    return camera_.T_cam_lidar * scan_.position[view.scan_index[i]].cast<double>();
  }
  /// Zero where the surface is not flat.
  Eigen::Vector3f normal_local(std::uint32_t i, bool is_ground) const {
    const Eigen::Vector3f& p = scan_.position[i];
    if (is_ground) {  // rings are too far apart for a normal
      if (!heights_.is_level(p)) return Eigen::Vector3f::Zero();
      return Eigen::Vector3f::UnitZ();
    }
    const Eigen::Vector3f normal = upright_normal(scan_, scan_tree_, p);
    return placed_.T_local_lidar.linear().cast<float>() * normal;
  }

  const FarMap& map_;
  const PointCloud &measured_, &scan_;
  const PlacedFrame& placed_;
  const Camera& camera_;
  ScanProjection hiding_;
  KdTree scan_tree_;
  HeightSquares heights_;
};

/// Marks the pixels whose centers lie in a triangle.
void mark_triangle(const std::array<Eigen::Vector2d, 3>& corner, const Camera& camera,
                   std::vector<std::uint8_t>& marks) {
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  const Eigen::Vector2d low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]);
  const Eigen::Vector2d high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]);
  const double turn = cross(corner[1] - corner[0], corner[2] - corner[0]) < 0 ? -1 : 1;
  const int bottom = std::min(camera.height - 1, int(high.y()));
  const int right = std::min(camera.width - 1, int(high.x()));
  for (int y = std::max(0, int(std::ceil(low.y()))); y <= bottom; ++y) {
    for (int x = std::max(0, int(std::ceil(low.x()))); x <= right; ++x) {
      bool is_inside = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector2d &a = corner[k], &b = corner[(k + 1) % 3];
        is_inside = is_inside && turn * cross(b - a, Eigen::Vector2d(x, y) - a) >= 0;
      }
      if (is_inside) marks[std::size_t(y) * std::size_t(camera.width) + std::size_t(x)] = 1;
    }
  }
}

/// The pixels between visible returns of one surface, up to the last band's end.
std::vector<std::uint8_t> measured_pixels(const PointCloud& scan, const Camera& camera) {
  std::vector<std::uint32_t> in_view;
  for (std::uint32_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d p = scan.position[i].cast<double>();
    const bool is_near =
        p.norm() > double(kEvaluatedNear) && p.norm() < double(kFarBands.back().far);
    if (is_near && scored_pixel(camera, Eigen::Vector3d(camera.T_cam_lidar * p)))
      in_view.push_back(i);
  }
  PointCloud points_cam = transform_cloud(scan.select(in_view), camera.T_cam_lidar);
  drop_hidden(points_cam, scan, camera);
  const Surface surface = find_surface(points_cam, camera, SurfaceOptions{});
  std::vector<std::uint8_t> marks(std::size_t(camera.width) * std::size_t(camera.height));
  for (const auto& vertices : surface.triangles) {
    std::array<Eigen::Vector2d, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = *camera.project(surface.mesh.position[std::size_t(vertices[k])].cast<double>());
    }
    mark_triangle(corner, camera, marks);
  }
  return marks;
}

}  // namespace

FarSums& FarSums::operator+=(const FarSums& other) {
  points += other.points;
  covered_5cm += other.covered_5cm;
  covered_10cm += other.covered_10cm;
  color += other.color;
  flat += other.flat;
  double_layer += other.double_layer;
  return *this;
}

FarField& FarField::operator+=(const FarField& other) {
  for (std::size_t band = 0; band < bands.size(); ++band) {
    bands[band].ground += other.bands[band].ground;
    bands[band].upright += other.bands[band].upright;
  }
  measured += other.measured;
  holes += other.holes;
  squared += other.squared;
  return *this;
}

FarSums FarField::all() const {
  FarSums sums;
  for (const FarBand& band : bands) (sums += band.ground) += band.upright;
  return sums;
}

double FarField::share_of_holes() const {
  return measured == 0 ? kNone : double(holes) / double(measured);
}

double FarField::psnr() const {
  return measured == 0 ? kNone : 10 * std::log10(255 * 255 * double(measured) / squared);
}

FarField compare_far_field(const FarMap& map, const PointCloud& measured_lidar,
                           const PointCloud& compensated_lidar, const PlacedFrame& placed,
                           const Camera& camera, const FarPictures& pictures) {
  const Image& photograph = pictures.photograph;
  const SplatView& drawn = pictures.drawn;
  FarField field;
  const BandComparison comparison(map, measured_lidar, compensated_lidar, placed, camera);
  for (std::size_t band = 0; band < kFarBands.size(); ++band) {
    field.bands[band] = comparison.compare(kFarBands[band], pictures);
  }
  const std::vector<std::uint8_t> measured = measured_pixels(compensated_lidar, camera);
  for (std::size_t pixel = 0; pixel < measured.size(); ++pixel) {
    if (measured[pixel] == 0) continue;
    ++field.measured;
    field.holes += drawn.covered[pixel] == 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t in_photograph = photograph.channels == 1 ? pixel : 3 * pixel + c;
      const double difference =
          double(drawn.image.data[3 * pixel + c]) - double(photograph.data[in_photograph]);
      field.squared += difference * difference / 3;
    }
  }
  return field;
}

}  // namespace fovea
