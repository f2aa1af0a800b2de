// Insertion of many points at once, each into its own triangle.
#include <array>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "fovea/mapping/delaunay.h"

namespace fovea {
namespace {

// The next corner of a triangle, counter-clockwise, and the previous one.
constexpr std::array kAfter{1, 2, 0}, kBefore{2, 0, 1};

// Values at the three corners of a triangle; the fourth lane is idle.
using Corners = double __attribute__((vector_size(32)));
using Integers = std::int32_t __attribute__((vector_size(16)));
using Mask = std::int64_t __attribute__((vector_size(32)));  // -1 where true

// Forced inlining keeps the points in registers; without it the split takes a third more time.
[[gnu::always_inline]] inline unsigned bits(const Mask& mask) {
  return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4));
}

// A point for each corner, relative to the vertex that splits the triangle.
struct Points {
  Corners x, y, square;

  Points after() const { return lanes<1, 2, 0, 3>(); }
  Points before() const { return lanes<2, 0, 1, 3>(); }

 private:
  template <int... kLanes>
  Points lanes() const {
    return {__builtin_shufflevector(x, x, kLanes...), __builtin_shufflevector(y, y, kLanes...),
            __builtin_shufflevector(square, square, kLanes...)};
  }
};

[[gnu::always_inline]] inline Points relative(GridPoint a, GridPoint b, GridPoint c,
                                              GridPoint vertex) {
  const Integers x = Integers{a.x, b.x, c.x, 0} - vertex.x;
  const Integers y = Integers{a.y, b.y, c.y, 0} - vertex.y;
  const auto dx = __builtin_convertvector(x, Corners), dy = __builtin_convertvector(y, Corners);
  return {dx, dy, dx * dx + dy * dy};
}

// The points of `a` at the corners whose bit is set, and those of `b` at the others.
[[gnu::always_inline]] inline Points either(unsigned bits, const Points& a, const Points& b) {
  const Mask of_a = (Mask{1, 2, 4, 0} & static_cast<std::int64_t>(bits)) != 0;
  return {of_a ? a.x : b.x, of_a ? a.y : b.y, of_a ? a.square : b.square};
}

// The certain sign of the in-circle determinant in floating point; neither bit is set if uncertain
// (in_circle()). Positive: the vertex lies strictly inside the circle through a, b, c
// (counter-clockwise), or outside of it if they are clockwise.
struct Sign {
  unsigned positive, negative;
};
[[gnu::always_inline]] inline Sign in_circle_sign(const Points& a, const Points& b,
                                                  const Points& c) {
  const InCircleDeterminant<Corners> determinant(a.x, a.y, a.square, b.x, b.y, b.square, c.x, c.y,
                                                 c.square);
  return {bits(determinant.value > determinant.bound),
          bits(determinant.value < -determinant.bound)};
}

}  // namespace

std::vector<std::uint32_t> DelaunayTriangulation::insert(std::span<const GridPoint> points,
                                                         std::span<const std::int32_t> triangles) {
  if (points.size() != triangles.size()) {
    throw std::invalid_argument("Delaunay triangulation: each point needs a triangle");
  }
  check_arguments(points, triangles);
  std::vector<std::uint32_t> point_of, to_locate;
  point_of.reserve(points.size());
  points_.reserve(points_.size() + points.size());
  std::vector<TriangleSplit> splits(triangles_.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::int32_t triangle = triangles[i];
    if (triangle != kNoTriangle && !splits[triangle].is_split() &&
        strictly_inside(points[i], triangle)) {
      splits[triangle].vertex = add_vertex(points[i]);
      point_of.push_back(i);
    } else {
      to_locate.push_back(i);
    }
  }
  split_all(splits);
  legalize_edges();
  for (const std::uint32_t i : to_locate) {
    const std::int32_t hint =
        triangles[i] == kNoTriangle ? kNoTriangle : splits[triangles[i]].first;
    if (insert_checked(points[i], hint).inserted) point_of.push_back(i);
  }
  return point_of;
}

