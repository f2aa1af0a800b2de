#include "fovea/pipeline/stored_calibration.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <vector>

#include "fovea/drive/recalibrated_source.h"
#include "fovea/errors.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/number_text.h"

namespace fovea {
namespace {

std::string key_of(int camera, const char* ending) {
  return fmt::format("{}{}{}", meta_key::kCalibrationPrefix, camera, ending);
}

/// The numbers of a key; empty without the key. InputError if their count differs.
std::optional<std::vector<double>> numbers_of(const MapMeta& meta, const std::string& key,
                                              std::size_t count, const std::filesystem::path& map) {
  const auto found = meta.find(key);
  if (found == meta.end()) return std::nullopt;
  auto numbers = numbers_from_text(found->second);
  if (!numbers || numbers->size() != count) {
    throw InputError(fmt::format("'{}' is not {} numbers", key, count), map.string(),
                     "make the map again with --calibrate");
  }
  return numbers;
}

/// The correction of a camera in the meta data, if any.
CameraCalibration read_correction(const MapMeta& meta, int camera,
                                  const std::filesystem::path& map) {
  CameraCalibration correction;
  correction.camera = camera;
  if (const auto rotation = numbers_of(meta, key_of(camera, meta_key::kRotationEnding), 3, map)) {
    correction.estimate.correction.rotation = {(*rotation)[0], (*rotation)[1], (*rotation)[2]};
  }
  const auto translation = numbers_of(meta, key_of(camera, meta_key::kTranslationEnding), 3, map);
  if (translation) {
    correction.estimate.correction.translation = {(*translation)[0], (*translation)[1],
                                                  (*translation)[2]};
  }
  if (const auto delay = numbers_of(meta, key_of(camera, meta_key::kDelayEnding), 1, map)) {
    correction.estimate.correction.delay = delay->front();
  }
  return correction;
}

}  // namespace

void store_calibration(const DriveCalibration& found, MapMeta& meta) {
  const auto three = [](const Eigen::Vector3d& v) {
    return to_text(std::array<double, 3>{v.x(), v.y(), v.z()});
  };
  const auto one = [](double value) { return to_text(std::array<double, 1>{value}); };
  for (const CameraCalibration& camera : found.cameras) {
    const CameraCorrection& e = camera.estimate.correction;
    meta[key_of(camera.camera, meta_key::kRotationEnding)] = three(e.rotation);
    meta[key_of(camera.camera, meta_key::kTranslationEnding)] = three(e.translation);
    meta[key_of(camera.camera, meta_key::kDelayEnding)] = one(e.delay);
  }
  if (!found.imu) return;
  meta[meta_key::kImuRotation] = three(found.imu->rotation);
  meta[meta_key::kImuDelay] = one(found.imu->delay);
}

bool has_stored_calibration(const MapMeta& meta) {
  const auto first = meta.lower_bound(meta_key::kCalibrationPrefix);
  return first != meta.end() && first->first.starts_with(meta_key::kCalibrationPrefix);
}

std::unique_ptr<FrameSource> with_stored_calibration(std::unique_ptr<FrameSource> drive,
                                                     const MapMeta& meta,
                                                     const std::filesystem::path& map) {
  if (!has_stored_calibration(meta)) {
    throw InputError("the map has no corrected calibration", map.string(),
                     "give a map that was made with --calibrate");
  }
  DriveCalibration corrections;  // of the cameras: the map has the poses that the IMU improved
  for (const Camera& camera : drive->info().calibration.cameras) {
    corrections.cameras.push_back(read_correction(meta, camera.index, map));
  }
  DriveInfo info = drive->info();
  info = corrected(std::move(info), corrections);
  return std::make_unique<RecalibratedSource>(std::move(drive), std::move(info));
}

}  // namespace fovea
