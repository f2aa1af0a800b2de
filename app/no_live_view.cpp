// A build without the server (FOVEA_WITH_SERVER): `fovea map` has no --live.
#include "app/live_view.h"

namespace fovea::app {

void add_live_option(CLI::App&, std::string&) {}

LiveView::LiveView(const std::string&, MapJob&, std::shared_ptr<const FrameSource>, bool) {}

void LiveView::keep_serving() {}

}  // namespace fovea::app
