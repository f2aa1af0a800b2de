#include "fovea/exporting/mesh/surface_nets.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "fovea/exporting/gltf.h"
#include "fovea/geometry/voxel_members.h"
#include "fovea/map/point_files/point_stream.h"

namespace fovea {
namespace {

constexpr std::uint32_t kNone = VoxelTable::kNone;
/// From a vertex to the nearest surfel, and to those that colour it; cells.
constexpr float kNearest = 1.5f, kColorReach = 2;
/// Cosine between an edge along which the distance grows and the normal; of edges that lie in the
/// surface, either sign is chance.
constexpr float kAgainst = -0.3f;

/// Where an edge of the lattice crosses the surface.
struct Crossing {
  Eigen::Vector3i corner;  // the edge's lower end
  int axis;
  bool rises;  // whether the distance grows along the edge
  float at;    // along the edge, 0 to 1
  Eigen::Vector3f normal;
};

Eigen::Vector3i unit(int axis) { return Eigen::Vector3i::Unit(axis % 3); }

/// The four voxels around an edge, counter-clockwise seen from its upper end.
std::array<Eigen::Vector3i, 4> voxels_around(const Crossing& crossing) {
  const Eigen::Vector3i &c = crossing.corner, b = unit(crossing.axis + 1),
                        d = unit(crossing.axis + 2);
  return {c, c - b, c - b - d, c - d};
}

std::vector<Crossing> find_crossings(const ImplicitSurface& surface) {
  const VoxelTable& corners = surface.corners();
  std::vector<Crossing> crossings;
  for (std::uint32_t from = 0; from < corners.size(); ++from) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t to = corners.find(corners.voxel(from) + unit(axis));
      if (to == kNone) continue;
      for (const SurfaceSide& lower : surface.sides(from)) {
        for (const SurfaceSide& upper : surface.sides(to)) {
          if ((lower.distance < 0) == (upper.distance < 0)) continue;
          if (!(lower.normal.dot(upper.normal) > 0)) continue;  // sides of two surfaces
          const float at = lower.distance / (lower.distance - upper.distance);
          const Eigen::Vector3f normal = ((1 - at) * lower.normal + at * upper.normal).normalized();
          const bool rises = upper.distance > lower.distance;
          // Between two surfaces that face the same way the distance falls through zero once more.
          if ((rises ? normal[axis] : -normal[axis]) < kAgainst) continue;
          crossings.push_back({corners.voxel(from), axis, rises, at, normal});
        }
      }
    }
  }
  return crossings;
}

/// What the crossings of a voxel's edges say of one side of the surface in it.
struct Sheet {
  float count = 0;
  Eigen::Vector3f place = Eigen::Vector3f::Zero();  // voxels, from the voxel's lowest corner
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();

  void add(const Sheet& other) {
    count += other.count;
    place += other.place;
    normal += other.normal;
  }
};

/// The surfels around a vertex, on its side.
struct Around {
  float nearest = kNearest * kNearest;  // cells^2
  float weight = 0, distance = 0, color_weight = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero(), color = Eigen::Vector3f::Zero();
  bool found = false;
};

Around look_around(const Surfels& surfels, const Eigen::Vector3i& cell,
                   const Eigen::Vector3f& offset, const Eigen::Vector3f& side) {
  Around around;
  surfels.for_each_near(cell, offset, ImplicitSurface::kReach,
                        [&](const Surfel& surfel, const Eigen::Vector3f& p) {
                          if (!(surfel.normal.dot(side) > 0)) return;
                          const float squared = p.squaredNorm();
                          if (squared <= around.nearest) {
                            around.nearest = squared;
                            around.found = true;
                          }
                          const float weight = bump(squared, ImplicitSurface::kReach);
                          around.weight += weight;
                          around.distance -= weight * surfel.normal.dot(p);
                          around.normal += weight * surfel.normal;
                          if (!surfel.colored) return;
                          const float color_weight = bump(squared, kColorReach);
                          around.color_weight += color_weight;
                          around.color += color_weight * surfel.color;
                        });
  return around;
}

std::uint8_t faces_of(const Eigen::Vector3i& voxel) {
  int faces = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (voxel[axis] < 0) faces |= 1 << axis;
    if (voxel[axis] == kBlockVoxels - 1) faces |= 8 << axis;
  }
  return static_cast<std::uint8_t>(faces);
}

/// The vertex of a sheet; nothing where no points are.
std::optional<MeshVertex> vertex_of(const Sheet& sheet, const Eigen::Vector3i& voxel,
                                    const Surfels& surfels) {
  const Eigen::Vector3f side = sheet.normal.normalized();
  Eigen::Vector3f place = sheet.place / sheet.count;
  const auto around_place = [&] {
    const Eigen::Vector3f in_cells = kVoxelCells * place;
    const Eigen::Vector3f cell = in_cells.array().floor();
    return look_around(surfels, kVoxelCells * voxel + cell.cast<int>(), in_cells - cell, side);
  };
  const Around around = around_place();
  if (!around.found || !(around.normal.squaredNorm() > 0)) return std::nullopt;
  const Eigen::Vector3f normal = around.normal.normalized();
  place -= around.distance / around.weight / kVoxelCells * normal;
  place = place.cwiseMax(0.f).cwiseMin(1.f);  // a voxel's vertex lies in it

  MeshVertex vertex;
  vertex.place = kVoxelSteps * voxel.array() + (kVoxelSteps * place).array().round().cast<int>();
  vertex.normal = normal;
  vertex.colored = around.color_weight > 0;
  const Rgb color = vertex.colored ? to_rgb(around.color / around.color_weight) : kUncolored;
  vertex.light = {linear_light(color.r), linear_light(color.g), linear_light(color.b)};
  vertex.faces = faces_of(voxel);
  return vertex;
}