// Splits all triangles that have a vertex. The three parts replace the triangle in memory and the
// later triangles move up, so that near triangles stay near.
void DelaunayTriangulation::split_all(std::span<TriangleSplit> splits) {
  std::int32_t count = 0;
  for (TriangleSplit& split : splits) {
    split.first = count;
    count += split.is_split() ? 3 : 1;
  }
  std::swap(triangles_, whole_triangles_);
  triangles_.clear();
  triangles_.reserve(static_cast<std::size_t>(count));
  for (std::size_t t = 0; t < splits.size(); ++t) {
    const Triangle& whole = whole_triangles_[t];
    std::array<Edge, 3> outside;
    for (int k = 0; k < 3; ++k) outside[k] = splits[whole.twin[k] >> 2].edge(whole.twin[k] & 3);
    if (splits[t].is_split()) {
      write_parts(whole, outside, splits[t], splits);
    } else {
      triangles_.push_back({whole.vertex, outside});
    }
  }
}

// Writes the three parts of a triangle, with the flips done that are independent of each other: of
// the edges between two split triangles. If every triangle is split at its centroid, most of these
// edges flip, and few others. The edges that may still be illegal go to edges_to_legalize_.
//
// Part k of the split at p is (p, a, b), with (a, b) the edge opposite corner k. A flip of that
// edge turns the part into (p, a, q), and the part beyond, (q, b, a), into (q, b, p). Edge (p, a)
// is number 2 of part k either way. Edge (b, p) is number 1 of it, or number 0 of the part beyond.
void DelaunayTriangulation::write_parts(const Triangle& whole, const std::array<Edge, 3>& outside,
                                        const TriangleSplit& split,
                                        std::span<const TriangleSplit> splits) {
  std::array<std::int32_t, 3> beyond;  // the vertex q of each edge
  unsigned split_beyond = 0;
  for (int k = 0; k < 3; ++k) {
    const TriangleSplit& other = splits[whole.twin[k] >> 2];
    if (other.is_split()) split_beyond |= 1u << k;
    beyond[k] = other.is_split() ? other.vertex
                                 : whole_triangles_[whole.twin[k] >> 2].vertex[whole.twin[k] & 3];
    // An edge of the hull never flips: use the triangle's own third corner as the one beyond.
    if (beyond[k] == kInfiniteVertex) beyond[k] = whole.vertex[k];
  }
  const GridPoint p = at(split.vertex);
  const auto points = [&](const std::array<std::int32_t, 3>& vertex) {
    return relative(at(vertex[0]), at(vertex[1]), at(vertex[2]), p);
  };
  const Points corner = points(whole.vertex), a = corner.after(), b = corner.before();
  const Points q = points(beyond);
  const Sign outer = in_circle_sign(q, b, a);
  unsigned flips = outer.positive & split_beyond;
  for (int k = 0; k < 3; ++k) {
    const unsigned bit = 1u << k;
    if ((split_beyond & ~(outer.positive | outer.negative) & bit) != 0 &&
        in_circle(at(beyond[k]), at(whole.vertex[kBefore[k]]), at(whole.vertex[kAfter[k]]), p)) {
      flips |= bit;
    }
  }
  // Edge (p, a) in part k and in the part before it.
  const unsigned flips_before = (flips << 1 | flips >> 2) & 7;
  const Points x = either(flips, q, b), y = either(flips_before, q.before(), corner);
  const Sign inner = in_circle_sign(x, a, y);

  for (int k = 0; k < 3; ++k) {
    const int after = kAfter[k], before = kBefore[k];
    const std::int32_t va = whole.vertex[after], vb = whole.vertex[before];
    const Edge beside_a = flips_before & 1u << k ? outside[before] : 4 * (split.first + before) + 1;
    if (flips & 1u << k) {
      const Edge twin = whole.twin[k];
      triangles_.push_back(
          {{split.vertex, va, beyond[k]},
           {4 * (splits[twin >> 2].first + kAfter[twin & 3]) + 2, outside[k] + 1, beside_a}});
    } else {
      triangles_.push_back(
          {{split.vertex, va, vb}, {outside[k], 4 * (split.first + after) + 2, beside_a}});
    }
  }
  for (int k = 0; k < 3; ++k) {
    const Edge edge = 4 * (split.first + k);
    if (~outer.negative & ~split_beyond & 1u << k) edges_to_legalize_.push_back(edge);
    if (~inner.negative & 1u << k) edges_to_legalize_.push_back(edge + 2);
  }
}

}  // namespace fovea
