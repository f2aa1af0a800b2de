#include "fovea/mapping/delaunay.h"

#include <algorithm>
#include <stdexcept>

#include "fovea/mapping/insertion_order.h"

namespace fovea {

void DelaunayTriangulation::clear() {
  points_.clear();
  triangles_.clear();
  suspects_.clear();
  collinear_.clear();
}

DelaunayTriangulation::Insertion DelaunayTriangulation::insert(GridPoint point, std::int32_t hint) {
  check_arguments({&point, 1}, {&hint, 1});
  if (triangles_.empty()) return insert_while_collinear(point);

  const std::int32_t triangle = locate(point, hint == kNoTriangle ? 0 : hint);
  for (const std::int32_t vertex : vertices(triangle)) {
    if (vertex != kInfiniteVertex && at(vertex) == point) return {vertex, false, triangle};
  }
  const std::int32_t vertex = add_vertex(point);
  split(triangle, vertex);
  legalize_star(triangle);
  return {vertex, true, triangle};
}

std::vector<std::int32_t> DelaunayTriangulation::insert(std::span<const GridPoint> points) {
  check_arguments(points, {});
  reserve(points.size());
  std::vector<std::int32_t> vertex_of(points.size());
  std::int32_t hint = kNoTriangle;
  for (const std::uint32_t i : insertion_order(points)) {
    const Insertion insertion = insert(points[i], hint);
    vertex_of[i] = insertion.vertex;
    hint = insertion.triangle;
  }
  order_triangles();
  return vertex_of;
}

std::vector<std::uint32_t> DelaunayTriangulation::insert(std::span<const GridPoint> points,
                                                         std::span<const std::int32_t> triangles) {
  if (points.size() != triangles.size()) {
    throw std::invalid_argument("Delaunay triangulation: as many triangles as points are needed");
  }
  check_arguments(points, triangles);
  reserve(points.size());
  std::vector<std::uint32_t> point_of, to_locate;
  point_of.reserve(points.size());
  std::vector<std::int32_t> vertex_in(triangles_.size(), kInfiniteVertex);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::int32_t triangle = triangles[i];
    if (triangle != kNoTriangle && vertex_in[triangle] == kInfiniteVertex &&
        strictly_inside(points[i], triangle)) {
      vertex_in[triangle] = add_vertex(points[i]);
      point_of.push_back(i);
    } else {
      to_locate.push_back(i);
    }
  }
  const std::vector<std::int32_t> moved_to = split_all(vertex_in);
  legalize_after_split(vertex_in, moved_to);
  for (const std::uint32_t i : to_locate) {
    const std::int32_t hint = triangles[i] == kNoTriangle ? kNoTriangle : moved_to[triangles[i]];
    if (insert(points[i], hint).inserted) point_of.push_back(i);
  }
  return point_of;
}

// Splits each triangle that has a vertex in `vertex_in`. The three new triangles take its place in
// memory, those behind it move up: what was near stays near.
// @return where each triangle is now (the first of the three)
std::vector<std::int32_t> DelaunayTriangulation::split_all(
    std::span<const std::int32_t> vertex_in) {
  std::vector<std::int32_t> moved_to(triangles_.size());
  std::int32_t count = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    moved_to[t] = count;
    count += vertex_in[t] == kInfiniteVertex ? 1 : 3;
  }
  const auto moved = [&](Edge edge) {
    const std::int32_t triangle = edge >> 2, corner = edge & 3;
    return vertex_in[triangle] == kInfiniteVertex ? 4 * moved_to[triangle] + corner
                                                  : 4 * (moved_to[triangle] + corner);
  };
  std::size_t t = triangles_.size();
  triangles_.resize(static_cast<std::size_t>(count));
  while (t-- > 0) {  // from the last to the first, so that none is overwritten before it has moved
    const auto [a, b, c, _v] = triangles_[t].vertex;
    const auto [edge_a, edge_b, edge_c, _e] = triangles_[t].twin;
    const std::int32_t to = moved_to[t], v = vertex_in[t];
    if (v == kInfiniteVertex) {
      triangles_[to] = {{a, b, c}, {moved(edge_a), moved(edge_b), moved(edge_c)}};
    } else {
      triangles_[to] = {{v, b, c}, {moved(edge_a), 4 * (to + 1) + 2, 4 * (to + 2) + 1}};
      triangles_[to + 1] = {{v, c, a}, {moved(edge_b), 4 * (to + 2) + 2, 4 * to + 1}};
      triangles_[to + 2] = {{v, a, b}, {moved(edge_c), 4 * to + 2, 4 * (to + 1) + 1}};
    }
  }
  return moved_to;
}

void DelaunayTriangulation::legalize_after_split(std::span<const std::int32_t> vertex_in,
                                                 std::span<const std::int32_t> moved_to) {
  for (std::size_t t = 0; t < vertex_in.size(); ++t) {
    if (vertex_in[t] == kInfiniteVertex) continue;
    const Edge edge = 4 * moved_to[t];
    suspects_.insert(suspects_.end(), {edge, edge + 4, edge + 8});
    legalize_suspects();
  }
}

