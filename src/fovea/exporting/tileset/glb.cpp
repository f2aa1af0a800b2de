#include "fovea/exporting/tileset/glb.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "fovea/base/version.h"
#include "fovea/exporting/byte_packer.h"

namespace fovea {
namespace {

constexpr double kMaxStep = 65535;
constexpr std::size_t kStride = 8;  // glTF wants multiples of 4, and three shorts are 6
constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2;                // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;  // "JSON", "BIN"

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
  explicit Quantiser(const std::vector<Eigen::Vector3d>& positions) {
    for (const Eigen::Vector3d& p : positions) box.extend(p);
    step = std::max(box.sizes().maxCoeff() / kMaxStep, 1e-6);  // a matrix must not be singular
  }
  Eigen::Array3i quantised(const Eigen::Vector3d& p) const {
    return ((p - box.min()) / step).array().round().cast<int>();
  }
  Eigen::AlignedBox3d box;
  double step;
};

std::string json(const Quantiser& quantiser, std::size_t points) {
  const double s = quantiser.step;
  const Eigen::Vector3d low = quantiser.box.min();
  const Eigen::Array3i high = quantiser.quantised(quantiser.box.max());
  return fmt::format(
      R"({{"asset":{{"version":"2.0","generator":"fovea {}"}},)"
      R"("extensionsUsed":["KHR_mesh_quantization","KHR_materials_unlit"],)"
      R"("extensionsRequired":["KHR_mesh_quantization"],)"
      R"("scene":0,"scenes":[{{"nodes":[0]}}],)"
      R"("nodes":[{{"mesh":0,"matrix":[{},0,0,0,0,0,{},0,0,{},0,0,{},{},{},1]}}],)"
      R"("meshes":[{{"primitives":[{{"mode":0,"attributes":{{"POSITION":0,"COLOR_0":1}},)"
      R"("material":0}}]}}],)"
      R"("materials":[{{"extensions":{{"KHR_materials_unlit":{{}}}}}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5123,"count":{},"type":"VEC3",)"
      R"("min":[0,0,0],"max":[{},{},{}]}},)"
      R"({{"bufferView":1,"componentType":5123,"normalized":true,"count":{},"type":"VEC4"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{},"byteStride":{},)"
      R"("target":34962}},)"
      R"({{"buffer":0,"byteOffset":{},"byteLength":{},"byteStride":{},"target":34962}}],)"
      R"("buffers":[{{"byteLength":{}}}]}})",
      version(), s, -s, s, low.x(), low.z(), -low.y(), points, high.x(), high.y(), high.z(), points,
      kStride * points, kStride, kStride * points, kStride * points, kStride, 2 * kStride * points);
}

}  // namespace

Glb make_glb(const std::vector<Eigen::Vector3d>& positions, const std::vector<Rgb>& colors) {
  static const std::array<std::uint16_t, 256> kLinear = linear_of_srgb();
  const Quantiser quantiser(positions);
  std::string text = json(quantiser, positions.size());
  text.append((4 - text.size() % 4) % 4, ' ');
  const std::size_t binary = 2 * kStride * positions.size();

  Glb glb;
  glb.step = quantiser.step;
  glb.bytes.reserve(28 + text.size() + binary);
  BytePacker packer(glb.bytes);
  packer.put(kMagic);
  packer.put(kVersion);
  packer.put(static_cast<std::uint32_t>(28 + text.size() + binary));
  packer.put(static_cast<std::uint32_t>(text.size()));
  packer.put(kJsonChunk);
  packer.put_text(text, text.size());
  packer.put(static_cast<std::uint32_t>(binary));
  packer.put(kBinChunk);
  for (const Eigen::Vector3d& p : positions) {
    for (const int coordinate : quantiser.quantised(p)) {
      packer.put(static_cast<std::uint16_t>(coordinate));
    }
    packer.put_zeros(2);
  }
  for (const Rgb color : colors) {
    for (const std::uint8_t channel : {color.r, color.g, color.b}) packer.put(kLinear[channel]);
    packer.put(std::uint16_t{65535});
  }
  return glb;
}

}  // namespace fovea
