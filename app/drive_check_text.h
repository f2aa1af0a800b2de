// The contents of a drive as text.
#pragma once

#include <string>
#include <vector>

#include "fovea/pipeline/drive_check.h"

namespace fovea::app {

/// @param messages  the notes and warnings of the drive, too
std::vector<std::string> lines_of(const DriveCheck& check, const DriveInfo& drive, bool messages);

}  // namespace fovea::app
