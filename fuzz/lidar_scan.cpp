// Scans in PCD and PLY. The first byte says which, and how the times count or whether the units are
// recognized.
#include "fovea/drive/scans/lidar_scan.h"

#include <fstream>

#include "fovea/drive/scans/recognized_format.h"
#include "fuzz_input.h"
#include "scratch_folder.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ScratchFolder folder;
  if (size == 0) return 0;
  const std::filesystem::path file = folder / ((data[0] & 1) != 0 ? "a.ply" : "a.pcd");
  std::ofstream(file, std::ios::binary) << as_text(data + 1, size - 1);
  ScanFormat format;
  if ((data[0] & 2) != 0) format.time_reference = TimeReference::kAbsolute;
  constexpr TimeNs kStamp = 1'700'000'000'000'000'000;
  read_or_refuse([&] {
    const ScanNumbers numbers = read_scan_numbers(file, kStamp);
    try {
      if ((data[0] & 4) != 0) format = recognize_format(std::span(&numbers, 1), {}).format;
    } catch (const ConfigError&) {
      // Numbers without a meaning; the file may still be read.
    }
    const LidarScan scan = read_lidar_scan(file, format, kStamp);
    scan.points.check();
    require(!scan.points.empty(), "a scan has points");
    for (const Eigen::Vector3f& p : scan.points.position) {
      require(p.cwiseAbs().maxCoeff() <= 1000, "points lie within reach");
    }
    for (const float time : scan.points.time)
      require(std::abs(time) <= 1, "times are near the stamp");
  });
  return 0;
}
