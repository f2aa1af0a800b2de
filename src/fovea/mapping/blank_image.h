// Images without content: a covered lens, a failed camera, glare.
#pragma once

#include "fovea/image.h"

namespace fovea {

/// Whether all but 1 % of the pixels are black, or all but 1 % white. Tests every eighth pixel of
/// every eighth row.
bool is_blank(const Image& image);

}  // namespace fovea
