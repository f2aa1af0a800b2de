#include "fovea/pipeline/stored_calibration.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <vector>

#include "fovea/core/errors.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/number_text.h"

namespace fovea {
namespace {

/// A drive with another calibration.
class RecalibratedSource : public FrameSource {
 public:
  RecalibratedSource(std::unique_ptr<FrameSource> drive, Calibration calibration)
      : drive_(std::move(drive)), info_(drive_->info()) {
    info_.calibration = std::move(calibration);
  }
  const DriveInfo& info() const override { return info_; }
  LoadedFrame load(int index) const override { return drive_->load(index); }
  void expect(int index) const override { drive_->expect(index); }
  std::optional<TimeNs> stamp(int index) const override { return drive_->stamp(index); }

 private:
  std::unique_ptr<FrameSource> drive_;
  DriveInfo info_;
};

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
    correction.estimate.rotation = {(*rotation)[0], (*rotation)[1], (*rotation)[2]};
  }
  if (const auto delay = numbers_of(meta, key_of(camera, meta_key::kDelayEnding), 1, map)) {
    correction.estimate.delay = delay->front();
  }
  return correction;
}

}  // namespace

void store_calibration(const std::vector<CameraCalibration>& found, MapMeta& meta) {
  for (const CameraCalibration& camera : found) {
    const CalibrationEstimate& e = camera.estimate;
    const std::array<double, 3> rotation{e.rotation.x(), e.rotation.y(), e.rotation.z()};
    meta[key_of(camera.camera, meta_key::kRotationEnding)] = to_text(rotation);
    meta[key_of(camera.camera, meta_key::kDelayEnding)] = to_text(std::array<double, 1>{e.delay});
  }
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
  std::vector<CameraCalibration> corrections;
  for (const Camera& camera : drive->info().calibration.cameras) {
    corrections.push_back(read_correction(meta, camera.index, map));
  }
  Calibration calibration = corrected(drive->info().calibration, corrections);
  return std::make_unique<RecalibratedSource>(std::move(drive), std::move(calibration));
}

}  // namespace fovea
