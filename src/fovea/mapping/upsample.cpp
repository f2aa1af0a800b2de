#include "fovea/mapping/upsample.h"

#include <cmath>
#include <stdexcept>

#include "fovea/base/errors.h"
#include "fovea/mapping/delaunay.h"

namespace fovea {
namespace {

/// Grid steps a pixel: exact predicates cost nothing in precision at a thousandth of a pixel.
constexpr double kGridSteps = 1024;
/// A point without a vertex of its own takes its representative's normal only if it is this near (m).
constexpr float kSameSurface = 0.05f;
constexpr std::int32_t kNone = -1;

/// The triangulation of a growing cloud's pixels, and which point each vertex stands for.
class ImageTriangulation {
 public:
  ImageTriangulation(PointCloud& cloud_cam, const Camera& camera)
      : cloud_(cloud_cam), camera_(camera), vertex_of_(cloud_cam.size(), kNone) {
    std::vector<GridPoint> pixels;
    std::vector<std::uint32_t> owners;
    for (std::uint32_t i = 0; i < cloud_.size(); ++i) {
      const auto pixel = grid_pixel(cloud_.position[i]);
      if (!pixel) continue;  // so far to the side that no camera sees it: kept, but no vertex
      pixels.push_back(*pixel);
      owners.push_back(i);
    }
    const std::vector<std::int32_t> vertices = triangulation_.insert(pixels);
    point_of_.assign(triangulation_.points().size(), kNone);
    for (std::size_t k = 0; k < owners.size(); ++k) {
      vertex_of_[owners[k]] = vertices[k];
      std::int32_t& owner = point_of_[std::size_t(vertices[k])];
      if (owner == kNone || cloud_.position[owners[k]].squaredNorm() <
                                cloud_.position[std::size_t(owner)].squaredNorm()) {
        owner = static_cast<std::int32_t>(owners[k]);
      }
    }
  }

  struct Face {
    std::int32_t triangle;
    std::array<std::uint32_t, 3> point;
    Eigen::Vector3f scaled_normal;  ///< towards the camera, twice the area long
  };

  /// The finite triangles whose three 3D edges are shorter than `max_edge`.
  std::vector<Face> faces(double max_edge) const {
    std::vector<Face> result;
    const auto limit = static_cast<float>(max_edge * max_edge);
    for (std::size_t t = 0; t < triangulation_.triangle_count(); ++t) {
      if (!triangulation_.is_finite(t)) continue;
      Face face{static_cast<std::int32_t>(t), {}, {}};
      const auto vertices = triangulation_.vertices(t);
      for (std::size_t k = 0; k < 3; ++k) {
        face.point[k] = static_cast<std::uint32_t>(point_of_[std::size_t(vertices[k])]);
      }
      const Eigen::Vector3f& a = cloud_.position[face.point[0]];
      const Eigen::Vector3f ab = cloud_.position[face.point[1]] - a;
      const Eigen::Vector3f ac = cloud_.position[face.point[2]] - a;
      if (ab.squaredNorm() >= limit || ac.squaredNorm() >= limit ||
          (ac - ab).squaredNorm() >= limit) {
        continue;
      }
      face.scaled_normal = ab.cross(ac);
      if (face.scaled_normal.dot(a) > 0) face.scaled_normal = -face.scaled_normal;
      result.push_back(face);
    }
    return result;
  }

  /// Adds each face's centroid to the cloud and its pixel to the triangulation; a centroid whose pixel
  /// has a vertex already is left out.
  void insert_centroids(const std::vector<Face>& faces) {
    std::vector<GridPoint> pixels;
    std::vector<std::int32_t> triangles;
    std::vector<Eigen::Vector3f> centroids;
    for (const Face& face : faces) {
      centroids.push_back((cloud_.position[face.point[0]] + cloud_.position[face.point[1]] +
                           cloud_.position[face.point[2]]) /
                          3.0f);
      pixels.push_back(grid_pixel(centroids.back()).value());  // lies between three that have one
      triangles.push_back(face.triangle);
    }
    const std::size_t vertices_before = triangulation_.points().size();
    const std::vector<std::int32_t> vertices = triangulation_.insert(pixels, triangles);
    point_of_.resize(triangulation_.points().size(), kNone);
    for (std::size_t i = 0; i < faces.size(); ++i) {
      std::int32_t& owner = point_of_[std::size_t(vertices[i])];
      if (std::size_t(vertices[i]) < vertices_before || owner != kNone) continue;
      owner = static_cast<std::int32_t>(cloud_.size());
      add_point(faces[i], centroids[i]);
    }
  }

