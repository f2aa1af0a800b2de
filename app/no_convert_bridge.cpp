// A build without FOVEA_WITH_BRIDGE.
#include "app/convert_bridge.h"
#include "fovea/errors.h"

namespace fovea::app {
namespace {

[[noreturn]] void throw_missing(const std::string& address) {
  throw ConfigError("this build of fovea reads no running robot", address,
                    "build it with FOVEA_WITH_BRIDGE, or give a recording");
}

}  // namespace

ConvertFigures convert_bridge(const BridgeConversion& conversion, Session& /*session*/) {
  throw_missing(conversion.address);
}

void list_bridge(const std::string& address) { throw_missing(address); }

}  // namespace fovea::app
