#include "fovea/localize.h"

#include <utility>

#include "fovea/api/drive_content.h"
#include "fovea/city/city.h"
#include "fovea/localization/localize_drive.h"
#include "fovea/localization/localizer.h"
#include "fovea/map/map_meta.h"

namespace fovea {

struct DriveLocalizer::Content {
  Drive drive;
  // What is localized in: one of both.
  std::optional<City> city;
  std::optional<MapReader> map;
  std::optional<Localizer> localizer;
};

DriveLocalizer::DriveLocalizer(const std::filesystem::path& map, const Drive& drive,
                               const DriveLocalizerOptions& options)
    : content_(new Content{drive, {}, {}, {}}) {
  Content& content = *content_;
  std::optional<GeodeticPoint> origin;
  if (is_city(map)) {
    content.city = open_city(map);
    origin = content.city->origin;
  } else {
    content.map.emplace(map);
    origin = map_origin(content.map->meta());
  }
  const DriveInfo& info = drive.content()->source->info();
  LocalizationGuess guess{std::nullopt, options.first};
  if (options.use_navigation && origin) guess.trajectory = navigation_in_local(info, *origin);
  content.localizer.emplace(
      content.city ? city_surface_source(*content.city) : map_surface_source(*content.map), info,
      std::move(guess));
}
DriveLocalizer::~DriveLocalizer() = default;
DriveLocalizer::DriveLocalizer(DriveLocalizer&&) noexcept = default;

Localization DriveLocalizer::localize(const DriveFrame& frame) {
  return content_->localizer->localize(frame_of(content_->drive, frame));
}

}  // namespace fovea