  /// Area-weighted normals of the measured points from the faces around them.
  void set_normals(const std::vector<Face>& faces) {
    cloud_.normal.assign(cloud_.size(), Eigen::Vector3f::Zero());
    for (const Face& face : faces) {
      for (const std::uint32_t i : face.point) cloud_.normal[i] += face.scaled_normal;
    }
    for (Eigen::Vector3f& normal : cloud_.normal) normal.normalize();  // zero stays zero
    for (std::size_t i = 0; i < vertex_of_.size(); ++i) {
      if (vertex_of_[i] == kNone) continue;
      const auto owner = std::size_t(point_of_[std::size_t(vertex_of_[i])]);
      if (owner != i && (cloud_.position[i] - cloud_.position[owner]).norm() < kSameSurface) {
        cloud_.normal[i] = cloud_.normal[owner];
      }
    }
  }

 private:
  std::optional<GridPoint> grid_pixel(const Eigen::Vector3f& p_cam) const {
    const auto pixel = camera_.project(p_cam.cast<double>());
    if (!pixel) throw std::invalid_argument("upsampling: a point is not in front of the camera");
    const Eigen::Vector2d scaled = *pixel * kGridSteps;
    if (!(scaled.cwiseAbs().maxCoeff() <= kMaxGridCoordinate)) return std::nullopt;
    return GridPoint{static_cast<std::int32_t>(std::lround(scaled.x())),
                     static_cast<std::int32_t>(std::lround(scaled.y()))};
  }

  void add_point(const Face& face, const Eigen::Vector3f& centroid) {
    cloud_.position.push_back(centroid);
    cloud_.normal.push_back(face.scaled_normal.normalized());
    cloud_.interpolated.push_back(1);
    const auto mean = [&](std::vector<float>& column) {
      if (column.empty()) return;
      column.push_back((column[face.point[0]] + column[face.point[1]] + column[face.point[2]]) / 3);
    };
    const auto first = [&](auto& column) {
      if (!column.empty()) column.push_back(column[face.point[0]]);
    };
    mean(cloud_.intensity);
    mean(cloud_.range);
    mean(cloud_.incidence);
    first(cloud_.color);
    first(cloud_.frame);
    first(cloud_.camera);
  }

  PointCloud& cloud_;
  const Camera& camera_;
  DelaunayTriangulation triangulation_;
  std::vector<std::int32_t> vertex_of_;  // of each measured point, or kNone
  std::vector<std::int32_t> point_of_;   // of each vertex
};

}  // namespace

void UpsampleOptions::validate() const {
  if (rate < 0 || rate > 5) {
    throw ConfigError("a rate is out of range", "upsample.rate", "give 0 to 5");
  }
  if (!(max_edge > 0 && max_edge <= 1000)) {
    throw ConfigError("a length is out of range", "upsample.max_edge", "give metres above 0");
  }
}

PointCloud upsample(const PointCloud& points_cam, const Camera& camera,
                    const UpsampleOptions& options) {
  PointCloud cloud = points_cam;
  if (cloud.interpolated.empty()) cloud.interpolated.assign(cloud.size(), 0);
  ImageTriangulation triangulation(cloud, camera);
  std::vector<ImageTriangulation::Face> faces = triangulation.faces(options.max_edge);
  triangulation.set_normals(faces);
  for (int pass = 0; pass < options.rate; ++pass) {
    if (pass > 0) faces = triangulation.faces(options.max_edge);
    triangulation.insert_centroids(faces);
  }
  return cloud;
}

}  // namespace fovea
