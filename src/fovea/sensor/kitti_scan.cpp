#include "fovea/sensor/kitti_scan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <string>

#include "fovea/base/errors.h"
#include "fovea/sensor/column_names.h"
#include "fovea/sensor/read_file.h"

namespace fovea {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little endian");

constexpr std::size_t kBytesPerPoint = sizeof(ScanBuilder::Row);
constexpr const char* kRemedy = "restore the file from the drive's archive";

std::vector<std::uint8_t> read_points(const std::filesystem::path& file) {
  std::vector<std::uint8_t> bytes = read_bytes(file);
  if (bytes.empty()) throw InputError("the scan is empty", file.string(), kRemedy);
  if (bytes.size() % kBytesPerPoint != 0) {
    throw InputError(
        "the scan has " + std::to_string(bytes.size()) + " bytes, no multiple of the 16 of a point",
        file.string(), kRemedy);
  }
  return bytes;
}

}  // namespace

LidarScan read_kitti_scan(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_points(file);
  const std::size_t count = bytes.size() / kBytesPerPoint;
  ScanBuilder scan(count, /*timed=*/false);
  std::array<ScanBuilder::Row, 256> rows;
  for (std::size_t begin = 0; begin < count; begin += rows.size()) {
    const std::size_t n = std::min(rows.size(), count - begin);
    std::memcpy(rows.data(), bytes.data() + begin * kBytesPerPoint, n * kBytesPerPoint);
    scan.add(std::span(rows).first(n));
  }
  return scan.take(file);
}

void read_kitti_rows(const std::filesystem::path& file, CloudRows& rows) {
  const std::array<std::string, 4> names = {"x", "y", "z", "intensity"};
  const std::vector<std::uint8_t> bytes = read_points(file);
  const std::size_t count = bytes.size() / kBytesPerPoint;
  std::vector<std::optional<std::size_t>> places;  // by column wanted
  std::vector<std::optional<Scalar>> types;
  for (const char* wanted : rows.columns()) {
    places.push_back(find_column(names, wanted));
    types.push_back(places.back() ? std::optional(Scalar::kFloat) : std::nullopt);
  }
  rows.describe(names, /*organized=*/false);
  rows.begin(count, types);
  std::vector<double> row(places.size(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    ScanBuilder::Row values;
    std::memcpy(values.data(), bytes.data() + i * kBytesPerPoint, kBytesPerPoint);
    for (std::size_t column = 0; column < row.size(); ++column) {
      if (places[column]) row[column] = double(values[*places[column]]);
    }
    rows.add(row, i);
  }
}

}  // namespace fovea
