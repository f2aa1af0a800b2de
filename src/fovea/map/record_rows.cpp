#include "fovea/map/record_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fovea/geometry/pose_file.h"
#include "fovea/map/number_text.h"
#include "fovea/map/sensor_json.h"
#include "fovea/map/value_plane.h"
#include "fovea/map/zstd_blob.h"

namespace fovea {
namespace {

void require_finite(bool finite, const std::string& what) {
  if (!finite) throw std::invalid_argument(fmt::format("{} is not finite", what));
}

Cell pose_cell(const RigidMotion& T, const std::string& what) {
  require_finite(T.matrix().allFinite(), what);
  return format_pose(T);
}

Cell covariance_cell(const SubmapRecord& submap, const std::string& what) {
  if (!submap.covariance) return {};
  require_finite(submap.covariance->allFinite(), what);
  std::vector<double> numbers;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      numbers.push_back((*submap.covariance)(row, column));
    }
  }
  return to_text(numbers);
}

Cell numbers_cell(const std::vector<double>& numbers, const std::string& what) {
  for (const double number : numbers) require_finite(std::isfinite(number), what);
  return to_text(numbers);
}

Cell vector_cell(const std::optional<Eigen::Vector3d>& vector, const std::string& what) {
  if (!vector) return {};
  return numbers_cell({vector->x(), vector->y(), vector->z()}, what);
}

/// Offset and vignetting; absent for a plain camera.
Cell response_cell(const CameraResponse& response, const std::string& what) {
  if (response == CameraResponse()) return {};
  std::vector<double> numbers{response.offset};
  numbers.insert(numbers.end(), response.vignetting.begin(), response.vignetting.end());
  return numbers_cell(numbers, what);
}

Cell revisit_cell(const std::optional<RevisitedColors>& revisit, const std::string& what) {
  if (!revisit) return {};
  const Eigen::Vector3d& gain = revisit->log2_gain;
  return numbers_cell({double(revisit->submap), gain.x(), gain.y(), gain.z()}, what);
}

}  // namespace

std::size_t drive_of_frame(const std::vector<DriveRecord>& drives, int frame) {
  const auto found = std::find_if(drives.begin(), drives.end(), [frame](const DriveRecord& drive) {
    return drive.has_frame(frame);
  });
  return static_cast<std::size_t>(found - drives.begin());
}

const char* to_string(HeightType type) {
  return type == HeightType::kEllipsoidal ? "ellipsoidal" : "orthometric";
}

Row meta_row(const std::string& key, const std::string& value) { return {cell(key), cell(value)}; }

Row drive_row(std::size_t id, const DriveRecord& drive) {
  const std::string what = fmt::format("drive {}: a number", id);
  Row row{cell(static_cast<std::int64_t>(id)),
          cell(drive.name),
          cell(drive.kind),
          cell(drive.session),
          cell(drive.calibration_fingerprint),
          cell(drive.stamps_fingerprint),
          cell(std::int64_t{drive.first_frame}),
          cell(std::int64_t{drive.end_frame}),
          cell(std::int64_t{drive.frame_shift}),
          pose_cell(drive.T_local_drive, what)};
  for (const double GeodeticPoint::* part :
       {&GeodeticPoint::latitude, &GeodeticPoint::longitude, &GeodeticPoint::altitude}) {
    require_finite(!drive.origin || std::isfinite((*drive.origin).*part), what);
    row.push_back(drive.origin ? cell((*drive.origin).*part) : Cell());
  }
  require_finite(std::isfinite(drive.epoch_year.value_or(0)), what);
  row.push_back(cell(drive.datum));
  row.push_back(cell(drive.epoch_year));
  row.push_back(drive.height_type ? cell(std::string(to_string(*drive.height_type))) : Cell());
  row.push_back(cell(drive.source_digest));
  return row;
}

Row sensor_row(std::size_t id, const SensorRecord& sensor) {
  return {cell(static_cast<std::int64_t>(id)), cell(std::int64_t{sensor.drive}),
          cell(sensor.profile.name),
          pose_cell(sensor.T_lidar_sensor, fmt::format("the pose of sensor {}", id)),
          cell(to_json(sensor.profile))};
}

