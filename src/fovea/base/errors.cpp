#include "fovea/base/errors.h"

#include <fmt/format.h>

namespace fovea {

Error::Error(std::string_view what, std::string_view where, std::string_view remedy)
    : std::runtime_error(fmt::format("{}, {}, {}", what, where, remedy)) {}

}  // namespace fovea
