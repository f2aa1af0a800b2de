// The contents of the public drives. Private to api/.
#pragma once

#include <memory>

#include "fovea/drive.h"
#include "fovea/drive/frame_source.h"

namespace fovea {

struct Drive::Content {
  std::unique_ptr<const FrameSource> source;
  std::filesystem::path folder;  ///< as it was given: the drive may be a folder in it
};

struct DriveFrame::Content {
  std::shared_ptr<const Drive::Content> drive;
  Frame frame;
};

/// The frame of a drive.
/// @throws std::invalid_argument  for a frame of another drive: its cameras are not those expected
const Frame& frame_of(const Drive& drive, const DriveFrame& frame);

}  // namespace fovea
