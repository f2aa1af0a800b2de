#include "fovea/pipeline/stored_calibration.h"

#include <fmt/format.h>

#include <array>

#include "fovea/base/errors.h"
#include "fovea/map/number_text.h"

namespace fovea {
namespace {

constexpr const char* kPrefix = "calibration.camera_";

/// A drive whose calibration is another.
class RecalibratedSource : public FrameSource {
 public:
  RecalibratedSource(std::unique_ptr<FrameSource> drive, Calibration calibration)
      : drive_(std::move(drive)), info_(drive_->info()) {
    info_.calibration = std::move(calibration);
  }
  const DriveInfo& info() const override { return info_; }
  FrameResult load(int index) const override { return drive_->load(index); }
  void expect(int index) const override { drive_->expect(index); }
  std::optional<TimeNs> stamp(int index) const override { return drive_->stamp(index); }

 private:
  std::unique_ptr<FrameSource> drive_;
  DriveInfo info_;
};

/// What the meta data says of a camera; no correction if nothing.
CameraCalibration read_correction(const MapMeta& meta, int camera,
                                  const std::filesystem::path& map) {
  CameraCalibration correction;
  correction.camera = camera;
  const std::string key = fmt::format("{}{}", kPrefix, camera);
  const auto found = meta.find(key);
  if (found == meta.end()) return correction;
  const auto numbers = numbers_from_text(found->second);
  if (!numbers || numbers->size() != 4) {
    throw InputError(fmt::format("'{}' is not four numbers", key), map.string(),
                     "make the map again with --calibrate");
  }
  correction.estimate.rotation = {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  correction.estimate.delay = (*numbers)[3];
  return correction;
}

}  // namespace

void store_calibration(const std::vector<CameraCalibration>& found, MapMeta& meta) {
  for (const CameraCalibration& camera : found) {
    const CalibrationEstimate& e = camera.estimate;
    const std::array<double, 4> numbers{e.rotation.x(), e.rotation.y(), e.rotation.z(), e.delay};
    meta[fmt::format("{}{}", kPrefix, camera.camera)] = to_text(numbers);
  }
}

bool has_stored_calibration(const MapMeta& meta) {
  const auto first = meta.lower_bound(kPrefix);
  return first != meta.end() && first->first.starts_with(kPrefix);
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
