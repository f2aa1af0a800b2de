// The page of `fovea view`, built into the program.
#pragma once

#include <span>

#include "fovea/exporting/viewer/viewer_folder.h"

namespace fovea::app {

std::span<const PageFile> viewer_page();

}  // namespace fovea::app
