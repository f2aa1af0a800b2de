// The parts of a frame as they came.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "fovea/drive/live/live_source.h"

namespace fovea {

struct RawFrame {
  int index = 0;
  TimeNs stamp = 0;
  WallClock::time_point arrival;  ///< of the scan
  std::shared_ptr<const LiveScan> scan;
  std::vector<std::shared_ptr<const LiveScan>> further_scans;  ///< by further LiDAR; may be null
  std::vector<std::shared_ptr<const LiveImage>> images;        ///< by camera; may be null
  MotionData motion;
};

inline std::size_t content_bytes(const LiveImage& image) {
  if (const auto* pixels = std::get_if<Image>(&image.content)) return pixels->data.size();
  return std::get<std::string>(image.content).size();
}

inline std::size_t content_bytes(const LiveScan& scan) {
  const PointCloud& points = scan.points;
  return points.size() * sizeof(Eigen::Vector3f) +
         (points.intensity.size() + points.time.size()) * sizeof(float) +
         points.ring.size() * sizeof(std::uint16_t);
}

}  // namespace fovea
