// Insertion of many points at once, each into a triangle of its own.
#include <array>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "fovea/mapping/delaunay.h"

namespace fovea {
namespace {

// The corner of a triangle after each, counter-clockwise, and the one before.
constexpr std::array kAfter{1, 2, 0}, kBefore{2, 0, 1};

// What concerns the three corners of a triangle, side by side; the fourth lane is idle.
using Corners = double __attribute__((vector_size(32)));
using Integers = std::int32_t __attribute__((vector_size(16)));
using Mask = std::int64_t __attribute__((vector_size(32)));  // -1 where true

// These are inlined by force: otherwise the points go through memory, which takes a third more
// time.
[[gnu::always_inline]] inline unsigned bits(const Mask& mask) {
  return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4));
}

// A point for each corner, relative to the vertex at which the triangle is split.
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

// The sign of the in-circle determinant as far as floating point can tell (in_circle()): positive
// if the vertex lies strictly inside the circle through a, b, c (counter-clockwise), and if it lies
// outside of it and they are clockwise.
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
    throw std::invalid_argument("Delaunay triangulation: as many triangles as points are needed");
  }
  check_arguments(points, triangles);
  std::vector<std::uint32_t> point_of, to_locate;
  point_of.reserve(points.size());
  points_.reserve(points_.size() + points.size());
  std::vector<Fan> fans(triangles_.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::int32_t triangle = triangles[i];
    if (triangle != kNoTriangle && !fans[triangle].is_split() &&
        strictly_inside(points[i], triangle)) {
      fans[triangle].vertex = add_vertex(points[i]);
      point_of.push_back(i);
    } else {
      to_locate.push_back(i);
    }
  }
  split_all(fans);
  legalize_suspects();
  for (const std::uint32_t i : to_locate) {
    const std::int32_t hint = triangles[i] == kNoTriangle ? kNoTriangle : fans[triangles[i]].first;
    if (insert_checked(points[i], hint).inserted) point_of.push_back(i);
  }
  return point_of;
}

// Splits all triangles that have a vertex. The three parts of one take its place in memory, those
// behind it move up: what was near stays near.
void DelaunayTriangulation::split_all(std::span<Fan> fans) {
  std::int32_t count = 0;
  for (Fan& fan : fans) {
    fan.first = count;
    count += fan.is_split() ? 3 : 1;
  }
  std::swap(triangles_, unsplit_);
  triangles_.clear();
  triangles_.reserve(static_cast<std::size_t>(count));
  for (std::size_t t = 0; t < fans.size(); ++t) {
    const Triangle& whole = unsplit_[t];
    std::array<Edge, 3> outside;
    for (int k = 0; k < 3; ++k) outside[k] = fans[whole.twin[k] >> 2].edge(whole.twin[k] & 3);
    if (fans[t].is_split()) {
      put_fan(whole, outside, fans[t], fans);
    } else {
      triangles_.push_back({whole.vertex, outside});
    }
  }
}

// Writes the three parts of a triangle (Fan) with those flips already done that depend on nothing
// else: of edges between it and another one that is split, too. (Each of the two parts beside such
// an edge has no other.) Where every triangle is split at its centroid most of them are flipped,
// and few others: it is known here which, and they become suspects.
//
// Part k of the fan of p is (p, a, b), (a, b) the edge opposite corner k. If that is flipped, the
// part beyond, (q, b, a), becomes (q, b, p), and this one (p, a, q). Edge (p, a) is number 2 of
// part k either way; edge (b, p) is number 1 of it, or number 0 of the part beyond.
void DelaunayTriangulation::put_fan(const Triangle& whole, const std::array<Edge, 3>& outside,
                                    const Fan& fan, std::span<const Fan> fans) {
  std::array<std::int32_t, 3> beyond;  // the vertex q of each edge
  unsigned fan_beyond = 0;
  for (int k = 0; k < 3; ++k) {
    const Fan& other = fans[whole.twin[k] >> 2];
    if (other.is_split()) fan_beyond |= 1u << k;
    beyond[k] =
        other.is_split() ? other.vertex : unsplit_[whole.twin[k] >> 2].vertex[whole.twin[k] & 3];
    // An edge of the hull stays, as if the triangle's own third corner lay beyond it.
    if (beyond[k] == kInfiniteVertex) beyond[k] = whole.vertex[k];
  }
  const GridPoint p = at(fan.vertex);
  const auto points = [&](const std::array<std::int32_t, 3>& vertex) {
    return relative(at(vertex[0]), at(vertex[1]), at(vertex[2]), p);
  };
  const Points corner = points(whole.vertex), a = corner.after(), b = corner.before();
  const Points q = points(beyond);
  const Sign outer = in_circle_sign(q, b, a);
  unsigned flips = outer.positive & fan_beyond;
  for (int k = 0; k < 3; ++k) {
    const unsigned bit = 1u << k;
    if ((fan_beyond & ~(outer.positive | outer.negative) & bit) != 0 &&
        in_circle(at(beyond[k]), at(whole.vertex[kBefore[k]]), at(whole.vertex[kAfter[k]]), p)) {
      flips |= bit;
    }
  }
  // Edge (p, a), seen from part k and from the part before it.
  const unsigned flips_before = (flips << 1 | flips >> 2) & 7;
  const Points x = either(flips, q, b), y = either(flips_before, q.before(), corner);
  const Sign inner = in_circle_sign(x, a, y);

  for (int k = 0; k < 3; ++k) {
    const int after = kAfter[k], before = kBefore[k];
    const std::int32_t va = whole.vertex[after], vb = whole.vertex[before];
    const Edge beside_a = flips_before & 1u << k ? outside[before] : 4 * (fan.first + before) + 1;
    if (flips & 1u << k) {
      const Edge twin = whole.twin[k];
      triangles_.push_back(
          {{fan.vertex, va, beyond[k]},
           {4 * (fans[twin >> 2].first + kAfter[twin & 3]) + 2, outside[k] + 1, beside_a}});
    } else {
      triangles_.push_back(
          {{fan.vertex, va, vb}, {outside[k], 4 * (fan.first + after) + 2, beside_a}});
    }
  }
  for (int k = 0; k < 3; ++k) {
    const Edge edge = 4 * (fan.first + k);
    if (~outer.negative & ~fan_beyond & 1u << k) suspects_.push_back(edge);
    if (~inner.negative & 1u << k) suspects_.push_back(edge + 2);
  }
}

}  // namespace fovea
