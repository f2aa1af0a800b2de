// A drive and its frames in Python.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "fovea/drive.h"

namespace fovea::python {

/// Half-open; an open end is the drive's own.
using FrameRange = std::pair<std::optional<int>, std::optional<int>>;

DriveOptions drive_options(const std::vector<int>& cameras, const FrameRange& frames);

/// A frame with the drive that says what its images and poses are.
struct FrameOfDrive {
  Drive drive;
  DriveFrame frame;
};

}  // namespace fovea::python
