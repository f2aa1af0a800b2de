// Incremental Delaunay triangulation of points on a grid, exact (paper: Pose Refinement).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "fovea/mapping/grid_predicates.h"

namespace fovea {

/// Delaunay triangulation that grows by insertion and covers exactly the points' convex hull.
///
/// If four or more points are cocircular, the order of insertion alone decides which Delaunay
/// triangulation results. While all points are collinear there are vertices, but no triangles.
class DelaunayTriangulation {
 public:
  static constexpr std::int32_t kInfiniteVertex = -1;
  static constexpr std::int32_t kNoTriangle = -1;
  /// Edge numbers have 32 bits.
  static constexpr std::size_t kMaxVertices = std::size_t{1} << 27;

  /// Vertices counter-clockwise (x right, y up). A triangle outside the hull consists of an edge of
  /// the hull and kInfiniteVertex. It closes the plane: every triangle has three neighbors.
  using Vertices = std::array<std::int32_t, 3>;

  struct Insertion {
    std::int32_t vertex = 0;              ///< of the point, or of the equal point that was there
    bool inserted = false;                ///< false: there was a vertex at this grid point
    std::int32_t triangle = kNoTriangle;  ///< at or next to the vertex: a hint for near points
  };

  /// Removes all points and keeps the memory.
  void clear();

  /// Inserts a point. Vertices are numbered in the order of insertion. Throws std::invalid_argument
  /// if the point is not on_grid() or `hint` is no triangle, std::length_error beyond kMaxVertices.
  /// @param hint  any triangle; a near one makes the insertion faster
  Insertion insert(GridPoint point, std::int32_t hint = kNoTriangle);

  /// Inserts many points, in an order that puts near points near in memory. Errors as above.
  /// @return the vertex of each point; equal points share one
  std::vector<std::int32_t> insert(std::span<const GridPoint> points);

  /// Inserts points, each with a triangle as its hint.
  /// @param triangles  hints; std::invalid_argument if their number differs from that of the points
  /// @return the point of each new vertex, in order; a point at an existing vertex has none
  std::vector<std::uint32_t> insert(std::span<const GridPoint> points,
                                    std::span<const std::int32_t> triangles);

  /// Grid points by vertex.
  std::span<const GridPoint> points() const { return points_; }

  /// Number of triangles, including those with the infinite vertex. Insertions renumber them.
  std::size_t triangle_count() const { return triangles_.size(); }
  const Vertices& vertices(std::size_t triangle) const { return triangles_[triangle].vertex; }
  bool is_finite(std::size_t triangle) const {
    const auto& v = triangles_[triangle].vertex;
    return (v[0] | v[1] | v[2]) >= 0;
  }
  /// The triangle beyond the edge opposite vertex `corner` (0-2).
  std::int32_t neighbor(std::size_t triangle, int corner) const {
    return triangles_[triangle].twin[corner] >> 2;
  }

 private:
  // An edge of one of its two triangles: 4 * triangle + the corner opposite to it. Four instead of
  // three allows shifts, and a triangle never straddles a cache line.
  using Edge = std::int32_t;
  struct alignas(32) Triangle {
    std::array<std::int32_t, 3> vertex;
    std::array<Edge, 3> twin;  // the same edge in the triangle beyond, opposite each vertex
  };
  // The next and the previous edge of the same triangle, without branches.
  static Edge next(Edge edge) { return edge + 1 - 3 * (edge >> 1 & 1); }
  static Edge previous(Edge edge) { return edge - 1 + 3 * (~(edge | edge >> 1) & 1); }
  std::int32_t& apex(Edge edge) { return triangles_[edge >> 2].vertex[edge & 3]; }
  std::int32_t apex(Edge edge) const { return triangles_[edge >> 2].vertex[edge & 3]; }
  Edge& twin(Edge edge) { return triangles_[edge >> 2].twin[edge & 3]; }
  Edge twin(Edge edge) const { return triangles_[edge >> 2].twin[edge & 3]; }
  GridPoint at(std::int32_t vertex) const { return points_[static_cast<std::size_t>(vertex)]; }
  void join(Edge a, Edge b) { twin(a) = b, twin(b) = a; }

  void check_arguments(std::span<const GridPoint> points,
                       std::span<const std::int32_t> hints) const;
  // insert() without checks of the arguments.
  Insertion insert_checked(GridPoint point, std::int32_t hint);
  std::int32_t add_vertex(GridPoint point);
  Insertion insert_while_collinear(GridPoint point);
  void start_with(std::int32_t apex_vertex);
  std::int32_t locate(GridPoint point, std::int32_t hint) const;
  void split_triangle(std::int32_t triangle, std::int32_t vertex);
  bool must_flip(Edge edge) const;
  void flip(Edge edge);
  void legalize_star(std::int32_t triangle);
  void order_triangles();

  std::vector<GridPoint> points_;
  std::vector<Triangle> triangles_;
  // The vertices while all are collinear, in their order on the line.
  std::map<GridPoint, std::int32_t> collinear_;
};

}  // namespace fovea
