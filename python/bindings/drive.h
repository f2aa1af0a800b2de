// A drive and its frames in Python.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "fovea/drive/frame_source.h"

namespace fovea::python {

/// Half-open; an open end is the drive's own.
using FrameRange = std::pair<std::optional<int>, std::optional<int>>;

struct Drive {
  std::shared_ptr<const FrameSource> source;
};

/// A frame that knows its drive.
struct DriveFrame {
  std::shared_ptr<const FrameSource> source;
  std::shared_ptr<const Frame> frame;

  /// std::invalid_argument if it is another drive's: its cameras are not those that are expected.
  void require_of(const Drive& drive) const;
};

}  // namespace fovea::python
