#include "fovea/exporting/gltf.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "fovea/map/point_files/byte_packer.h"
#include "fovea/platform.h"

namespace fovea {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2;                // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;  // "JSON", "BIN"
constexpr int kVertices = 34962, kIndices = 34963;                        // targets of views

std::array<std::uint16_t, 256> light_of_channels() {
  std::array<std::uint16_t, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double s = static_cast<double>(i) / 255;
    const double light = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    linear[i] = static_cast<std::uint16_t>(std::lround(65535 * light));
  }
  return linear;
}

}  // namespace

std::size_t GltfBuffer::add(const GltfColumn& column, std::size_t count,
                            const std::string& bounds) {
  const char* comma = count_ == 0 ? "" : ",";
  accessors_ += fmt::format(
      R"({}{{"bufferView":{},"componentType":{},"normalized":{},"count":{},"type":"{}"{}}})", comma,
      count_, static_cast<int>(column.component), column.normalized, count, column.type, bounds);
  const std::size_t length = column.stride * count;
  views_ +=
      fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{},)", comma, bytes_, length);
  if (!column.indices) views_ += fmt::format(R"("byteStride":{},)", column.stride);
  views_ += fmt::format(R"("target":{}}})", column.indices ? kIndices : kVertices);
  bytes_ += (length + 3) / 4 * 4;
  return count_++;
}

std::string GltfBuffer::json() const {
  return fmt::format(R"("accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}])",
                     accessors_, views_, bytes_);
}

std::string gltf_begin() {
  return fmt::format(R"({{"asset":{{"version":"2.0","generator":"fovea {}"}},)", version());
}

std::string glb_head(std::string json, std::size_t binary) {
  json.append((4 - json.size() % 4) % 4, ' ');
  const std::size_t chunk = binary == 0 ? 0 : 8 + binary;
  std::string bytes;
  bytes.reserve(20 + json.size() + chunk);
  BytePacker packer(bytes);
  packer.put(kMagic);
  packer.put(kVersion);
  packer.put(static_cast<std::uint32_t>(20 + json.size() + chunk));
  packer.put(static_cast<std::uint32_t>(json.size()));
  packer.put(kJsonChunk);
  packer.put_text(json, json.size());
  if (binary > 0) {
    packer.put(static_cast<std::uint32_t>(binary));
    packer.put(kBinChunk);
  }
  return bytes;
}

std::string empty_glb() { return glb_head(gltf_begin() + R"("scene":0,"scenes":[{}]})", 0); }

std::string gltf_matrix(double step, const Eigen::Vector3d& low) {
  return fmt::format("[{},0,0,0,0,0,{},0,0,{},0,0,{},{},{},1]", step, -step, step, low.x(), low.z(),
                     -low.y());
}

std::uint16_t linear_light(std::uint8_t channel) {
  static const std::array<std::uint16_t, 256> kLight = light_of_channels();
  return kLight[channel];
}

}  // namespace fovea