// Renumbers the triangles breadth first, so that neighbours are near each other in memory.
void DelaunayTriangulation::order_triangles() {
  if (triangles_.empty()) return;
  std::vector<std::int32_t> order{0}, moved_to(triangles_.size(), kNoTriangle);
  order.reserve(triangles_.size());
  moved_to[0] = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::int32_t neighbor = triangles_[order[i]].twin[corner] >> 2;
      if (moved_to[neighbor] != kNoTriangle) continue;
      moved_to[neighbor] = static_cast<std::int32_t>(order.size());
      order.push_back(neighbor);
    }
  }
  std::vector<Triangle> ordered;
  ordered.reserve(triangles_.capacity());
  for (const std::int32_t t : order) {
    ordered.push_back(triangles_[t]);
    for (Edge& edge : ordered.back().twin) edge = 4 * moved_to[edge >> 2] + (edge & 3);
  }
  triangles_.swap(ordered);
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

void DelaunayTriangulation::reserve(std::size_t more_points) {
  points_.reserve(points_.size() + more_points);
  triangles_.reserve(2 * (points_.size() + more_points));
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

// The first triangle and the three outside of its edges; then the vertices that had to wait.
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
    split(triangle, vertex);
    legalize_star(triangle);
  }
}

// Visibility walk: on through any edge that has the point on its far side. In a Delaunay
// triangulation it cannot run in circles: with each step the point's power with respect to the
// triangle's circumcircle falls, or stays while the walk crosses a set of cocircular triangles,
// whose dual graph is a tree.
// @return the triangle that holds the point, maybe on an edge or a corner; or, of those outside,
// one whose edge of the hull has the point strictly in front
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

bool DelaunayTriangulation::strictly_inside(GridPoint point, std::int32_t triangle) const {
  if (!is_finite(static_cast<std::size_t>(triangle))) return false;
  const auto [a, b, c] = vertices(static_cast<std::size_t>(triangle));
  return orientation(at(a), at(b), point) > 0 && orientation(at(b), at(c), point) > 0 &&
         orientation(at(c), at(a), point) > 0;
}

// Three triangles for one, the new vertex in front. A vertex on an edge makes one of them flat for
// a moment: the edge is then flipped, for the vertex lies inside the circle beyond it.
void DelaunayTriangulation::split(std::int32_t triangle, std::int32_t vertex) {
  const auto [a, b, c, _v] = triangles_[triangle].vertex;
  const auto [edge_a, edge_b, edge_c, _e] = triangles_[triangle].twin;
  const auto t_b = static_cast<std::int32_t>(triangles_.size()), t_c = t_b + 1;
  triangles_[triangle] = {{vertex, b, c}, {edge_a, 4 * t_b + 2, 4 * t_c + 1}};
  triangles_.push_back({{vertex, c, a}, {edge_b, 4 * t_c + 2, 4 * triangle + 1}});
  triangles_.push_back({{vertex, a, b}, {edge_c, 4 * triangle + 2, 4 * t_b + 1}});
  twin(edge_a) = 4 * triangle;
  twin(edge_b) = 4 * t_b;
  twin(edge_c) = 4 * t_c;
}

// Whether the (finite) vertex before the edge lies strictly inside the circumcircle of the triangle
// beyond it. The circle of a triangle outside is the open half-plane in front of its edge of the
// hull, with that edge.
bool DelaunayTriangulation::must_flip(Edge edge) const {
  const std::int32_t p = apex(edge), a = apex(next(edge)), b = apex(previous(edge));
  const std::int32_t q = apex(twin(edge));
  if ((a | b | q) >= 0) return in_circle(at(q), at(b), at(a), at(p));
  if (q == kInfiniteVertex) return orientation(at(p), at(a), at(b)) == 0;
  return orientation(at(q), at(b == kInfiniteVertex ? p : b), at(a == kInfiniteVertex ? p : a)) > 0;
}

// Triangles (p, a, b), (q, b, a) -> (p, a, q), (q, b, p); p and q keep their corners, so that
// `edge` is then (a, q), still opposite p.
void DelaunayTriangulation::flip(Edge edge) {
  const Edge beyond = twin(edge);
  const Edge edge_bp = twin(next(edge)), edge_aq = twin(next(beyond));
  apex(previous(edge)) = apex(beyond);
  apex(previous(beyond)) = apex(edge);
  join(edge, edge_aq);
  join(beyond, edge_bp);
  join(next(edge), next(beyond));
}

// Makes Delaunay again what inserting the vertex in front of `triangle` has disturbed (Lawson).
// Only edges opposite the vertex can be illegal; they are met in one turn around it, each edge that
// a flip brings into sight included.
void DelaunayTriangulation::legalize_star(std::int32_t triangle) {
  Edge edge = 4 * triangle;
  const std::int32_t first = apex(next(edge));
  do {
    while (must_flip(edge)) flip(edge);
    edge = next(twin(next(edge)));
  } while (apex(next(edge)) != first);
}

// Lawson's algorithm from any edges: after a flip all four edges around it are suspects anew. A
// suspect whose edge number has come to mean another edge needs no care: flips that rename edges
// make suspects of them.
void DelaunayTriangulation::legalize_suspects() {
  while (!suspects_.empty()) {
    const Edge edge = suspects_.back();
    suspects_.pop_back();
    if (!must_flip(edge)) continue;
    const Edge beyond = twin(edge);
    flip(edge);
    for (const Edge e : {edge, previous(edge), beyond, previous(beyond)}) suspects_.push_back(e);
  }
}

}  // namespace fovea
