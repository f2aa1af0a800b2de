#include "fovea/sensor/kitti_scan.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "fovea/base/errors.h"
#include "fovea/sensor/read_file.h"

namespace fovea {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little endian");

constexpr std::size_t kBytesPerPoint = 4 * sizeof(float);
constexpr float kMaxCoordinate = 1000;  // m; no LiDAR reaches it
constexpr const char* kRemedy = "restore the file from the drive's archive";

bool usable(const std::array<float, 4>& p) {
  // Written so that NaN fails, too.
  return std::abs(p[0]) <= kMaxCoordinate && std::abs(p[1]) <= kMaxCoordinate &&
         std::abs(p[2]) <= kMaxCoordinate && std::isfinite(p[3]);
}

}  // namespace

KittiScan read_kitti_scan(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_bytes(file);
  if (bytes.empty()) throw InputError("the scan is empty", file.string(), kRemedy);
  if (bytes.size() % kBytesPerPoint != 0) {
    throw InputError(
        "the scan has " + std::to_string(bytes.size()) + " bytes, no multiple of the 16 of a point",
        file.string(), kRemedy);
  }
  const std::size_t count = bytes.size() / kBytesPerPoint;
  KittiScan scan;
  scan.points.position.reserve(count);
  scan.points.intensity.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 4> p;
    std::memcpy(p.data(), bytes.data() + i * kBytesPerPoint, kBytesPerPoint);
    if (!usable(p)) continue;
    scan.points.position.emplace_back(p[0], p[1], p[2]);
    scan.points.intensity.push_back(p[3]);
  }
  scan.dropped = count - scan.points.size();
  if (scan.points.empty()) {
    throw InputError("the scan has no usable point (" + std::to_string(count) +
                         " are not finite or beyond 1 km)",
                     file.string(), kRemedy);
  }
  return scan;
}

}  // namespace fovea
