// What the figures of an evaluation mean.
#pragma once

#include <string>

namespace fovea::app {

/// What the figure of this name means, in one line (docs/method.md 7); empty if it is not known.
std::string explain_figure(const std::string& key);

}  // namespace fovea::app
