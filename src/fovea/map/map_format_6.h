// Reads maps of format 6, which no program writes any more. Private to map/.
#pragma once

#include "fovea/map/map_format.h"

namespace fovea {

const MapFormat& format_6();

}  // namespace fovea
