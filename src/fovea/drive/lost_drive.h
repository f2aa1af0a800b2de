// Telling a file that cannot be read from a drive that has vanished.
#pragma once

#include <filesystem>

#include "fovea/core/read_file.h"
#include "fovea/errors.h"

namespace fovea {

/// The files of a frame and of the frames next to it existed when the drive was opened, and can no
/// longer be read: the disk is gone, or the folder was moved.
class DriveLostError : public InputError {
 public:
  using InputError::InputError;
};

/// Called for a file that could not be used. DriveLostError if neither it nor the next two of its
/// kind (at the end of the drive, the two before) can be read; returns if the file is damaged or
/// missing alone.
/// @param files  of one sensor, as listed when the drive was opened
void require_drive(const NumberedFiles& files, int index, const std::filesystem::path& drive);

}  // namespace fovea
