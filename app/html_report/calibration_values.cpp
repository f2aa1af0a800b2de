#include "app/html_report/calibration_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/calibration_text.h"
#include "app/html_report/markup.h"
#include "fovea/core/angle.h"

namespace fovea::app {
namespace {

constexpr double kCentimeter = 0.01, kMillisecond = 0.001;
// Standard deviation up to which the bias of a gyroscope counts as observable, rad/s: half of what
// an IMU may have without any turn.
constexpr double kObservableBias = 0.5 * kDegree;

/// How a kind of value is shown.
struct ValueUnit {
  double size = 1;
  int decimals = 0;
  const char* name = "";
};
constexpr ValueUnit kDegrees{kDegree, 3, "\xC2\xB0"}, kCentimeters{kCentimeter, 2, " cm"},
    kMilliseconds{kMillisecond, 2, " ms"}, kDegreesPerSecond{kDegree, 3, "\xC2\xB0/s"};

/// An estimated value. One that is not observable stays as given.
struct ValueRow {
  std::string name;
  double correction = 0, sigma = 0;
  ValueUnit unit;
  std::string observable;  ///< "yes", "in part"; empty: not observable
  std::string missing;     ///< what makes it observable
};

/// "+0.291°"; "none" for a value that is not finite.
std::string correction_text(double value, const ValueUnit& unit) {
  if (!std::isfinite(value)) return "none";
  return fmt::format("{:+.{}f}{}", value / unit.size, unit.decimals, unit.name);
}

/// "±0.015°".
std::string sigma_text(double sigma, const ValueUnit& unit) {
  if (!std::isfinite(sigma)) return "none";
  return fmt::format("\xC2\xB1{:.{}f}{}", sigma / unit.size, unit.decimals, unit.name);
}

std::string row_html(const ValueRow& row) {
  if (!row.observable.empty()) {
    return fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                       escaped(row.name), correction_text(row.correction, row.unit),
                       sigma_text(row.sigma, row.unit), escaped(row.observable));
  }
  return fmt::format(
      "<tr class=\"no\"><th scope=\"row\">{}</th><td>stays as given</td><td></td>"
      "<td>no{}</td></tr>\n",
      escaped(row.name), escaped(row.missing.empty() ? "" : ": " + row.missing));
}

std::string value_table(const std::vector<ValueRow>& rows) {
  std::string html =
      "<div class=\"scroll\"><table class=\"calibration\"><thead><tr><th>value</th>"
      "<th>correction</th><th>standard deviation</th><th>observable</th></tr></thead><tbody>\n";
  for (const ValueRow& row : rows) html += row_html(row);
  return html + "</tbody></table></div>\n";
}

std::string alarm(const std::string& title, const std::string& text) {
  return fmt::format("<div class=\"warnings\"><p><b>{}</b> {}</p></div>\n", escaped(title),
                     escaped(text));
}

/// The tables of the sensors in `correction`, as the corrected drive.toml states them.
std::string toml_html(const DriveCorrection& correction, const std::string& comment) {
  std::string text = calibrated_drive_text({".", correction});
  const std::size_t begin = text.find("[calibrated.");
  if (begin == std::string::npos) return "";
  for (std::size_t at = text.find("], ["); at != std::string::npos; at = text.find("], [")) {
    text.replace(at, 4, "],\n  [");  // a row of the matrix on a line
  }
  return fmt::format("<pre class=\"copy\"><code>{}{}</code></pre>\n", escaped(text.substr(begin)),
                     escaped(comment));
}

std::string delay_comment(double image_delay) {
  return fmt::format("# With it, images are taken {:.2f} ms {} the stamps of their scans.",
                     std::abs(image_delay) / kMillisecond, image_delay < 0 ? "before" : "after");
}

std::vector<ValueRow> rows_of(const CalibrationEstimate& estimate) {
  const CameraCorrection &c = estimate.correction, &s = estimate.sigma;
  std::vector<ValueRow> rows;
  for (int k = 0; k < kCalibrationSize; ++k) {
    const bool is_observable = estimate.observable.at(static_cast<std::size_t>(k));
    ValueRow row{
        calibration_parameter_name(k), c.delay, s.delay, kMilliseconds, is_observable ? "yes" : "",
        missing_evidence(estimate, k)};
    if (k < kCamTranslation) {
      row.correction = c.rotation[k - kCamRotation];
      row.sigma = s.rotation[k - kCamRotation];
      row.unit = kDegrees;
    } else if (k < kCamDelay) {
      row.correction = c.translation[k - kCamTranslation];
      row.sigma = s.translation[k - kCamTranslation];
      row.unit = kCentimeters;
    }
    rows.push_back(row);
  }
  return rows;
}

/// Whether a rotation about an axis of the LiDAR is observable.
std::string rotation_observable(const ImuHandEye& imu, Eigen::Index axis) {
  if (imu.rotation_observable() || imu.rotation_sigma()[axis] <= kMaxMountSigma) return "yes";
  return imu.rotation[axis] == 0 ? "" : "in part";
}

std::vector<ValueRow> rows_of(const ImuHandEye& imu) {
  const std::string missing = missing_motion(imu);
  const Eigen::Vector3d sigma = imu.rotation_sigma();
  std::vector<ValueRow> rows;
  rows.reserve(7);
  for (Eigen::Index k = 0; k < 3; ++k) {
    rows.push_back({fmt::format("rotation about the LiDAR's {} axis", "xyz"[k]), imu.rotation[k],
                    sigma[k], kDegrees, rotation_observable(imu, k), missing});
  }
  rows.push_back({"delay of the IMU", imu.delay, imu.delay_sigma, kMilliseconds,
                  imu.delay_observable ? "yes" : "", missing});
  for (Eigen::Index k = 0; k < 3; ++k) {
    const bool is_observable = imu.gyroscope_bias_sigma[k] <= kObservableBias;
    rows.push_back({fmt::format("bias of the gyroscope, {} axis of the IMU", "xyz"[k]),
                    imu.gyroscope_bias[k], imu.gyroscope_bias_sigma[k], kDegreesPerSecond,
                    is_observable ? "yes" : "", missing});
  }
  return rows;
}

}  // namespace

