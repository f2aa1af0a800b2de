// The recording of a running robot, which cannot be made again.
#pragma once

#include <exception>

#include "fovea/drive/live/live_source.h"
#include "fovea/errors.h"

namespace fovea::app {

/// Runs `work`, and completes the recording of the source also if it throws.
/// @throws  the error of `work`, or else that of the recording
template <class Work>
void keep_recording(LiveSource& source, Work&& work) {
  try {
    work();
  } catch (...) {
    try {
      source.finish_recording();
    } catch (const Error&) {  // the first error counts
    }
    throw;
  }
  source.finish_recording();
}

}  // namespace fovea::app
