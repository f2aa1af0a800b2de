#include "fovea/errors.h"

#include <fmt/format.h>

namespace fovea {

Error::Error(std::string_view what, std::string_view where, std::string_view remedy)
    : std::runtime_error(fmt::format("{}, {}, {}", what, where, remedy)),
      problem_(what),
      where_(where),
      remedy_(remedy) {}

}  // namespace fovea
