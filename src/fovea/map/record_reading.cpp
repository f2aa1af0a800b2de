#include <cmath>

#include "fovea/map/number_text.h"
#include "fovea/map/record_rows.h"
#include "fovea/map/sensor_json.h"
#include "fovea/map/value_plane.h"
#include "fovea/map/zstd_blob.h"

namespace fovea {
namespace {

/// Numbers in the upper triangle of a symmetric 6 x 6 matrix.
constexpr std::size_t kCovarianceNumbers = 21;

Eigen::Matrix<double, 6, 6> covariance_of(const std::vector<double>& numbers) {
  Eigen::Matrix<double, 6, 6> covariance;
  std::size_t next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      covariance(row, column) = covariance(column, row) = numbers[next++];
    }
  }
  return covariance;
}

std::optional<std::string> optional_text(RowCursor& row) {
  if (row.skip_null()) return std::nullopt;
  return row.text();
}

std::optional<double> optional_real(RowCursor& row) {
  if (row.skip_null()) return std::nullopt;
  return row.real();
}

std::optional<GeodeticPoint> optional_origin(RowCursor& row) {
  const auto latitude = optional_real(row), longitude = optional_real(row),
             height = optional_real(row);
  if (!latitude && !longitude && !height) return std::nullopt;
  if (!latitude || !longitude || !height) row.fail();
  return GeodeticPoint{*latitude, *longitude, *height};
}

std::optional<HeightType> optional_height_type(RowCursor& row) {
  if (row.skip_null()) return std::nullopt;
  const std::string name = row.text();
  for (const HeightType type : {HeightType::kEllipsoidal, HeightType::kOrthometric}) {
    if (name == to_string(type)) return type;
  }
  row.fail();
}

std::optional<Eigen::Vector3d> optional_vector(RowCursor& row) {
  if (row.skip_null()) return std::nullopt;
  const std::vector<double> numbers = row.numbers();
  if (numbers.size() != 3) row.fail();
  return Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
}

CameraResponse response_of(RowCursor& row) {
  const std::vector<double> numbers = row.numbers();
  if (numbers.size() != 4 || !(numbers[0] >= 0 && numbers[0] <= 255)) row.fail();
  return {numbers[0], {numbers[1], numbers[2], numbers[3]}};
}

RevisitedColors revisit_of(RowCursor& row) {
  const std::vector<double> numbers = row.numbers();
  constexpr double kMaxSubmap = 1e9;
  const bool is_whole = numbers.size() == 4 && numbers[0] >= 0 && numbers[0] <= kMaxSubmap &&
                        numbers[0] == std::floor(numbers[0]);
  if (!is_whole) row.fail();
  return {static_cast<int>(numbers[0]), {numbers[1], numbers[2], numbers[3]}};
}

}  // namespace

DriveRecord drive_of(RowCursor row) {
  DriveRecord drive;
  row.index();
  drive.name = row.text();
  drive.kind = row.text();
  drive.session = optional_text(row);
  drive.calibration_fingerprint = optional_text(row);
  drive.stamps_fingerprint = optional_text(row);
  drive.first_frame = row.index();
  drive.end_frame = row.index(drive.first_frame);
  constexpr int kAnyShift = -(1 << 30);
  drive.frame_shift = row.index(kAnyShift);
  drive.T_local_drive = row.pose();
  drive.origin = optional_origin(row);
  drive.datum = optional_text(row);
  drive.epoch_year = optional_real(row);
  drive.height_type = optional_height_type(row);
  drive.source_digest = optional_text(row);
  return drive;
}

SensorRecord sensor_of(RowCursor row) {
  SensorRecord sensor;
  row.index();
  sensor.drive = row.index();
  std::string name = row.text();
  sensor.T_lidar_sensor = row.pose();
  const std::string profile = row.text();
  sensor.profile = row.require(sensor_profile_from_json(profile));
  sensor.profile.name = std::move(name);
  return sensor;
}

FrameRecord frame_of(RowCursor row) {
  FrameRecord frame;
  frame.index = row.index();
  if (!row.skip_null()) frame.stamp = row.integer();
  const std::string status = row.text();
  frame.status = row.require(frame_status(status));
  frame.note = row.text();
  frame.T_local_lidar = row.pose();
  if (!row.skip_null()) frame.T_local_lidar_navigation = row.pose();
  frame.T_odom_lidar = row.pose();
  frame.submap = row.index(/*least=*/-1);
  if (row.skip_null()) {
    if (!row.skip_null()) row.fail();
  } else {
    frame.revisit.emplace();
    frame.revisit->submap = row.index(/*least=*/-1);
    frame.revisit->T_submap_lidar = row.pose();
  }
  if (!row.skip_null()) {
    const std::string motion = row.text();
    frame.motion = row.require(sweep_motion_from_text(motion));
  }
  const std::string figures = row.text();
  frame.figures = row.require(numbers_from_json(figures));
  const std::string timings = row.text();
  frame.milliseconds = row.require(numbers_from_json(timings));
  return frame;
}

std::pair<int, ViewRecord> view_of(RowCursor row) {
  ViewRecord view;
  const int frame = row.index();
  view.camera = row.index();
  if (!row.skip_null()) view.stamp = row.integer();
  Eigen::Vector3d log2_gain;
  int known = 0;
  for (int channel = 0; channel < 3; ++channel) {
    if (row.skip_null()) continue;
    log2_gain[channel] = row.real();
    ++known;
  }
  if (known == 3) view.log2_gain = log2_gain;
  if (known != 0 && known != 3) row.fail();
  view.log2_color = optional_vector(row);
  if (!row.skip_null()) view.response = response_of(row);
  if (!row.skip_null()) view.revisit = revisit_of(row);
  return {frame, view};
}

SubmapRecord submap_of(RowCursor row) {
  SubmapRecord submap;
  row.index();
  submap.drive = row.index();
  submap.T_local_submap = row.pose();
  if (!row.skip_null()) {
    const std::vector<double> numbers = row.numbers();
    if (numbers.size() != kCovarianceNumbers) row.fail();
    submap.covariance = covariance_of(numbers);
  }
  submap.log2_gain = optional_vector(row);
  return submap;
}

KeyframeRecord keyframe_of(RowCursor row) {
  KeyframeRecord keyframe;
  keyframe.frame = row.index();
  keyframe.sensor = row.index();
  keyframe.elevations = row.numbers();
  keyframe.columns = static_cast<std::size_t>(row.index());
  if (keyframe.columns > kMaxRangePixels) row.fail();
  keyframe.first_azimuth = row.real();
  keyframe.azimuth_step = row.real();
  const std::size_t pixels = keyframe.elevations.size() * keyframe.columns;
  if (pixels == 0 || pixels > kMaxRangePixels) row.fail();
  const auto bytes = row.require(decompress_blob(row.blob(), kPlaneBytes * pixels));
  if (bytes.size() != kPlaneBytes * pixels) row.fail();
  unpack_plane(pixels, bytes.data(), keyframe.ranges);
  return keyframe;
}

CheckpointRecord checkpoint_of(RowCursor row) {
  CheckpointRecord checkpoint;
  row.text();
  checkpoint.frame = row.index();
  checkpoint.state = row.require(decompress_blob(row.blob(), kMaxCheckpointSize));
  return checkpoint;
}

}  // namespace fovea
