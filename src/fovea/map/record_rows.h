// Records of a map as rows of its tables, and back. Private to map/.
#pragma once

#include <string>
#include <utility>

#include "fovea/map/frame_record.h"
#include "fovea/map/map_records.h"
#include "fovea/map/map_row.h"
#include "fovea/map/tile_codec.h"

namespace fovea {

// To rows; std::invalid_argument if a number is not finite.
Row meta_row(const std::string& key, const std::string& value);
Row drive_row(std::size_t id, const DriveRecord& drive);
Row sensor_row(std::size_t id, const SensorRecord& sensor);
Row frame_row(const FrameRecord& frame);
Row view_row(int frame, const ViewRecord& view);
Row submap_row(std::size_t id, const SubmapRecord& submap);
/// `blob` takes the compressed ranges, to which the row refers.
Row keyframe_row(const KeyframeRecord& keyframe, std::vector<std::byte>& blob);
/// `blob` as above.
Row checkpoint_row(const std::string& name, const CheckpointRecord& checkpoint,
                   std::vector<std::byte>& blob);

// From rows; InputError as of RowCursor. Numbers of rows are the first column, which is skipped.
DriveRecord drive_of(RowCursor row);
SensorRecord sensor_of(RowCursor row);
FrameRecord frame_of(RowCursor row);  ///< without views
std::pair<int, ViewRecord> view_of(RowCursor row);
SubmapRecord submap_of(RowCursor row);
KeyframeRecord keyframe_of(RowCursor row);
CheckpointRecord checkpoint_of(RowCursor row);

/// The ranges of a range image as bytes before compression.
std::vector<std::byte> packed_ranges(const KeyframeRecord& keyframe);

}  // namespace fovea
