// Serves the requests of one TCP connection.
#pragma once

#include "fovea/server/web_context.h"

namespace fovea::web {

/// Returns at once. The connection lives in the handlers of `server.io` until it closes.
void serve_connection(WebContext& server, tcp::socket socket);

}  // namespace fovea::web