Row frame_row(const FrameRecord& frame) {
  const std::string what = fmt::format("frame {}: a pose or motion", frame.index);
  if (frame.motion) {
    require_finite(frame.motion->velocity.allFinite(), what);
    require_finite(frame.motion->acceleration.allFinite(), what);
  }
  return {
      cell(std::int64_t{frame.index}),
      cell(frame.stamp),
      cell(std::string(to_string(frame.status))),
      cell(frame.note),
      pose_cell(frame.T_local_lidar, what),
      frame.T_local_lidar_navigation ? pose_cell(*frame.T_local_lidar_navigation, what) : Cell(),
      pose_cell(frame.T_odom_lidar, what),
      cell(std::int64_t{frame.submap}),
      frame.revisit ? cell(std::int64_t{frame.revisit->submap}) : Cell(),
      frame.revisit ? pose_cell(frame.revisit->T_submap_lidar, what) : Cell(),
      frame.motion ? cell(to_text(*frame.motion)) : Cell(),
      cell(to_json(frame.figures)),
      cell(to_json(frame.milliseconds)),
  };
}

Row view_row(int frame, const ViewRecord& view) {
  Row row{cell(std::int64_t{frame}), cell(std::int64_t{view.camera}), cell(view.stamp)};
  for (int channel = 0; channel < 3; ++channel) {
    const double gain = view.log2_gain ? (*view.log2_gain)[channel] : 0;
    require_finite(std::isfinite(gain), fmt::format("frame {}: a gain", frame));
    row.push_back(view.log2_gain ? cell(gain) : Cell());
  }
  const std::string what = fmt::format("frame {}: a color, response or revisit", frame);
  row.push_back(vector_cell(view.log2_color, what));
  row.push_back(response_cell(view.response, what));
  row.push_back(revisit_cell(view.revisit, what));
  return row;
}

Row submap_row(std::size_t id, const SubmapRecord& submap) {
  const std::string what = fmt::format("submap {}: a pose, covariance or gain", id);
  return {cell(static_cast<std::int64_t>(id)), cell(std::int64_t{submap.drive}),
          pose_cell(submap.T_local_submap, what), covariance_cell(submap, what),
          vector_cell(submap.log2_gain, what)};
}

std::vector<std::byte> packed_ranges(const KeyframeRecord& keyframe) {
  std::vector<std::byte> bytes(kPlaneBytes * keyframe.ranges.size());
  pack_plane(keyframe.ranges, bytes.data());
  return bytes;
}

Row keyframe_row(const KeyframeRecord& keyframe, std::vector<std::byte>& blob) {
  const std::size_t pixels = keyframe.elevations.size() * keyframe.columns;
  if (pixels != keyframe.ranges.size() || pixels > kMaxRangePixels || pixels == 0) {
    throw std::invalid_argument(fmt::format("keyframe {} has {} rows, {} columns and {} ranges",
                                            keyframe.frame, keyframe.elevations.size(),
                                            keyframe.columns, keyframe.ranges.size()));
  }
  bool finite = std::isfinite(keyframe.first_azimuth) && std::isfinite(keyframe.azimuth_step);
  for (const double elevation : keyframe.elevations) finite = finite && std::isfinite(elevation);
  require_finite(finite, fmt::format("keyframe {}: an angle", keyframe.frame));
  blob = compress_blob(packed_ranges(keyframe));
  return {cell(std::int64_t{keyframe.frame}), cell(std::int64_t{keyframe.sensor}),
          cell(to_text(keyframe.elevations)), cell(static_cast<std::int64_t>(keyframe.columns)),
          cell(keyframe.first_azimuth),       cell(keyframe.azimuth_step),
          std::span<const std::byte>(blob)};
}

Row checkpoint_row(const std::string& name, const CheckpointRecord& checkpoint,
                   std::vector<std::byte>& blob) {
  if (checkpoint.state.size() > kMaxCheckpointSize) {
    throw std::invalid_argument(
        fmt::format("the state '{}' has {} bytes", name, checkpoint.state.size()));
  }
  blob = compress_blob(checkpoint.state);
  return {cell(name), cell(std::int64_t{checkpoint.frame}), std::span<const std::byte>(blob)};
}

}  // namespace fovea
