// Used and dropped points of the scans of a run.
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "fovea/map/frame_record.h"
#include "fovea/pipeline/frame_result.h"

namespace fovea {

/// Writes the counts of a frame into the figures of its record, where PointCounts finds them.
void count_points(const ScanStats& scan, std::map<std::string, double>& figures);

class PointCounts {
 public:
  void add(const FrameRecord& record);

  std::size_t used() const { return used_; }
  const DroppedPoints& dropped() const { return dropped_; }
  /// Whether over 1 % of the points are dropped for other reasons than a missing return.
  bool is_notable() const;
  /// One line with count, share and reasons; empty if no point was dropped.
  std::string note() const;

 private:
  std::size_t used_ = 0;
  DroppedPoints dropped_;
};

}  // namespace fovea
