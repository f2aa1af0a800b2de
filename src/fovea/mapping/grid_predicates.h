// Points on a fixed-point grid and the two predicates of a Delaunay triangulation, both exact.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

namespace fovea {

/// A point of the plane on an integer grid. The predicates below are exact while both coordinates
/// lie within [-kMaxGridCoordinate, kMaxGridCoordinate].
struct GridPoint {
  std::int32_t x = 0, y = 0;
  friend auto operator<=>(const GridPoint&, const GridPoint&) = default;
};

/// 2^29. Differences have at most 30 bits, sums of two products 61 bits, and the in-circle
/// determinant 124 bits: all fit their integer types.
inline constexpr std::int32_t kMaxGridCoordinate = 1 << 29;

inline bool on_grid(GridPoint p) {
  return p.x >= -kMaxGridCoordinate && p.x <= kMaxGridCoordinate && p.y >= -kMaxGridCoordinate &&
         p.y <= kMaxGridCoordinate;
}

/// Twice the signed area of the triangle (a, b, c): positive if counter-clockwise (x right, y up),
/// zero if collinear.
inline std::int64_t orientation(GridPoint a, GridPoint b, GridPoint c) {
  const std::int64_t abx = b.x - a.x, aby = b.y - a.y, acx = c.x - a.x, acy = c.y - a.y;
  return abx * acy - aby * acx;
}

/// Whether p lies strictly inside the circle through a, b, c (counter-clockwise), in integers only.
inline bool in_circle_exact(GridPoint a, GridPoint b, GridPoint c, GridPoint p) {
  __extension__ using Int128 = __int128;
  const std::int64_t ax = a.x - p.x, ay = a.y - p.y;
  const std::int64_t bx = b.x - p.x, by = b.y - p.y;
  const std::int64_t cx = c.x - p.x, cy = c.y - p.y;
  return Int128{ax * ax + ay * ay} * (bx * cy - by * cx) +
             Int128{bx * bx + by * by} * (cx * ay - cy * ax) +
             Int128{cx * cx + cy * cy} * (ax * by - ay * bx) >
         0;
}

/// Whether p lies strictly inside the circle through a, b, c (counter-clockwise). Exact: integers
/// decide the nearly cocircular cases that the floating-point filter leaves open.
inline bool in_circle(GridPoint a, GridPoint b, GridPoint c, GridPoint p) {
  const double ax = a.x - p.x, ay = a.y - p.y;
  const double bx = b.x - p.x, by = b.y - p.y;
  const double cx = c.x - p.x, cy = c.y - p.y;
  const double aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
  const double determinant =
      aa * (bx * cy - by * cx) + bb * (cx * ay - cy * ax) + cc * (ax * by - ay * bx);
  // The error is at most 10 u (u = 2^-53) times the same sum with absolute values (Shewchuk 1997,
  // incircle bound A). Since |bx cy| + |by cx| <= |b| |c| <= (bb + cc) / 2, and so on, the sum
  // below is larger. 16 u cover its own rounding.
  const double bound = 0x1.0p-49 * (aa * bb + bb * cc + cc * aa);
  if (std::abs(determinant) > bound) return determinant > 0;
  return in_circle_exact(a, b, c, p);
}

}  // namespace fovea
