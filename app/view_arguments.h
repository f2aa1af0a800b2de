// Where a map is shown: what `fovea view` and `fovea map --live` share.
#pragma once

#include <functional>
#include <string>

#include "fovea/server/web_server.h"

namespace fovea::app {

/// Tried where no port is asked for, so that links to a view go on working; any other if it is
/// taken.
inline constexpr int kUsualPort = 7600;

/// Calls open(options) with the port asked for, or with the usual one and then any.
/// @param port  negative: none asked for
void open_at_port(WebServerOptions options, int port,
                  const std::function<void(const WebServerOptions&)>& open);

/// Shows a page in the user's browser, where there is a desktop to do it.
void open_browser(const std::string& url);

}  // namespace fovea::app
