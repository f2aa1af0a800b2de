#include "fovea/sensor/kitti_scan.h"

#include <bit>
#include <cstring>
#include <string>

#include "fovea/base/errors.h"
#include "fovea/sensor/read_file.h"

namespace fovea {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little endian");

constexpr std::size_t kBytesPerPoint = 4 * sizeof(float);
constexpr const char* kRemedy = "restore the file from the drive's archive";

}  // namespace

LidarScan read_kitti_scan(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_bytes(file);
  if (bytes.empty()) throw InputError("the scan is empty", file.string(), kRemedy);
  if (bytes.size() % kBytesPerPoint != 0) {
    throw InputError(
        "the scan has " + std::to_string(bytes.size()) + " bytes, no multiple of the 16 of a point",
        file.string(), kRemedy);
  }
  const std::size_t count = bytes.size() / kBytesPerPoint;
  ScanBuilder scan(count, /*timed=*/false);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 4> p;
    std::memcpy(p.data(), bytes.data() + i * kBytesPerPoint, kBytesPerPoint);
    scan.add({p[0], p[1], p[2]}, p[3]);
  }
  return scan.take(file);
}

}  // namespace fovea
