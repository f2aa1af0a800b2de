// Records of the mapped drive in the map: its identity, its sensors, the stamps of its images.
#pragma once

#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/map/frame_record.h"
#include "fovea/map/map_records.h"
#include "fovea/pipeline/frame_result.h"

namespace fovea {

/// The drive from its source, before any correction of the calibration.
DriveRecord drive_record(const FrameSource& source);

/// States where `local` lies.
void set_origin(const GeodeticPoint& origin, const CoordinateReference& coordinates,
                DriveRecord& drive);

/// The LiDARs of a drive (DriveInfo::lidars).
std::vector<SensorRecord> sensor_records(const DriveInfo& drive);

/// Adds a view to the record for each image that the frame has, with its gain in the result.
/// @param drive  its calibration has the frame's cameras
void add_views(const Frame& frame, const DriveInfo& drive, const FrameResult& result,
               FrameRecord& record);

/// The record of a frame that the drive skips.
FrameRecord skipped_record(const SkippedFrame& skipped, std::optional<TimeNs> stamp);

/// Counts and names the cameras that gave a frame no image, and the LiDARs that gave it no scan.
void note_missing_parts(const Frame& frame, FrameRecord& record);

}  // namespace fovea
