#include "fovea/exporting/mesh/mesh_gltf.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "fovea/map/point_files/byte_packer.h"

namespace fovea {
namespace {

/// Quantised places begin before the block: vertices lie up to a voxel beyond it, their skirts two.
constexpr int kVoxelsBefore = 4;
static_assert((2 * kVoxelsBefore + 128) * kVoxelSteps <= std::numeric_limits<std::uint16_t>::max());

constexpr GltfColumn kColor{GltfType::kUnsignedShort, true, "VEC4", 8};

/// z up to y up.
Eigen::Vector3f y_up(const Eigen::Vector3f& v) { return {v.x(), v.z(), -v.y()}; }

template <class Number>
std::string bounds(const Eigen::Array<Number, 3, 1>& low, const Eigen::Array<Number, 3, 1>& high) {
  return fmt::format(R"(,"min":[{},{},{}],"max":[{},{},{}])", low.x(), low.y(), low.z(), high.x(),
                     high.y(), high.z());
}

}  // namespace

/// The columns of one block's vertices but for colours.
struct MeshGltf::Columns {
  GltfColumn position_column, normal_column;
  std::string bounds, bytes, node;
};

MeshGltf::Columns MeshGltf::columns(const MeshPatch& patch, const Eigen::Vector3d& corner,
                                    double voxel) const {
  Columns columns;
  BytePacker packer(columns.bytes);
  if (coding_ == MeshCoding::kQuantised) {
    columns.position_column = {GltfType::kUnsignedShort, false, "VEC3", 8};
    columns.normal_column = {GltfType::kByte, true, "VEC3", 4};
    Eigen::Array3i low = Eigen::Array3i::Constant(std::numeric_limits<int>::max()), high = -low;
    for (const MeshVertex& vertex : patch.vertices) {
      const Eigen::Array3i place = vertex.place + kVoxelsBefore * kVoxelSteps;
      low = low.min(place);
      high = high.max(place);
      for (const int coordinate : place) packer.put(static_cast<std::uint16_t>(coordinate));
      packer.put_zeros(2);
    }
    for (const MeshVertex& vertex : patch.vertices) {
      for (const float axis : vertex.normal) {
        packer.put(static_cast<std::int8_t>(std::lround(127 * axis)));
      }
      packer.put_zeros(1);
    }
    columns.bounds = bounds<int>(low, high);
    const Eigen::Vector3d before = Eigen::Vector3d::Constant(kVoxelsBefore * voxel);
    columns.node = fmt::format(R"("matrix":{})", gltf_matrix(voxel / kVoxelSteps, corner - before));
    return columns;
  }
  columns.position_column = columns.normal_column = {GltfType::kFloat, false, "VEC3", 12};
  Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::max()), high = -low;
  for (const MeshVertex& vertex : patch.vertices) {
    const Eigen::Vector3f position = y_up((voxel * place_of(vertex)).cast<float>());
    low = low.min(position.array());
    high = high.max(position.array());
    for (const float axis : position) packer.put(axis);
  }
  for (const MeshVertex& vertex : patch.vertices) {
    for (const float axis : y_up(vertex.normal)) packer.put(axis);
  }
  columns.bounds = bounds<double>(low.cast<double>(), high.cast<double>());  // just the floats
  columns.node = fmt::format(R"("translation":[{},{},{}])", corner.x(), corner.z(), -corner.y());
  return columns;
}

std::string MeshGltf::add(const MeshPatch& patch, const Eigen::Vector3d& corner, double voxel) {
  Columns columns = this->columns(patch, corner, voxel);
  const std::size_t n = patch.vertices.size(), indices = 3 * patch.triangles.size();
  const bool is_short = n <= std::numeric_limits<std::uint16_t>::max();  // 65535 ends strips
  const std::size_t position = buffer_.add(columns.position_column, n, columns.bounds),
                    normal = buffer_.add(columns.normal_column, n), color = buffer_.add(kColor, n);
  const std::size_t index =
      buffer_.add({is_short ? GltfType::kUnsignedShort : GltfType::kUnsignedInt, false, "SCALAR",
                   is_short ? sizeof(std::uint16_t) : sizeof(std::uint32_t), /*indices=*/true},
                  indices);

  BytePacker packer(columns.bytes);
  for (const MeshVertex& vertex : patch.vertices) {
    for (const std::uint16_t channel : vertex.light) packer.put(channel);
    packer.put(std::uint16_t{65535});
  }
  for (const auto& triangle : patch.triangles) {
    for (const std::uint32_t corner_of : triangle) {
      is_short ? packer.put(static_cast<std::uint16_t>(corner_of)) : packer.put(corner_of);
    }
  }
  packer.put_zeros((4 - columns.bytes.size() % 4) % 4);

  const char* comma = count_ == 0 ? "" : ",";
  nodes_ += fmt::format(R"({}{{"mesh":{},{}}})", comma, count_, columns.node);
  node_numbers_ += fmt::format("{}{}", comma, count_);
  meshes_ += fmt::format(
      R"({}{{"primitives":[{{"attributes":{{"POSITION":{},"NORMAL":{},"COLOR_0":{}}},"indices":{},"material":0}}]}})",
      comma, position, normal, color, index);
  ++count_;
  return std::move(columns.bytes);
}

std::string MeshGltf::head() const {
  if (count_ == 0) return empty_glb();
  const char* extensions =
      coding_ == MeshCoding::kQuantised
          ? R"("extensionsUsed":["KHR_mesh_quantization","KHR_materials_unlit"],"extensionsRequired":["KHR_mesh_quantization"],)"
          : R"("extensionsUsed":["KHR_materials_unlit"],)";
  return glb_head(
      gltf_begin() + extensions +
          fmt::format(
              R"("scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],"meshes":[{}],)"
              R"("materials":[{{"pbrMetallicRoughness":{{"metallicFactor":0,"roughnessFactor":1}},)"
              R"("extensions":{{"KHR_materials_unlit":{{}}}}}}],{}}})",
              node_numbers_, nodes_, meshes_, buffer_.json()),
      buffer_.bytes());
}

}  // namespace fovea