std::string camera_values(const CameraCalibration& found, const Camera& given,
                          const DriveCorrection& corrected) {
  const CalibrationEstimate& e = found.estimate;
  std::string html = fmt::format("<div class=\"panel\"><h3>Camera {}</h3>\n", found.camera);
  const std::string evidence = fmt::format("{} edges in {} frames", count(e.edges), e.frames);
  if (e.disagrees) {
    return html +
           alarm("Camera and LiDAR do not agree under any correction.",
                 fmt::format("The calibration stays as given ({}). Check T_cam_lidar, K and the "
                             "stamps of the images.",
                             evidence)) +
           "</div>\n";
  }
  if (e.is_any_observable()) {
    html += fmt::format(
        "<p>Edges in the images lay {:.1f} pixels (\xC2\xB1{:.1f}) off the edges of the LiDAR. "
        "The estimate is from {}.</p>\n",
        e.pixels, e.pixels_sigma, evidence);
  } else {
    html += fmt::format("<p>The drive has {}.</p>\n", evidence);
  }
  html += value_table(rows_of(e));
  html += fmt::format("<p>{}</p>\n", escaped(lens_text(found.lens)));
  html += "<p class=\"note\">The new calibration, as the output states it:</p>\n" +
          toml_html(corrected, delay_comment(given.image_delay + e.correction.delay));
  return html + "</div>\n";
}

std::string imu_values(const ImuHandEye& found, const DriveCorrection& corrected) {
  std::string html = "<div class=\"panel\"><h3>IMU</h3>\n";
  const std::string evidence = fmt::format("{} turns between scans, {} of them of over 0.2\xC2\xB0",
                                           count(found.turns), count(found.moving_turns));
  if (!found.agrees) {
    return html +
           alarm("IMU and LiDAR do not agree under any mount.",
                 fmt::format("The calibration stays as given ({}). {}", evidence,
                             imu_disagreement(found))) +
           "</div>\n";
  }
  html += fmt::format(
      "<p>The estimate is from {}. The turns of the IMU differ from those of the LiDAR by "
      "{:.3f}\xC2\xB0 (median).</p>\n",
      evidence, found.residual / kDegree);
  html += value_table(rows_of(found));
  const std::string missing = missing_motion(found);
  if (!missing.empty()) {
    html += fmt::format("<p>To make all values observable, {}.</p>\n", escaped(missing));
  }
  html +=
      "<p>The output contains no bias: <code>fovea map</code> estimates it again.</p>\n"
      "<p class=\"note\">The new calibration, as the output states it:</p>\n" +
      toml_html(corrected, "");
  return html + "</div>\n";
}

}  // namespace fovea::app
