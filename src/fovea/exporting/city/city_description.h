// The files about a city that the viewer's page reads (docs/viewer-protocol.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "fovea/city/city.h"
#include "fovea/exporting/viewer/map_description.h"

namespace fovea {

MapDescription describe_city(const City& city);

/// frames.json: the frames of all tiles by columns, drive by drive. A tile that cannot be read is
/// left out and named under "failures".
nlohmann::json city_frames_json(const City& city);
/// As text. Names that are no UTF-8 get replacement characters.
std::string city_frames_text(const City& city);

}  // namespace fovea
