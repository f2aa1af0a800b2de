// Images that show nothing: a covered lens, a camera that has failed, glare.
#pragma once

#include "fovea/base/image.h"

namespace fovea {

/// Whether all but 1 % of the pixels are black, or all but 1 % white. Every eighth pixel of every
/// eighth row is asked.
bool is_blank(const Image& image);

}  // namespace fovea
