#include "fovea/pipeline/drive_catalog.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fovea/pipeline/drive_records.h"

namespace fovea {
namespace {

constexpr int kVersion = 1;
constexpr double kStep = 5;  // m between places

struct FramePlace {
  int frame = 0;
  Eigen::Vector3d position_local;
};

/// The frames that navigation places.
std::vector<FramePlace> frame_places(const FrameSource& source) {
  std::vector<FramePlace> places;
  const DriveInfo& info = source.info();
  if (!info.navigation) return places;
  for (const int frame : info.frame_indices()) {
    const std::optional<TimeNs> stamp = source.stamp(frame);
    if (!stamp) continue;
    if (const auto T_local_lidar = info.navigation->at(*stamp)) {
      places.push_back({frame, T_local_lidar->translation()});
    }
  }
  return places;
}

void add_way(const FrameSource& source, DriveCatalog& catalog) {
  const std::vector<FramePlace> frames = frame_places(source);
  std::optional<LocalTangentPlane> local;
  if (source.info().origin) local.emplace(*source.info().origin);
  double next = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i > 0) {
      catalog.length += (frames[i].position_local - frames[i - 1].position_local).norm();
    }
    if (!local || (catalog.length < next && i + 1 < frames.size())) continue;
    next = catalog.length + kStep;
    catalog.places.push_back(
        {frames[i].frame, catalog.length, local->to_geodetic(frames[i].position_local)});
  }
}

std::optional<double> median_accuracy(const DriveInfo& info) {
  std::vector<double> stated;
  for (const double accuracy : info.navigation_accuracy) {
    if (accuracy > 0 && std::isfinite(accuracy)) stated.push_back(accuracy);
  }
  if (stated.empty()) return std::nullopt;
  const auto middle = stated.begin() + std::ptrdiff_t(stated.size() / 2);
  std::nth_element(stated.begin(), middle, stated.end());
  return *middle;
}

double duration_of(const FrameSource& source) {
  std::optional<TimeNs> first, last;
  for (const int frame : source.info().frame_indices()) {
    const std::optional<TimeNs> stamp = source.stamp(frame);
    if (!stamp) continue;
    if (!first) first = stamp;
    last = stamp;
  }
  return first ? seconds(*last - *first) : 0;
}

template <class Value>
nlohmann::ordered_json json_or_null(const std::optional<Value>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

}  // namespace

DriveCatalog catalog_of(const FrameSource& source) {
  DriveCatalog catalog;
  catalog.append(source.info());
  catalog.drive = drive_record(source);
  catalog.coordinates = source.info().coordinates;
  catalog.path = std::filesystem::absolute(source.info().path).lexically_normal();
  catalog.frames = source.info().frame_count();
  catalog.duration = duration_of(source);
  catalog.accuracy = median_accuracy(source.info());
  add_way(source, catalog);
  return catalog;
}

std::string to_json(const DriveCatalog& catalog) {
  const DriveRecord& drive = catalog.drive;
  nlohmann::ordered_json json{
      {"fovea_catalog", kVersion},
      {"name", drive.name},
      {"path", catalog.path.string()},
      {"kind", drive.kind},
      {"begin", drive.first_frame},
      {"end", drive.end_frame},
      {"frames", catalog.frames},
      {"session", json_or_null(drive.session)},
      {"duration_s", catalog.duration},
      {"length_m", catalog.length},
      {"georeferenced", !catalog.places.empty()},
      {"accuracy_m", json_or_null(catalog.accuracy)},
      {"datum", json_or_null(catalog.coordinates.datum)},
      {"epoch_year", json_or_null(catalog.coordinates.epoch_year)},
      {"height_type", nullptr},
      {"calibration_fingerprint", json_or_null(drive.calibration_fingerprint)},
      {"stamps_fingerprint", json_or_null(drive.stamps_fingerprint)},
      {"warnings", catalog.warnings},
      {"places", nlohmann::ordered_json::array()}};
  if (const auto heights = catalog.coordinates.heights) json["height_type"] = to_string(*heights);
  for (const CatalogPlace& place : catalog.places) {
    json["places"].push_back({{"frame", place.frame},
                              {"along_m", place.along},
                              {"latitude_deg", place.position.latitude},
                              {"longitude_deg", place.position.longitude},
                              {"height_m", place.position.altitude}});
  }
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fovea
