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
/// Where four or more points are cocircular, which of the Delaunay triangulations results depends
/// on the order of insertion, and on nothing else. Until the first three points that are not
/// collinear there are vertices, but no triangles.
class DelaunayTriangulation {
 public:
  static constexpr std::int32_t kInfiniteVertex = -1;
  static constexpr std::int32_t kNoTriangle = -1;
  /// The most vertices there can be: edge numbers are 32-bit.
  static constexpr std::size_t kMaxVertices = std::size_t{1} << 27;

  /// Vertices counter-clockwise (x right, y up). Of a triangle outside the hull one vertex is
  /// kInfiniteVertex and the other two are an edge of the hull; this closes the plane, so that
  /// every triangle has three neighbours.
  using Vertices = std::array<std::int32_t, 3>;

  struct Insertion {
    std::int32_t vertex = 0;              ///< of the point, or of the equal one that was there
    bool inserted = false;                ///< false: there was a vertex at this very grid point
    std::int32_t triangle = kNoTriangle;  ///< one at or beside the vertex: a hint for what is near
  };

  /// Back to no points; memory is kept for the next ones.
  void clear();

  /// Inserts a point. Vertices are numbered in the order of insertion. `hint` is any triangle, the
  /// nearer the faster. std::invalid_argument if the point is not on_grid() or `hint` is no
  /// triangle, std::length_error beyond kMaxVertices.
  Insertion insert(GridPoint point, std::int32_t hint = kNoTriangle);

  /// Inserts many points, in an order of its own that makes near ones neighbours in memory.
  /// @return the vertex of each point; equal points have the same. Errors as above.
  std::vector<std::int32_t> insert(std::span<const GridPoint> points);

  /// Inserts points near each of which a triangle is known: those strictly inside a triangle of
  /// their own are not searched for, and the edges are made Delaunay once for all, not once a
  /// point.
  /// @param triangles  one a point, as `hint` above; std::invalid_argument if the numbers differ
  /// @return of each new vertex, in order, the index of its point; a point where there was a vertex
  ///         already gets none
  std::vector<std::uint32_t> insert(std::span<const GridPoint> points,
                                    std::span<const std::int32_t> triangles);

  /// Grid points by vertex.
  std::span<const GridPoint> points() const { return points_; }

  /// Number of triangles, those with the infinite vertex included. Insertions change the triangles
  /// and their numbers.
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
  // An edge, as seen from one of its two triangles: 4 * triangle + the corner opposite to it. Four,
  // not three, for shifts instead of divisions, and for triangles that never straddle a cache line.
  using Edge = std::int32_t;
  struct alignas(32) Triangle {
    std::array<std::int32_t, 3> vertex;
    std::array<Edge, 3> twin;  // of the edge opposite each vertex, its number from beyond
  };
  // What becomes of a triangle when many are split at once.
  struct Fan {
    std::int32_t vertex = kInfiniteVertex;  // at which it is split, if at all
    std::int32_t first = 0;  // where it is then: whole, or the first of three triangles in a row
    bool is_split() const { return vertex != kInfiniteVertex; }
    /// Of the whole triangle's edge opposite `corner`; split, it is number 0 of that part.
    Edge edge(int corner) const { return is_split() ? 4 * (first + corner) : 4 * first + corner; }
  };
  // The next and the previous edge of the same triangle, without the branches that a processor
  // would mispredict all the time.
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
  // As insert(), without looking at the arguments again.
  Insertion insert_checked(GridPoint point, std::int32_t hint);
  std::int32_t add_vertex(GridPoint point);
  Insertion insert_while_collinear(GridPoint point);
  void start_with(std::int32_t apex_vertex);
  std::int32_t locate(GridPoint point, std::int32_t hint) const;
  bool strictly_inside(GridPoint point, std::int32_t triangle) const;
  void split(std::int32_t triangle, std::int32_t vertex);
  bool must_flip(Edge edge) const;
  void flip(Edge edge);
  void legalize_star(std::int32_t triangle);
  void legalize_suspects();
  void split_all(std::span<Fan> fans);
  void put_fan(const Triangle& whole, const std::array<Edge, 3>& outside, const Fan& fan,
               std::span<const Fan> fans);
  void order_triangles();

  std::vector<GridPoint> points_;
  std::vector<Triangle> triangles_;
  std::vector<Triangle> unsplit_;  // what triangles_ was before split_all()
  std::vector<Edge> suspects_;     // edges that may have to be flipped
  // The vertices while they are collinear, in their order on the line.
  std::map<GridPoint, std::int32_t> collinear_;
};

}  // namespace fovea
