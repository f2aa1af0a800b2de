#include "fovea/api/mapped_frame.h"

namespace fovea {

MappedFrame mapped_frame(const FrameRecord& record) {
  MappedFrame frame{record.index, record.stamp,         record.status,
                    record.note,  record.T_local_lidar, record.figures};
  frame.milliseconds = record.milliseconds;
  frame.T_local_lidar_navigation = record.T_local_lidar_navigation;
  frame.T_odom_lidar = record.T_odom_lidar;
  frame.submap = record.submap;
  frame.motion = record.motion;
  for (const ViewRecord& view : record.views) {
    frame.views.push_back({view.camera, view.stamp, view.log2_gain});
  }
  return frame;
}

std::vector<MappedFrame> mapped_frames(const std::vector<FrameRecord>& records) {
  std::vector<MappedFrame> frames;
  frames.reserve(records.size());
  for (const FrameRecord& record : records) frames.push_back(mapped_frame(record));
  return frames;
}

}  // namespace fovea
