#include "fovea/drive/kitti/kitti_scan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "fovea/core/point_formats/column_names.h"
#include "fovea/drive/scans/point_layout.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little endian");

constexpr std::size_t kKittiNumbers = 4, kRingNumbers = 5;
constexpr const char* kRestore = "restore the file from the drive's archive";
constexpr const char* kWriteAnew =
    "write x y z intensity (16 bytes per point), x y z intensity ring (20 bytes), PCD or PLY";

/// A point with the number of its ring.
using RingRow = std::array<float, kRingNumbers>;

bool is_ring_row(const RingRow& row) {
  constexpr float kMaxRing = 65535;
  return row[3] >= 0 && row[4] >= 0 && row[4] <= kMaxRing && row[4] == std::floor(row[4]);
}

/// Numbers per point. InputError if the file has points of another form.
std::size_t layout_of(std::span<const std::uint8_t> bytes, const std::string& name) {
  const auto fits = [&](std::size_t numbers) { return bytes.size() % (4 * numbers) == 0; };
  const std::optional<std::size_t> found = numbers_per_point(bytes);
  if (found && *found != kKittiNumbers && *found != kRingNumbers) {
    throw InputError("the points have " + std::to_string(*found) + " numbers each (" +
                         std::to_string(4 * *found) + " bytes), which is no known form",
                     name, kWriteAnew);
  }
  const std::size_t numbers =
      found.value_or(!fits(kKittiNumbers) && fits(kRingNumbers) ? kRingNumbers : kKittiNumbers);
  if (fits(numbers)) return numbers;
  throw InputError("the scan has " + std::to_string(bytes.size()) + " bytes, no multiple of the " +
                       std::to_string(4 * numbers) + " of a point",
                   name, kRestore);
}

LidarScan read_rows(std::span<const std::uint8_t> bytes, const std::filesystem::path& file) {
  const std::size_t count = bytes.size() / sizeof(ScanBuilder::Row);
  ScanBuilder scan(count, /*timed=*/false);
  std::array<ScanBuilder::Row, 256> rows;
  for (std::size_t begin = 0; begin < count; begin += rows.size()) {
    const std::size_t n = std::min(rows.size(), count - begin);
    std::memcpy(rows.data(), bytes.data() + begin * sizeof rows[0], n * sizeof rows[0]);
    scan.add(std::span(rows).first(n));
  }
  return scan.take(file);
}

bool is_finite(const RingRow& row) {
  return std::all_of(row.begin(), row.end(), [](float value) { return std::isfinite(value); });
}

/// InputError unless each fifth number is a ring.
std::vector<RingRow> ring_rows(std::span<const std::uint8_t> bytes, const std::string& name) {
  std::vector<RingRow> rows(bytes.size() / sizeof(RingRow));
  std::memcpy(rows.data(), bytes.data(), rows.size() * sizeof(RingRow));
  for (const RingRow& row : rows) {
    if (is_finite(row) && !is_ring_row(row)) {
      throw InputError("the points have 5 numbers each, but not x y z intensity ring", name,
                       kWriteAnew);
    }
  }
  return rows;
}

LidarScan read_ring_rows(std::span<const std::uint8_t> bytes, const std::filesystem::path& file) {
  const std::vector<RingRow> rows = ring_rows(bytes, file.string());
  ScanBuilder scan(rows.size(), /*timed=*/false);
  for (const RingRow& row : rows) {
    if (scan.add({row[0], row[1], row[2]}, row[3])) scan.add_ring(row[4]);
  }
  return scan.take(file);
}

/// Bytes of the points. InputError if there are none.
std::vector<std::uint8_t> point_bytes(const InputFile& file) {
  std::vector<std::uint8_t> bytes = file.bytes();
  if (bytes.empty()) throw InputError("the scan is empty", file.path().string(), kRestore);
  return bytes;
}

}  // namespace

LidarScan read_kitti_scan(const InputFile& file) {
  const std::vector<std::uint8_t> bytes = point_bytes(file);
  const std::size_t numbers = layout_of(bytes, file.path().string());
  return numbers == kRingNumbers ? read_ring_rows(bytes, file.path())
                                 : read_rows(bytes, file.path());
}

LidarScan read_kitti_scan(const std::filesystem::path& file) {
  return read_kitti_scan(InputFile(file, kScanFile));
}

void read_kitti_rows(const InputFile& file, CloudRows& rows) {
  const std::array<std::string, kRingNumbers> all_names = {"x", "y", "z", "intensity", "ring"};
  const std::vector<std::uint8_t> bytes = point_bytes(file);
  const std::size_t numbers = layout_of(bytes, file.path().string());
  if (numbers == kRingNumbers) ring_rows(bytes, file.path().string());
  const std::span<const std::string> names = std::span(all_names).first(numbers);
  std::vector<std::optional<std::size_t>> places;  // by column wanted
  std::vector<std::optional<Scalar>> types;
  for (const char* wanted : rows.columns()) {
    places.push_back(find_column(names, wanted));
    types.push_back(places.back() ? std::optional(Scalar::kFloat) : std::nullopt);
  }
  const std::size_t count = bytes.size() / (4 * numbers);
  rows.describe(names, /*organized=*/false);
  rows.begin(count, types);
  std::vector<double> row(places.size(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    RingRow values{};
    std::memcpy(values.data(), bytes.data() + i * 4 * numbers, 4 * numbers);
    for (std::size_t column = 0; column < row.size(); ++column) {
      if (places[column]) row[column] = double(values[*places[column]]);
    }
    rows.add(row, i);
  }
}

}  // namespace fovea
