// A city as a site shows it.
#pragma once

#include <memory>

#include "fovea/city/city.h"
#include "fovea/map/color_display.h"
#include "fovea/server/site_content.h"

namespace fovea {

/// The description, frames and tiles of a city. It shows the revision that `city` was opened at,
/// also while a build makes the next one.
/// @param exposure  of the colors, the same for all tiles
std::unique_ptr<SiteContent> make_city_content(City city, const ExposureChoice& exposure);

}  // namespace fovea
