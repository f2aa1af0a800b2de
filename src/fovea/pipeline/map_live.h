// A live drive into a map file: the frames as they come.
#pragma once

#include <functional>

#include "fovea/drive/live/live_source.h"
#include "fovea/pipeline/map_drive.h"

namespace fovea {

/// Maps the frames of a source until it is closed, or until the job's stop, and closes it. The map
/// is complete at any end, and a function of the accepted frames.
///
/// Every scan is tracked. If time is short, frames add nothing to the map: those after which
/// another one is tracked already, and those whose scan is old. Memory is bounded by the queues of
/// the source and of the pipeline.
/// @param job       its rate, overlap, calibrate, given poses and scratch are not used
/// @param progress  as for map_drive(); the total is 0
/// Errors as map_drive(). InputError if the source is closed before the first scan.
MapSummary map_live(LiveSource& source, const MapJob& job,
                    const std::function<void(const RunProgress&)>& progress);

}  // namespace fovea
