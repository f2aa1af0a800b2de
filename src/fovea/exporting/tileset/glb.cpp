#include "fovea/exporting/tileset/glb.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/base/version.h"
#include "fovea/exporting/byte_packer.h"
#include "fovea/exporting/point_source.h"

namespace fovea {
namespace {

constexpr double kMaxStep = 65535;
constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2;                // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;  // "JSON", "BIN"

// glTF's numbers for the types of components.
constexpr int kUnsignedByte = 5121, kUnsignedShort = 5123, kFloat = 5126;

/// An attribute and what a point has of it in a buffer view of its own.
struct Attribute {
  const char* name;
  int component_type;
  bool normalized;
  const char* type;
  std::size_t stride;  // glTF wants multiples of 4
};
constexpr std::array kPointAttributes{
    Attribute{"POSITION", kUnsignedShort, false, "VEC3", 8},
    Attribute{"COLOR_0", kUnsignedShort, true, "VEC4", 8},
    Attribute{"_FRAME", kFloat, false, "SCALAR", 4},
    Attribute{"_SIGHT", kUnsignedShort, false, "VEC2", 4},
    Attribute{"_SOURCE", kUnsignedByte, false, "VEC4", 4},
};
constexpr std::size_t kPlainAttributes = 2;

/// IEC 61966-2-1, to 16 bits.
std::array<std::uint16_t, 256> linear_of_srgb() {
  std::array<std::uint16_t, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double s = static_cast<double>(i) / 255;
    const double light = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    linear[i] = static_cast<std::uint16_t>(std::lround(65535 * light));
  }
  return linear;
}

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

std::string header() {
  return fmt::format(R"({{"asset":{{"version":"2.0","generator":"fovea {}"}},)", version());
}

std::string json(const Quantiser& quantiser, std::size_t points,
                 std::span<const Attribute> attributes) {
  const double s = quantiser.step;
  const Eigen::Vector3d low = quantiser.box.min();
  const Eigen::Array3i high = quantiser.quantised(quantiser.box.max());
  std::string names, accessors, views;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < attributes.size(); ++i) {
    const Attribute& a = attributes[i];
    const char* comma = i == 0 ? "" : ",";
    names += fmt::format(R"({}"{}":{})", comma, a.name, i);
    accessors += fmt::format(
        R"({}{{"bufferView":{},"componentType":{},"normalized":{},"count":{},"type":"{}")", comma,
        i, a.component_type, a.normalized, points, a.type);
    if (i == 0) {
      accessors += fmt::format(R"(,"min":[0,0,0],"max":[{},{},{}])", high.x(), high.y(), high.z());
    }
    accessors += '}';
    views += fmt::format(
        R"({}{{"buffer":0,"byteOffset":{},"byteLength":{},"byteStride":{},"target":34962}})", comma,
        offset, a.stride * points, a.stride);
    offset += a.stride * points;
  }
  return header() +
         fmt::format(
             R"("extensionsUsed":["KHR_mesh_quantization","KHR_materials_unlit"],)"
             R"("extensionsRequired":["KHR_mesh_quantization"],)"
             R"("scene":0,"scenes":[{{"nodes":[0]}}],)"
             R"("nodes":[{{"mesh":0,"matrix":[{},0,0,0,0,0,{},0,0,{},0,0,{},{},{},1]}}],)"
             R"("meshes":[{{"primitives":[{{"mode":0,"attributes":{{{}}},"material":0}}]}}],)"
             R"("materials":[{{"extensions":{{"KHR_materials_unlit":{{}}}}}}],)"
             R"("accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}})",
             s, -s, s, low.x(), low.z(), -low.y(), names, accessors, views, offset);
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

std::string file(std::string text, std::size_t binary) {
  text.append((4 - text.size() % 4) % 4, ' ');
  const std::size_t chunk = binary == 0 ? 0 : 8 + binary;
  std::string bytes;
  bytes.reserve(20 + text.size() + chunk);
  BytePacker packer(bytes);
  packer.put(kMagic);
  packer.put(kVersion);
  packer.put(static_cast<std::uint32_t>(20 + text.size() + chunk));
  packer.put(static_cast<std::uint32_t>(text.size()));
  packer.put(kJsonChunk);
  packer.put_text(text, text.size());
  if (binary > 0) {
    packer.put(static_cast<std::uint32_t>(binary));
    packer.put(kBinChunk);
  }
  return bytes;
}

}  // namespace

Glb make_glb(std::span<const ExportPoint> points, bool with_sources) {
  if (points.empty()) return {file(header() + R"("scene":0,"scenes":[{}]})", 0), 0};
  static const std::array<std::uint16_t, 256> kLinear = linear_of_srgb();
  const Quantiser quantiser(points);
  const std::span<const Attribute> attributes =
      std::span(kPointAttributes).first(with_sources ? kPointAttributes.size() : kPlainAttributes);
  std::size_t stride = 0;
  for (const Attribute& attribute : attributes) stride += attribute.stride;

  Glb glb;
  glb.step = quantiser.step;
  glb.bytes = file(json(quantiser, points.size(), attributes), stride * points.size());
  BytePacker packer(glb.bytes);
  for (const ExportPoint& point : points) {
    for (const int coordinate : quantiser.quantised(point.position)) {
      packer.put(static_cast<std::uint16_t>(coordinate));
    }
    packer.put_zeros(2);
  }
  for (const ExportPoint& point : points) {
    const Rgb color = point.color;
    for (const std::uint8_t channel : {color.r, color.g, color.b}) packer.put(kLinear[channel]);
    packer.put(std::uint16_t{65535});
  }
  if (with_sources) put_sources(points, packer);
  return glb;
}

}  // namespace fovea
