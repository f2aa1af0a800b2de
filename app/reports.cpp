#include "app/reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/calibration_text.h"
#include "fovea/core/angle.h"

namespace fovea::app {
namespace {

/// "0.301 - -0.012": three values, a dash for each that is not observable.
std::string three(const Eigen::Vector3d& values, double unit, const CalibrationEstimate& e,
                  std::size_t first, int decimals) {
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) {
    if (k > 0) text += ' ';
    text += e.observable[first + k]
                ? fmt::format("{:.{}f}", values[Eigen::Index(k)] / unit, decimals)
                : "-";
  }
  return text;
}

bool is_any_observable(const CalibrationEstimate& e, int first) {
  return std::any_of(e.observable.begin() + first, e.observable.begin() + first + 3,
                     [](bool is_observable) { return is_observable; });
}

/// "rotation 0.30 0.00 -0.01 degrees (+-0.01 0.00 0.02), images 19.6 ms late (+-0.2)".
std::string figures_of(const CalibrationEstimate& e) {
  std::string text = "rotation not observable";
  if (is_any_observable(e, kCamRotation)) {
    text = fmt::format("rotation {} degrees (+-{})",
                       three(e.correction.rotation, kDegree, e, kCamRotation, 3),
                       three(e.sigma.rotation, kDegree, e, kCamRotation, 3));
  }
  if (is_any_observable(e, kCamTranslation)) {
    text += fmt::format(", translation {} cm (+-{})",
                        three(e.correction.translation, 0.01, e, kCamTranslation, 1),
                        three(e.sigma.translation, 0.01, e, kCamTranslation, 1));
  }
  if (!e.delay_observable()) return text + ", time offset not observable";
  return text + fmt::format(", images {:.1f} ms late (+-{:.1f})", 1e3 * e.correction.delay,
                            1e3 * e.sigma.delay);
}

constexpr int kFewFrames = 30;
constexpr const char* kCalibrateReach = "5 degrees, 20 cm and 100 ms";

std::string camera_line(int camera, const CalibrationEstimate& e, bool applied) {
  if (e.disagrees) {
    const std::string line =
        fmt::format("camera {}: camera and LiDAR do not agree ({} edges in {} frames): ", camera,
                    e.edges, e.frames);
    const char* remedy = "check its T_cam_lidar, its K and the stamps of its images";
    if (applied) return line + remedy;
    return line +
           fmt::format("--calibrate corrects errors of up to {}; else {}", kCalibrateReach, remedy);
  }
  if (!e.is_any_observable()) {
    return fmt::format(
        "camera {}: calibration not observable ({} edges in {} frames), it stays as given", camera,
        e.edges, e.frames);
  }
  const std::string edges =
      fmt::format("edges {} {:.1f} pixels off the LiDAR's", applied ? "lay" : "lie", e.pixels);
  if (applied) return fmt::format("camera {}: corrected, {}: {}", camera, edges, figures_of(e));
  if (!e.off_by_a_pixel()) return fmt::format("camera {}: {}: {}", camera, edges, figures_of(e));
  return fmt::format("camera {}: {}: {}; camera and LiDAR do not agree, --calibrate corrects this",
                     camera, edges, figures_of(e));
}

/// Whether the drive's calibration is wrong and stays so.
bool is_warning(const CalibrationEstimate& e, bool applied) {
  return e.disagrees || (!applied && e.rotation_observable() && e.off_by_a_pixel());
}

/// The values of a corrected camera that stay as given, each with its remedy.
void add_missing_evidence(const CameraCalibration& camera, Messages& messages) {
  if (!camera.estimate.is_any_observable()) return;
  for (int k = 0; k < kCalibrationSize; ++k) {
    const std::string remedy = missing_evidence(camera.estimate, k);
    if (remedy.empty()) continue;
    messages.notes.push_back(fmt::format("camera {}: {} is not observable and stays as given: {}",
                                         camera.camera, calibration_parameter_name(k), remedy));
  }
}

void add_imu(const ImuHandEye& imu, bool applied, Messages& messages) {
  if (!imu.agrees) {
    const char* state = applied ? ", it stays as given" : "";
    messages.warn(fmt::format("IMU: its turns are not those of the LiDAR{}. {}", state,
                              imu_disagreement(imu)));
    return;
  }
  const Eigen::Vector3d r = imu.rotation / kDegree, s = imu.rotation_sigma() / kDegree;
  std::string line = "IMU: ";
  line += imu.observable_directions == 0
              ? "rotation not observable"
              : fmt::format("rotation {:.2f} {:.2f} {:.2f} degrees (+-{:.3f} {:.3f} {:.3f})", r.x(),
                            r.y(), r.z(), s.x(), s.y(), s.z());
  line += imu.delay_observable ? fmt::format(", samples {:.2f} ms late (+-{:.2f})", 1e3 * imu.delay,
                                             1e3 * imu.delay_sigma)
                               : ", time offset not observable";
  if (!applied) {
    if (!imu.is_off()) return messages.notes.push_back(std::move(line));
    return messages.warn(line + "; mount and clock do not fit, --calibrate corrects this");
  }
  const std::string motion = missing_motion(imu);
  if (!motion.empty()) line += "; the rest stays as given: " + motion;
  messages.notes.push_back(std::move(line));
}

}  // namespace

Messages calibration_messages(const DriveCalibration& calibration, bool applied) {
  Messages messages;
  for (const CameraCalibration& camera : calibration.cameras) {
    std::string line = camera_line(camera.camera, camera.estimate, applied);
    if (is_warning(camera.estimate, applied)) {
      messages.warn(std::move(line));
    } else {
      messages.notes.push_back(std::move(line));
    }
    if (applied) add_missing_evidence(camera, messages);
    if (applied && camera.estimate.is_any_observable() && camera.estimate.frames < kFewFrames) {
      messages.warn(
          fmt::format("camera {}: calibrated by {} frames: values may be worse than "
                      "their deviations say, give {} frames or more",
                      camera.camera, camera.estimate.frames, kFewFrames));
    }
    if (camera.lens.has_odd_focal() || camera.lens.has_odd_distortion()) {
      messages.warn(fmt::format("camera {}: {}", camera.camera, lens_text(camera.lens)));
    }
  }
  if (calibration.imu) add_imu(*calibration.imu, applied, messages);
  return messages;
}

void write_json(OutputFile& file, const nlohmann::ordered_json& json) {
  file.stream() << json.dump(2) << '\n';
  file.commit();
}

}  // namespace fovea::app
