#include "fovea/exporting/tileset/glb.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "fovea/exporting/gltf.h"
#include "fovea/map/point_files/byte_packer.h"
#include "fovea/map/point_files/point_source.h"

namespace fovea {
namespace {

constexpr double kMaxStep = 65535;

/// An attribute and what a point has of it.
struct Attribute {
  const char* name;
  GltfColumn column;
};
constexpr std::array kPointAttributes{
    Attribute{"POSITION", {GltfType::kUnsignedShort, false, "VEC3", 8}},
    Attribute{"COLOR_0", {GltfType::kUnsignedShort, true, "VEC4", 8}},
    Attribute{"_FRAME", {GltfType::kFloat, false, "SCALAR", 4}},
    Attribute{"_SIGHT", {GltfType::kUnsignedShort, false, "VEC2", 4}},
    Attribute{"_SOURCE", {GltfType::kUnsignedByte, false, "VEC4", 4}},
};
constexpr std::size_t kPlainAttributes = 2;

/// The points' bounding cube, and places in it.
struct Quantiser {
  explicit Quantiser(std::span<const ExportPoint> points) {
    for (const ExportPoint& point : points) box.extend(point.position);
    step = std::max(box.sizes().maxCoeff() / kMaxStep, 1e-6);  // a matrix must not be singular
  }
  Eigen::Array3i quantised(const Eigen::Vector3d& p) const {
    return ((p - box.min()) / step).array().round().cast<int>();
  }
  Eigen::AlignedBox3d box;
  double step;
};

/// The mesh's member for levels of detail.
std::string extras_json(std::span<const std::size_t> levels) {
  return levels.empty()
             ? ""
             : fmt::format(R"(,"extras":{{"{}":[{}]}})", kGlbLevels, fmt::join(levels, ","));
}

/// @param extras  more members of the mesh, with a comma before them
/// @param buffer  gets the attributes
std::string json(const Quantiser& quantiser, std::size_t points,
                 std::span<const Attribute> attributes, const std::string& extras,
                 GltfBuffer& buffer) {
  const Eigen::Array3i high = quantiser.quantised(quantiser.box.max());
  std::string names;
  for (const Attribute& a : attributes) {
    const bool first = names.empty();
    const std::size_t number = buffer.add(
        a.column, points,
        first ? fmt::format(R"(,"min":[0,0,0],"max":[{},{},{}])", high.x(), high.y(), high.z())
              : "");
    names += fmt::format(R"({}"{}":{})", first ? "" : ",", a.name, number);
  }
  return gltf_begin() +
         fmt::format(
             R"("extensionsUsed":["KHR_mesh_quantization","KHR_materials_unlit"],)"
             R"("extensionsRequired":["KHR_mesh_quantization"],)"
             R"("scene":0,"scenes":[{{"nodes":[0]}}],)"
             R"("nodes":[{{"mesh":0,"matrix":{}}}],)"
             R"("meshes":[{{"primitives":[{{"mode":0,"attributes":{{{}}},"material":0}}]{}}}],)"
             R"("materials":[{{"extensions":{{"KHR_materials_unlit":{{}}}}}}],{}}})",
             gltf_matrix(quantiser.step, quantiser.box.min()), names, extras, buffer.json());
}

void put_sources(std::span<const ExportPoint> points, BytePacker& packer) {
  for (const ExportPoint& point : points) packer.put(static_cast<float>(point.frame));
  for (const ExportPoint& point : points) {
    packer.put(sight_range(point.range));
    packer.put(sight_incidence(point.incidence));
  }
  for (const ExportPoint& point : points) {
    packer.put(static_cast<std::uint8_t>(point.camera));
    packer.put(rule_byte(point.reason, point.interpolated));
    packer.put(point.views);
    packer.put(point.spread);
  }
}

}  // namespace

Glb make_glb(std::span<const ExportPoint> points, bool with_sources,
             std::span<const std::size_t> levels) {
  if (points.empty()) return {empty_glb(), 0};
  const Quantiser quantiser(points);
  const std::span<const Attribute> attributes =
      std::span(kPointAttributes).first(with_sources ? kPointAttributes.size() : kPlainAttributes);

  Glb glb;
  glb.step = quantiser.step;
  GltfBuffer buffer;
  const std::string text = json(quantiser, points.size(), attributes, extras_json(levels), buffer);
  glb.bytes = glb_head(text, buffer.bytes());
  BytePacker packer(glb.bytes);
  for (const ExportPoint& point : points) {
    for (const int coordinate : quantiser.quantised(point.position)) {
      packer.put(static_cast<std::uint16_t>(coordinate));
    }
    packer.put_zeros(2);
  }
  for (const ExportPoint& point : points) {
    const Rgb color = point.color;
    for (const std::uint8_t channel : {color.r, color.g, color.b})
      packer.put(linear_light(channel));
    packer.put(std::uint16_t{65535});
  }
  if (with_sources) put_sources(points, packer);
  return glb;
}

}  // namespace fovea
