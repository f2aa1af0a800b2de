#include "fovea/core/version.h"

namespace fovea {

const char* version() { return FOVEA_VERSION; }

}  // namespace fovea
