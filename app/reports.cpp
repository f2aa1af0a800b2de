#include "app/reports.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "fovea/core/angle.h"

namespace fovea::app {
namespace {

/// "rotation 0.30 0.00 -0.01 degrees (+-0.01 0.00 0.02), images 19.6 ms late (+-0.2)".
std::string figures_of(const CalibrationEstimate& e) {
  const Eigen::Vector3d r = e.rotation / kDegree, s = e.rotation_sigma / kDegree;
  const std::string rotation =
      fmt::format("rotation {:.3f} {:.3f} {:.3f} degrees (+-{:.3f} {:.3f} {:.3f})", r.x(), r.y(),
                  r.z(), s.x(), s.y(), s.z());
  if (!e.delay_observable) return rotation + ", time offset not observable";
  return fmt::format("{}, images {:.1f} ms late (+-{:.1f})", rotation, 1e3 * e.delay,
                     1e3 * e.delay_sigma);
}

constexpr const char* kCheckCalibration =
    "check its T_cam_lidar, its K and the stamps of its images";

/// What the user can do about edges that lie over a pixel off.
std::string remedy_of(const CalibrationEstimate& e, bool can_calibrate) {
  if (!e.correctable) {
    return fmt::format("this is beyond what --calibrate corrects: {}", kCheckCalibration);
  }
  return can_calibrate ? "--calibrate corrects this"
                       : "--calibrate with --poses FILE corrects this";
}

std::string calibration_line(int camera, const CalibrationEstimate& e, const MapSummary& summary) {
  if (e.disagrees) {
    return fmt::format("camera {}: camera and LiDAR do not agree ({} edges in {} frames): {}",
                       camera, e.edges, e.frames, kCheckCalibration);
  }
  if (!e.rotation_observable) {
    return fmt::format(
        "camera {}: calibration not observable ({} edges in {} frames), it stays as given", camera,
        e.edges, e.frames);
  }
  const bool applied = summary.calibrated;
  const std::string edges =
      fmt::format("edges {} {:.1f} pixels off the LiDAR's", applied ? "lay" : "lie", e.pixels);
  if (applied) return fmt::format("camera {}: corrected, {}: {}", camera, edges, figures_of(e));
  if (!e.off_by_a_pixel()) return fmt::format("camera {}: {}: {}", camera, edges, figures_of(e));
  return fmt::format("camera {}: {}: {}; camera and LiDAR do not agree, {}", camera, edges,
                     figures_of(e), remedy_of(e, summary.can_calibrate));
}

/// Whether the drive's calibration is wrong and stays so.
bool is_warning(const CalibrationEstimate& e, bool applied) {
  return e.disagrees || (e.rotation_observable && !applied && e.off_by_a_pixel());
}

}  // namespace

Messages calibration_messages(const MapSummary& summary) {
  Messages messages;
  for (const auto& [camera, estimate] : summary.calibration) {
    std::string line = calibration_line(camera, estimate, summary);
    if (is_warning(estimate, summary.calibrated)) {
      messages.warn(std::move(line));
    } else {
      messages.notes.push_back(std::move(line));
    }
  }
  return messages;
}

void write_json(OutputFile& file, const nlohmann::ordered_json& json) {
  file.stream() << json.dump(2) << '\n';
  file.commit();
}

}  // namespace fovea::app
