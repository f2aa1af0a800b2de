#include "fovea/mapping/delaunay.h"

#include <algorithm>
#include <stdexcept>

#include "fovea/mapping/insertion_order.h"

namespace fovea {

void DelaunayTriangulation::clear() {
  points_.clear();
  triangles_.clear();
  collinear_.clear();
}

DelaunayTriangulation::Insertion DelaunayTriangulation::insert(GridPoint point, std::int32_t hint) {
  check_arguments({&point, 1}, {&hint, 1});
  return insert_checked(point, hint);
}

DelaunayTriangulation::Insertion DelaunayTriangulation::insert_checked(GridPoint point,
                                                                       std::int32_t hint) {
  if (triangles_.empty()) return insert_while_collinear(point);

  const std::int32_t triangle = locate(point, hint == kNoTriangle ? 0 : hint);
  for (const std::int32_t vertex : vertices(triangle)) {
    if (vertex != kInfiniteVertex && at(vertex) == point) return {vertex, false, triangle};
  }
  const std::int32_t vertex = add_vertex(point);
  split_triangle(triangle, vertex);
  legalize_star(triangle);
  return {vertex, true, triangle};
}

std::vector<std::int32_t> DelaunayTriangulation::insert(std::span<const GridPoint> points) {
  check_arguments(points, {});
  if (points_.empty()) {
    points_.reserve(points.size());
    triangles_.reserve(2 * points.size());
  }
  std::vector<std::int32_t> vertex_of(points.size());
  std::int32_t hint = kNoTriangle;
  for (const std::uint32_t i : insertion_order(points)) {
    const Insertion insertion = insert_checked(points[i], hint);
    vertex_of[i] = insertion.vertex;
    hint = insertion.triangle;
  }
  order_triangles();
  return vertex_of;
}

std::vector<std::uint32_t> DelaunayTriangulation::insert(std::span<const GridPoint> points,
                                                         std::span<const std::int32_t> triangles) {
  if (points.size() != triangles.size()) {
    throw std::invalid_argument("Delaunay triangulation: each point needs a triangle");
  }
  check_arguments(points, triangles);
  std::vector<std::uint32_t> point_of;
  point_of.reserve(points.size());
  points_.reserve(points_.size() + points.size());
  triangles_.reserve(triangles_.size() + 2 * points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (insert_checked(points[i], triangles[i]).inserted) point_of.push_back(i);
  }
  order_triangles();
  return point_of;
}

// Renumbers the triangles by their latest vertices, which follow a curve through the plane. Near
// triangles are then near in memory.
void DelaunayTriangulation::order_triangles() {
  const auto latest = [](const Triangle& triangle) {
    return static_cast<std::size_t>(std::ranges::max(triangle.vertex));
  };
  std::vector<std::int32_t> start(points_.size() + 1, 0);
  for (const Triangle& triangle : triangles_) ++start[latest(triangle) + 1];
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<std::int32_t> moved_to;
  moved_to.reserve(triangles_.size());
  for (const Triangle& triangle : triangles_) moved_to.push_back(start[latest(triangle)]++);

  const std::vector<Triangle> before(triangles_);
  for (std::size_t t = 0; t < before.size(); ++t) {
    Triangle& triangle = triangles_[moved_to[t]] = before[t];
    for (Edge& edge : triangle.twin) edge = 4 * moved_to[edge >> 2] + (edge & 3);
  }
}

void DelaunayTriangulation::check_arguments(std::span<const GridPoint> points,
                                            std::span<const std::int32_t> hints) const {
  if (!std::ranges::all_of(points, on_grid)) {
    throw std::invalid_argument("Delaunay triangulation: point beyond the grid (2^29)");
  }
  const auto is_hint = [&](std::int32_t hint) {
    return hint >= kNoTriangle && hint < static_cast<std::int64_t>(triangles_.size());
  };
  if (!std::ranges::all_of(hints, is_hint)) {
    throw std::invalid_argument("Delaunay triangulation: the hint is not one of its triangles");
  }
  if (points.size() > kMaxVertices - points_.size()) {
    throw std::length_error("Delaunay triangulation: more than 2^27 vertices");
  }
}

std::int32_t DelaunayTriangulation::add_vertex(GridPoint point) {
  points_.push_back(point);
  return static_cast<std::int32_t>(points_.size()) - 1;
}

DelaunayTriangulation::Insertion DelaunayTriangulation::insert_while_collinear(GridPoint point) {
  if (const auto found = collinear_.find(point); found != collinear_.end()) {
    return {found->second, false, kNoTriangle};
  }
  const std::int32_t vertex = add_vertex(point);
  if (vertex < 2 || orientation(at(0), at(1), point) == 0) {
    collinear_.emplace(point, vertex);
    return {vertex, true, kNoTriangle};
  }
  start_with(vertex);
  return {vertex, true, 0};
}

// Creates the first triangle and the three outside of its edges, then inserts the collinear
// vertices.
void DelaunayTriangulation::start_with(std::int32_t apex_vertex) {
  const bool left = orientation(at(0), at(1), at(apex_vertex)) > 0;
  const std::int32_t a = left ? 0 : 1, b = left ? 1 : 0, c = apex_vertex;
  triangles_.push_back({{a, b, c}, {}});
  triangles_.push_back({{kInfiniteVertex, c, b}, {}});
  triangles_.push_back({{kInfiniteVertex, a, c}, {}});
  triangles_.push_back({{kInfiniteVertex, b, a}, {}});
  for (const Edge side : {0, 1, 2}) {
    const Edge outside = 4 * (side + 1);
    join(side, outside);
    join(outside + 1, 4 * (previous(side) + 1) + 2);
  }
  collinear_.clear();
  for (std::int32_t vertex = 2; vertex < apex_vertex; ++vertex) {
    const std::int32_t triangle = locate(at(vertex), 0);
    split_triangle(triangle, vertex);
    legalize_star(triangle);
  }
}

// Visibility walk: crosses any edge that has the point on its far side. It terminates in a Delaunay
// triangulation. Each step reduces the point's power with respect to the triangle's circumcircle,
// or keeps it among cocircular triangles, whose dual graph is a tree.
// @return the triangle that contains the point, perhaps on its edge or corner. Outside the hull,
// this is a triangle whose edge of the hull has the point strictly in front.
std::int32_t DelaunayTriangulation::locate(GridPoint point, std::int32_t hint) const {
  Edge entry = 4 * hint;
  for (int corner = 0; corner < 3; ++corner) {
    if (apex(4 * hint + corner) == kInfiniteVertex) entry = twin(4 * hint + corner);
  }
  const auto beyond = [&](Edge edge) {
    return orientation(at(apex(next(edge))), at(apex(previous(edge))), point) < 0;
  };
  if (beyond(entry)) entry = twin(entry);
  while (apex(entry) != kInfiniteVertex) {
    if (beyond(next(entry))) {
      entry = twin(next(entry));
    } else if (beyond(previous(entry))) {
      entry = twin(previous(entry));
    } else {
      break;
    }
  }
  return entry >> 2;
}

// Replaces a triangle by three. A vertex on an edge makes one of them flat until that edge is
// flipped: the vertex lies inside the circle beyond it.
void DelaunayTriangulation::split_triangle(std::int32_t triangle, std::int32_t vertex) {
  const auto [a, b, c] = triangles_[triangle].vertex;
  const std::array outside = triangles_[triangle].twin;
  const auto count = static_cast<std::int32_t>(triangles_.size());
  triangles_.resize(triangles_.size() + 2);
  const std::array part{triangle, count, count + 1};
  triangles_[part[0]] = {{vertex, b, c}, {outside[0], 4 * part[1] + 2, 4 * part[2] + 1}};
  triangles_[part[1]] = {{vertex, c, a}, {outside[1], 4 * part[2] + 2, 4 * part[0] + 1}};
  triangles_[part[2]] = {{vertex, a, b}, {outside[2], 4 * part[0] + 2, 4 * part[1] + 1}};
  for (int corner = 0; corner < 3; ++corner) twin(outside[corner]) = 4 * part[corner];
}

// Whether the vertex before the edge lies strictly inside the circumcircle of the triangle beyond.
// The circle of a triangle outside is the open half-plane in front of its edge of the hull, plus
// that edge. If the vertex before the edge is infinite, the two triangles change sides.
bool DelaunayTriangulation::must_flip(Edge edge) const {
  const std::int32_t p = apex(edge), a = apex(next(edge)), b = apex(previous(edge));
  const std::int32_t q = apex(twin(edge));
  if ((p | a | b | q) >= 0) return in_circle(at(q), at(b), at(a), at(p));
  if (q == kInfiniteVertex) return orientation(at(p), at(a), at(b)) == 0;
  if (p == kInfiniteVertex) return orientation(at(q), at(b), at(a)) == 0;
  return orientation(at(q), at(b == kInfiniteVertex ? p : b), at(a == kInfiniteVertex ? p : a)) > 0;
}

// Triangles (p, a, b), (q, b, a) -> (p, a, q), (q, b, p). p and q keep their corners: `edge`
// becomes (a, q), still opposite p.
void DelaunayTriangulation::flip(Edge edge) {
  const Edge beyond = twin(edge);
  const Edge edge_bp = twin(next(edge)), edge_aq = twin(next(beyond));
  apex(previous(edge)) = apex(beyond);
  apex(previous(beyond)) = apex(edge);
  join(edge, edge_aq);
  join(beyond, edge_bp);
  join(next(edge), next(beyond));
}

// Restores the Delaunay property around the new vertex at corner 0 of `triangle` (Lawson). Only
// edges opposite the vertex can be illegal. One turn around it visits them all, including the edges
// that flips make opposite to it.
void DelaunayTriangulation::legalize_star(std::int32_t triangle) {
  Edge edge = 4 * triangle;
  const std::int32_t first = apex(next(edge));
  do {
    while (must_flip(edge)) flip(edge);
    edge = next(twin(next(edge)));
  } while (apex(next(edge)) != first);
}

}  // namespace fovea