bool has_area(const std::vector<MeshVertex>& vertices, const std::array<std::uint32_t, 3>& t) {
  const auto edge = [&](std::size_t i) -> Eigen::Vector3d {
    return (vertices[t[i]].place - vertices[t[0]].place).matrix().cast<double>();
  };
  return edge(1).cross(edge(2)).squaredNorm() > 0;
}

class NetMaker {
 public:
  NetMaker(const Surfels& surfels, const ImplicitSurface& surface)
      : surfels_(surfels), crossings_(find_crossings(surface)) {}

  MeshPatch make() {
    sort_by_voxels();
    for (const Crossing& crossing : crossings_) {
      const Eigen::Vector3i& corner = crossing.corner;
      const bool own = (corner.array() >= 0).all() && (corner.array() < kBlockVoxels).all();
      if (own) put_quad(crossing);
    }
    return std::move(patch_);
  }

 private:
  /// Finds the vertices of the four voxels around each crossing.
  void sort_by_voxels() {
    VoxelTable voxels(1.f);
    std::vector<std::uint32_t> voxel_of_slot;
    voxel_of_slot.reserve(4 * crossings_.size());
    for (const Crossing& crossing : crossings_) {
      for (const Eigen::Vector3i& voxel : voxels_around(crossing)) {
        const bool inside = (voxel.array() >= -1).all() && (voxel.array() < kBlockVoxels).all();
        voxel_of_slot.push_back(inside ? voxels.insert(voxel) : kNone);
      }
    }
    vertex_of_slot_.assign(voxel_of_slot.size(), kNone);
    const VoxelMembers slots(voxel_of_slot, voxels.size());
    for (std::uint32_t i = 0; i < voxels.size(); ++i) make_vertices(voxels.voxel(i), slots.of(i));
    number_of_vertex_.assign(vertices_.size(), kNone);
  }

  /// @param slots  4 times a crossing's number, and which of the voxels around it this is
  void make_vertices(const Eigen::Vector3i& voxel, std::span<const std::uint32_t> slots) {
    const Eigen::Vector3f& first = crossings_[slots[0] / 4].normal;
    std::array<Sheet, 2> sheets;
    const auto sheet_of = [&](std::uint32_t slot) {
      return crossings_[slot / 4].normal.dot(first) < 0 ? std::size_t{1} : std::size_t{0};
    };
    for (const std::uint32_t slot : slots) {
      const Crossing& crossing = crossings_[slot / 4];
      const Eigen::Vector3f place =
          (crossing.corner - voxel).cast<float>() + crossing.at * unit(crossing.axis).cast<float>();
      sheets[sheet_of(slot)].add({1, place, crossing.normal});
    }
    auto& [front, back] = sheets;
    const bool apart =
        back.count > 0 && front.normal.dot(back.normal) <
                              ImplicitSurface::kOpposite * front.normal.norm() * back.normal.norm();
    if (!apart) front.add(back);
    std::array<std::uint32_t, 2> number{kNone, kNone};
    for (std::size_t i = 0; i < (apart ? 2u : 1u); ++i) {
      const auto vertex = vertex_of(sheets[i], voxel, surfels_);
      if (!vertex) continue;
      number[i] = static_cast<std::uint32_t>(vertices_.size());
      vertices_.push_back(*vertex);
    }
    for (const std::uint32_t slot : slots)
      vertex_of_slot_[slot] = number[apart ? sheet_of(slot) : 0];
  }

  void put_quad(const Crossing& crossing) {
    const auto first = static_cast<std::size_t>(4 * (&crossing - crossings_.data()));
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < 4; ++i) {
      if (vertex_of_slot_[first + i] != kNone) corners.push_back(vertex_of_slot_[first + i]);
    }
    if (corners.size() < 3) return;
    if (!crossing.rises) std::reverse(corners.begin(), corners.end());
    if (corners.size() == 3) return put_triangle({corners[0], corners[1], corners[2]});
    const auto length = [&](std::size_t a, std::size_t b) {
      return (vertices_[corners[a]].place - vertices_[corners[b]].place).matrix().squaredNorm();
    };
    if (length(1, 3) < length(0, 2))
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    put_triangle({corners[0], corners[1], corners[2]});
    put_triangle({corners[0], corners[2], corners[3]});
  }

  void put_triangle(std::array<std::uint32_t, 3> corners) {
    if (!has_area(vertices_, corners)) return;
    for (std::uint32_t& corner : corners) {
      std::uint32_t& number = number_of_vertex_[corner];
      if (number == kNone) {
        number = static_cast<std::uint32_t>(patch_.vertices.size());
        patch_.vertices.push_back(vertices_[corner]);
      }
      corner = number;
    }
    patch_.triangles.push_back(corners);
  }

  const Surfels& surfels_;
  std::vector<Crossing> crossings_;
  std::vector<std::uint32_t> vertex_of_slot_;
  std::vector<MeshVertex> vertices_;             // also such that no triangle uses
  std::vector<std::uint32_t> number_of_vertex_;  // in the patch
  MeshPatch patch_;
};

}  // namespace

MeshPatch surface_nets(const Surfels& surfels, const ImplicitSurface& surface) {
  return NetMaker(surfels, surface).make();
}

}  // namespace fovea
