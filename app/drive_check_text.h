// The contents of a drive as text.
#pragma once

#include <string>
#include <vector>

#include "fovea/pipeline/drive_check.h"

namespace fovea::app {

std::vector<std::string> lines_of(const DriveCheck& check, const DriveInfo& drive);

}  // namespace fovea::app
