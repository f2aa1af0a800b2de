// Work before the first frame of a run: checks of its sources, calibration of its cameras.
#pragma once

#include <vector>

#include "fovea/map/map_records.h"
#include "fovea/pipeline/drive_calibration.h"
#include "fovea/pipeline/map_drive.h"

namespace fovea {

/// InputError if the drive lacks a motion or a camera that the job needs.
void require_sources(const DriveInfo& drive, const MapJob& job);

/// Whether scans are raw sweeps whose motion the run undoes.
bool has_sweep_motion(const DriveInfo& drive, const MapJob& job);

/// If the job asks for it, corrects the calibration of the drive and stores the correction in the
/// meta data.
/// @return the corrections; empty if the job does not ask for them
DriveCalibration correct_calibration(const FrameSource& source, const MapJob& job, DriveInfo& drive,
                                     MapMeta& meta);

/// Opens the map to continue, or a new one at its place or in the scratch folder.
std::unique_ptr<MapWriter> open_output(const MapJob& job);

}  // namespace fovea
