#include "fovea/geometry/city_grid.h"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/TransverseMercator.hpp>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace fovea {

namespace {

const GeographicLib::TransverseMercator& mercator() {
  static const GeographicLib::TransverseMercator projection(
      GeographicLib::Constants::WGS84_a(), GeographicLib::Constants::WGS84_f(), /*k0=*/1);
  return projection;
}

}  // namespace

std::optional<CityTile> CityTile::parse(std::string_view text) {
  CityTile tile;
  const char* end = text.data() + text.size();
  const auto [comma, x_error] = std::from_chars(text.data(), end, tile.x);
  if (x_error != std::errc() || comma == end || *comma != ',') return std::nullopt;
  const auto [rest, y_error] = std::from_chars(comma + 1, end, tile.y);
  if (y_error != std::errc() || rest != end) return std::nullopt;
  return tile;
}

std::string CityTile::text() const { return std::to_string(x) + "," + std::to_string(y); }

CityGrid::CityGrid(const GeodeticPoint& origin, double size) : origin_(origin), size_(size) {
  if (!(size > 0 && std::isfinite(size))) throw std::invalid_argument("a cell needs a size");
  double east = 0;
  mercator().Forward(origin.longitude, origin.latitude, origin.longitude, east, origin_north_);
}

Eigen::Vector2d CityGrid::projected(const Eigen::Vector3d& p_ecef) const {
  GeodeticPoint point;
  GeographicLib::Geocentric::WGS84().Reverse(p_ecef.x(), p_ecef.y(), p_ecef.z(), point.latitude,
                                             point.longitude, point.altitude);
  Eigen::Vector2d place;
  mercator().Forward(origin_.longitude, point.latitude, point.longitude, place.x(), place.y());
  place.y() -= origin_north_;
  return place;
}

CityTile CityGrid::tile_at(const Eigen::Vector3d& p_ecef) const {
  const Eigen::Vector2d cell = (projected(p_ecef) / size_).array().floor();
  return {static_cast<std::int32_t>(cell.x()), static_cast<std::int32_t>(cell.y())};
}

GeodeticPoint CityGrid::middle(const CityTile& tile) const {
  GeodeticPoint middle = origin_;
  mercator().Reverse(origin_.longitude, size_ * (tile.x + 0.5),
                     size_ * (tile.y + 0.5) + origin_north_, middle.latitude, middle.longitude);
  return middle;
}

}  // namespace fovea
