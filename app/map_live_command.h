// fovea map ws://HOST:PORT: the topics of a running robot as a map. no_map_live_command.cpp takes
// the place of map_live_command.cpp in a build without FOVEA_WITH_BRIDGE.
#pragma once

#include "app/live_arguments.h"
#include "app/map_job.h"
#include "app/session.h"

namespace fovea::app {

/// Maps until the user or the robot ends it. What came until then is in the map.
void map_robot(const MapArguments& arguments, const LiveArguments& live, Session& session);

}  // namespace fovea::app
