// A build without FOVEA_WITH_BRIDGE.
#include "app/map_live_command.h"
#include "fovea/errors.h"

namespace fovea::app {

void map_robot(const MapArguments& arguments, const LiveArguments& /*live*/, Session& /*session*/) {
  throw ConfigError("this build of fovea reads no running robot", arguments.drive.drive,
                    "build it with FOVEA_WITH_BRIDGE, or give a drive");
}

}  // namespace fovea::app
