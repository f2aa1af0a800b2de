// The first frames of a live drive, which are there before its mapper begins.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "fovea/drive/live/live_beginning.h"
#include "fovea/drive/live/live_motion.h"

namespace fovea {

/// Adds the first frames and the motion to `info`.
/// @throws InputError  as convert_navigation()
void add_first_frames(std::span<const RawFrame> frames, const DriveDescription& description,
                      LiveMotion& motion, const LocalFrame& local, LiveBeginning& beginning);

/// Until when a sweep of the first LiDAR lasts, from its stamp.
TimeNs sweep_end(const LiveDecoder& decoder);

/// The frames at hand as a drive.
std::unique_ptr<FrameSource> first_frames_source(DriveInfo info,
                                                 std::shared_ptr<const LiveDecoder> decoder,
                                                 std::vector<RawFrame> frames);

}  // namespace fovea
