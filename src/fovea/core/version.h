#pragma once

namespace fovea {

/// Version of the library and program, "MAJOR.MINOR.PATCH".
const char* version();

}  // namespace fovea
