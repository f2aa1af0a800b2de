#include "fovea/platform.h"

namespace fovea {

const char* version() { return FOVEA_VERSION; }

}  // namespace fovea
