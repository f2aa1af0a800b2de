// fovea localize ws://HOST:PORT: where a running robot is. no_localize_live_command.cpp takes the
// place of localize_live_command.cpp in a build without FOVEA_WITH_BRIDGE.
#pragma once

#include "app/live_arguments.h"
#include "app/localize_job.h"
#include "app/session.h"

namespace fovea::app {

/// Localizes until the user or the robot ends it. The output has the poses until then.
void localize_robot(const LocalizeArguments& arguments, const LiveArguments& live,
                    Session& session);

}  // namespace fovea::app
