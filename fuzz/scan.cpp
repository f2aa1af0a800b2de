// LiDAR scans without a header.
#include "fovea/drive/kitti/kitti_scan.h"
#include "fuzz_input.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static FileInMemory file;
  read_or_refuse([&] {
    const LidarScan scan = read_kitti_scan(file.hold(as_text(data, size)));
    scan.points.check();
    const std::size_t point_bytes = scan.points.ring.empty() ? 16 : 20;
    require(scan.points.size() + scan.dropped.total() == size / point_bytes,
            "every point is kept or counted");
    for (const Eigen::Vector3f& p : scan.points.position) {
      require(p.allFinite(), "points are finite");
    }
  });
  return 0;
}
