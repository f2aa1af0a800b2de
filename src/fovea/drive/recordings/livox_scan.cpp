#include "fovea/drive/recordings/livox_scan.h"

#include <array>

#include "fovea/drive/recordings/named_rows.h"

namespace fovea::ros {

LivoxScan read_livox_scan(MessageReader& message) {
  LivoxScan scan;
  scan.header = read_header(message);
  message.number<std::uint64_t>();  // time of the first point, which the stamp gives, too
  message.number<std::uint32_t>();  // number of points, which the sequence gives, too
  message.number<std::uint8_t>();   // number of the LiDAR
  message.block(3);                 // reserved
  constexpr std::size_t kLeastBytes = 4 + 3 * 4 + 3;
  scan.points.resize(message.count(kLeastBytes));
  for (LivoxPoint& point : scan.points) {
    point.offset_time = message.number<std::uint32_t>();
    point.x = message.number<float>();
    point.y = message.number<float>();
    point.z = message.number<float>();
    point.reflectivity = message.number<std::uint8_t>();
    message.block(2);  // tag and line
  }
  return scan;
}

void read_rows(const LivoxScan& scan, CloudRows& rows) {
  static const std::array<NamedColumn, 5> kColumns = {{{"x", Scalar::kFloat},
                                                       {"y", Scalar::kFloat},
                                                       {"z", Scalar::kFloat},
                                                       {"reflectivity", Scalar::kUint8},
                                                       {"offset_time", Scalar::kUint32}}};
  NamedRows named(kColumns, scan.points.size(), rows);
  for (const LivoxPoint& p : scan.points) {
    named.add(std::array<double, 5>{p.x, p.y, p.z, double(p.reflectivity), double(p.offset_time)});
  }
}

}  // namespace fovea::ros
